//! Resampling: drawing particles in proportion to their weights (Douc, Cappe, Moulines 2005 compare these schemes).

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

/// A way to draw ancestors.
pub trait Resample {
    /// Draws as many ancestors as there are weights, in ascending order, into `ancestors`; `false` if the weights are to
    /// be kept instead, with `ancestors` as it was. `weights` sum to 1.
    fn resample<R: Rng + ?Sized>(&self, weights: &[f64], rng: &mut R, ancestors: &mut Vec<usize>) -> bool;
}

/// Sequential importance sampling: particles are never resampled, and their weights degenerate with time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NoResampling;

impl Resample for NoResampling {
    fn resample<R: Rng + ?Sized>(&self, _: &[f64], _: &mut R, _: &mut Vec<usize>) -> bool {
        false
    }
}

impl Resample for Resampling {
    fn resample<R: Rng + ?Sized>(&self, weights: &[f64], rng: &mut R, ancestors: &mut Vec<usize>) -> bool {
        self.draw(weights, rng, ancestors);
        true
    }
}

/// How ancestors are drawn. Every scheme is unbiased: particle i is expected N * weight_i times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Resampling {
    /// N independent draws (the bootstrap of Algorithm 1): multinomial counts.
    Multinomial,
    /// One draw in each of N equal strata of [0, 1).
    Stratified,
    /// One draw for all strata: particle i comes floor(N w_i) or ceil(N w_i) times.
    #[default]
    Systematic,
    /// floor(N w_i) copies of each particle, the rest multinomial from what remains.
    Residual,
}

impl Resampling {
    /// Draws as many ancestors as there are weights, in ascending order, into `ancestors`.
    /// `weights` sum to 1. Nothing is allocated once `ancestors` has held that many.
    pub fn draw<R: Rng + ?Sized>(self, weights: &[f64], rng: &mut R, ancestors: &mut Vec<usize>) {
        ancestors.clear();
        let n = weights.len();
        match self {
            Self::Multinomial => multinomial(n, |i| weights[i], n, rng, ancestors),
            Self::Stratified => invert(
                n,
                |i| weights[i],
                (0..n).map(|i| (i as f64 + rng.random::<f64>()) / n as f64),
                ancestors,
            ),
            Self::Systematic => {
                let offset: f64 = rng.random();
                invert(n, |i| weights[i], (0..n).map(|i| (i as f64 + offset) / n as f64), ancestors);
            }
            Self::Residual => residual(weights, rng, ancestors),
        }
    }
}

/// Residual resampling: the copies that are certain, then the rest from what remains of each weight.
fn residual<R: Rng + ?Sized>(weights: &[f64], rng: &mut R, ancestors: &mut Vec<usize>) {
    let n = weights.len();
    let certain = |i: usize| (n as f64 * weights[i]).floor();
    for i in 0..n {
        ancestors.extend(std::iter::repeat_n(i, certain(i) as usize));
    }
    ancestors.truncate(n);
    let missing = n - ancestors.len();
    if missing > 0 {
        let rest = |i: usize| n as f64 * weights[i] - certain(i);
        multinomial(n, rest, missing, rng, ancestors);
        ancestors.sort_unstable();
    }
}

/// Appends `draws` independent draws, using that the k-th largest of k uniform numbers is distributed as u^(1/k).
fn multinomial<R: Rng + ?Sized>(
    n: usize,
    weight: impl Fn(usize) -> f64,
    draws: usize,
    rng: &mut R,
    ancestors: &mut Vec<usize>,
) {
    let first = ancestors.len();
    let mut largest = 1.0;
    let descending = (1..=draws).rev().map(|k| {
        largest *= rng.random::<f64>().powf(1.0 / k as f64);
        1.0 - largest
    });
    // 1 - (descending) ascends; the mirrored uniforms are uniform too.
    invert(n, weight, descending, ancestors);
    debug_assert_eq!(ancestors.len() - first, draws);
}

/// Appends, for each of the ascending `uniforms` in [0, 1), the index whose share of the cumulative weight holds it.
fn invert(
    n: usize,
    weight: impl Fn(usize) -> f64,
    uniforms: impl Iterator<Item = f64>,
    ancestors: &mut Vec<usize>,
) {
    let total: f64 = (0..n).map(&weight).sum();
    let last = (0..n).rev().find(|&i| weight(i) > 0.0).unwrap_or(n.saturating_sub(1));
    let mut index = 0;
    let mut cumulative = if n > 0 { weight(0) } else { return };
    for u in uniforms {
        while index < last && cumulative <= u * total {
            index += 1;
            cumulative += weight(index);
        }
        ancestors.push(index);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    const ALL: [Resampling; 4] =
        [Resampling::Multinomial, Resampling::Stratified, Resampling::Systematic, Resampling::Residual];

    fn counts(scheme: Resampling, weights: &[f64], rng: &mut ChaCha8Rng) -> Vec<usize> {
        let mut ancestors = Vec::new();
        scheme.draw(weights, rng, &mut ancestors);
        assert_eq!(ancestors.len(), weights.len());
        assert!(ancestors.is_sorted());
        let mut counts = vec![0; weights.len()];
        ancestors.iter().for_each(|&i| counts[i] += 1);
        counts
    }

    #[test]
    fn every_scheme_is_unbiased() {
        let weights = [0.05, 0.0, 0.35, 0.2, 0.1, 0.3];
        let runs = 40_000;
        for scheme in ALL {
            let mut rng = ChaCha8Rng::seed_from_u64(7);
            let mut totals = [0usize; 6];
            for _ in 0..runs {
                for (total, count) in totals.iter_mut().zip(counts(scheme, &weights, &mut rng)) {
                    *total += count;
                }
            }
            // Pearson's statistic; multinomial counts make it chi-square with 4 degrees of freedom (18.5 at 0.001),
            // and every other scheme varies less.
            let statistic: f64 = weights
                .iter()
                .zip(totals)
                .filter(|(w, _)| **w > 0.0)
                .map(|(w, total)| {
                    let expected = 6.0 * runs as f64 * w;
                    (total as f64 - expected).powi(2) / expected
                })
                .sum();
            assert!(statistic < 18.5, "{scheme:?}: {statistic}");
            assert_eq!(totals[1], 0, "{scheme:?} drew a particle of no weight");
        }
    }

    #[test]
    fn multinomial_counts_have_the_binomial_variance() {
        let weights = [0.5, 0.25, 0.25, 0.0];
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let runs = 40_000;
        let drawn: Vec<f64> =
            (0..runs).map(|_| counts(Resampling::Multinomial, &weights, &mut rng)[0] as f64).collect();
        let mean = drawn.iter().sum::<f64>() / runs as f64;
        let variance = drawn.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / runs as f64;
        assert!((variance - 4.0 * 0.5 * 0.5).abs() < 0.03, "{variance}");
    }

    #[test]
    fn systematic_counts_are_floor_or_ceil_and_residual_at_least_floor() {
        let weights = [0.07, 0.41, 0.02, 0.3, 0.2];
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        for _ in 0..500 {
            for (count, w) in counts(Resampling::Systematic, &weights, &mut rng).iter().zip(weights) {
                assert!((*count as f64 - 5.0 * w).abs() < 1.0);
            }
            for (count, w) in counts(Resampling::Residual, &weights, &mut rng).iter().zip(weights) {
                assert!(*count as f64 >= (5.0 * w).floor());
            }
        }
    }

    #[test]
    fn stratified_counts_differ_by_less_than_two() {
        let weights = [0.07, 0.41, 0.02, 0.3, 0.2];
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for _ in 0..500 {
            for (count, w) in counts(Resampling::Stratified, &weights, &mut rng).iter().zip(weights) {
                assert!((*count as f64 - 5.0 * w).abs() < 2.0);
            }
        }
    }

    #[test]
    fn weights_that_divide_evenly_leave_no_chance() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for scheme in [Resampling::Systematic, Resampling::Residual] {
            assert_eq!(counts(scheme, &[0.5, 0.0, 0.25, 0.25], &mut rng), [2, 0, 1, 1]);
        }
        for scheme in ALL {
            assert_eq!(counts(scheme, &[0.0, 0.0, 1.0], &mut rng), [0, 0, 3]);
            assert_eq!(counts(scheme, &[1.0], &mut rng), [1]);
        }
    }
}
