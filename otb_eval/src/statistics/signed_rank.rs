//! Wilcoxon's signed-rank test of paired differences, and Holm's correction for several of them.
//!
//! Steps:
//! 1. differences of zero are left out, as Wilcoxon (1945) does,
//! 2. the others are ranked by size, equal ones by the mean of their ranks,
//! 3. the statistic is the smaller of the rank sums of either sign,
//! 4. its probability is exact with at most 50 differences and no equal ones, else that of the normal distribution with the
//!    correction for ties.
//!
//! It asks whether the differences lie about zero, and assumes nothing of their distribution but symmetry.

/// With more differences the normal distribution is as good.
const MOST_EXACT: usize = 50;

/// The two-sided probability of differences at least as one-sided as these if the trackers were alike; 1 without a difference.
pub fn signed_rank(differences: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = differences.iter().copied().filter(|value| *value != 0.0).collect();
    if sizes.is_empty() {
        return 1.0;
    }
    sizes.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let (mut positive, mut ties, mut first) = (0.0, 0.0, 0);
    while first < sizes.len() {
        let alike = sizes[first..].iter().take_while(|value| value.abs() == sizes[first].abs()).count();
        let rank = first as f64 + (alike as f64 + 1.0) / 2.0;
        positive += rank * sizes[first..first + alike].iter().filter(|value| **value > 0.0).count() as f64;
        ties += (alike as f64).powi(3) - alike as f64;
        first += alike;
    }
    let count = sizes.len() as f64;
    let total = count * (count + 1.0) / 2.0;
    let smaller = positive.min(total - positive);
    if ties == 0.0 && sizes.len() <= MOST_EXACT {
        return exact(sizes.len(), smaller);
    }
    let variance = count * (count + 1.0) * (2.0 * count + 1.0) / 24.0 - ties / 48.0;
    erfc((total / 2.0 - smaller) / (2.0 * variance).sqrt()).min(1.0)
}

/// Twice the share of the 2^n choices of signs whose rank sum is at most this one.
fn exact(count: usize, sum: f64) -> f64 {
    let most = count * (count + 1) / 2;
    let mut ways = vec![0.0_f64; most + 1];
    ways[0] = 1.0;
    for rank in 1..=count {
        for sum in (rank..=most).rev() {
            ways[sum] += ways[sum - rank];
        }
    }
    let below: f64 = ways[..=sum as usize].iter().sum();
    (2.0 * below / 2_f64.powi(count as i32)).min(1.0)
}

/// The complementary error function for x of 0 or more, by the continued fraction of W. J. Lentz where it converges fast and by
/// the series elsewhere; to about 1e-14 of itself.
fn erfc(x: f64) -> f64 {
    let root_of_pi = std::f64::consts::PI.sqrt();
    if x < 2.0 {
        let (mut term, mut sum) = (x, x);
        for n in 1..200 {
            term *= -x * x / f64::from(n);
            sum += term / f64::from(2 * n + 1);
        }
        return 1.0 - 2.0 / root_of_pi * sum;
    }
    let fraction = (1..=120).rev().fold(x, |below, n| x + f64::from(n) / 2.0 / below);
    (-x * x).exp() / (root_of_pi * fraction)
}

/// Probabilities of several tests, each corrected for the others as Holm (1979) does.
pub fn holm(probabilities: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..probabilities.len()).collect();
    order.sort_by(|&a, &b| probabilities[a].total_cmp(&probabilities[b]));
    let (mut corrected, mut largest) = (vec![1.0; probabilities.len()], 0.0_f64);
    for (place, index) in order.into_iter().enumerate() {
        largest = largest.max(probabilities[index] * (probabilities.len() - place) as f64).min(1.0);
        corrected[index] = largest;
    }
    corrected
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// `scipy.stats.wilcoxon(d, mode="exact")`, and `mode="approx", correction=False`, of SciPy 1.
    #[test]
    fn probabilities_are_scipys() {
        let few = [0.125, -0.5, 0.75, 1.0, -1.25, 1.5, 1.75, 2.0];
        assert!((signed_rank(&few) - 0.148_437_5).abs() < 1e-12, "{}", signed_rank(&few));
        let tied = [0.5, 0.5, -0.5, 1.0, 1.0, 2.0, -0.25, 0.0, 3.0];
        assert!((signed_rank(&tied) - 0.048_550_746_423_148_196).abs() < 1e-10, "{}", signed_rank(&tied));
        let many: Vec<f64> = (1..=60).map(|i| f64::from(i) * if i % 3 == 0 { -1.0 } else { 1.0 }).collect();
        assert!((signed_rank(&many) - 0.035_900_123_215_878_11).abs() < 1e-10, "{}", signed_rank(&many));
        let clear: Vec<f64> = (1..=80).map(f64::from).collect();
        assert!(
            (signed_rank(&clear) / 7.849_526_548_031_477e-15 - 1.0).abs() < 1e-9,
            "{}",
            signed_rank(&clear)
        );
    }

    #[test]
    fn no_difference_proves_nothing_and_five_alike_not_enough() {
        assert_eq!(signed_rank(&[]), 1.0);
        assert_eq!(signed_rank(&[0.0, 0.0]), 1.0);
        assert_eq!(signed_rank(&[1.0, 2.0, 3.0, 4.0, 5.0]), 0.0625);
        assert_eq!(signed_rank(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), 0.03125);
    }

    #[test]
    fn holm_is_his_example_and_keeps_the_order() {
        let corrected = holm(&[0.01, 0.04, 0.03, 0.005]);
        let expected = [0.03, 0.06, 0.06, 0.02];
        assert!(corrected.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{corrected:?}");
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
    }

    proptest! {
        #[test]
        fn the_sign_does_not_matter_and_a_probability_is_one(values in prop::collection::vec(-4..5i32, 1..70)) {
            let values: Vec<f64> = values.into_iter().map(f64::from).collect();
            let turned: Vec<f64> = values.iter().map(|value| -value).collect();
            let p = signed_rank(&values);
            prop_assert!((p - signed_rank(&turned)).abs() < 1e-12 && p > 0.0 && p <= 1.0, "{}", p);
        }
    }
}
