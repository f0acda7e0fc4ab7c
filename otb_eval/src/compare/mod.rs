//! Two trackers on the same sequences and seeds: how much they differ, and how sure that is.
//!
//! Steps:
//! 1. the difference of a sequence is the mean of its seeds' differences, seed paired with seed,
//! 2. the difference is the unweighted mean over sequences, as the benchmark's own means are,
//! 3. its interval is a percentile bootstrap of two levels: sequences are drawn with replacement, since other
//!    sequences could have been filmed, and within each its seeds, since other seeds could have been taken.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// Resamples of the bootstrap unless something else is asked for.
pub const RESAMPLES: usize = 10_000;

/// Share of the bootstrap's distribution inside the interval.
pub const COVERAGE: f64 = 0.95;

/// One sequence: a measure of both trackers, a value a seed, in the same order of seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The sequence.
    pub sequence: String,
    /// The first tracker's values.
    pub first: Vec<f64>,
    /// The second tracker's values, as many.
    pub second: Vec<f64>,
}

/// How two trackers differ in a measure; positive where the first is better.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The first tracker's mean over sequences.
    pub first: f64,
    /// The second tracker's mean over sequences.
    pub second: f64,
    /// First minus second.
    pub difference: f64,
    /// Lower end of the 95 % interval of the difference.
    pub low: f64,
    /// Upper end of the 95 % interval of the difference.
    pub high: f64,
    /// Sequences whose mean difference is positive.
    pub first_wins: usize,
    /// Sequences whose mean difference is negative.
    pub second_wins: usize,
    /// Each sequence.
    pub sequences: Vec<SequenceDifference>,
}

/// How two trackers differ on a sequence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SequenceDifference {
    /// The sequence.
    pub sequence: String,
    /// The first tracker's mean over seeds.
    pub first: f64,
    /// The second tracker's mean over seeds.
    pub second: f64,
    /// First minus second.
    pub difference: f64,
    /// Sample standard deviation of the seeds' differences; `None` with fewer than two seeds.
    pub deviation: Option<f64>,
}

impl Comparison {
    /// Whether zero lies outside the interval.
    pub fn is_clear(&self) -> bool {
        self.low > 0.0 || self.high < 0.0
    }
}

/// Compares two trackers; `None` if there is no sequence, or one without a seed. The same `seed` gives the same interval.
pub fn compare(pairs: &[Pair], resamples: usize, seed: u64) -> Option<Comparison> {
    let differences: Vec<Vec<f64>> = pairs
        .iter()
        .map(|pair| pair.first.iter().zip(&pair.second).map(|(first, second)| first - second).collect())
        .collect();
    if differences.is_empty() || differences.iter().any(Vec::is_empty) {
        return None;
    }
    let sequences: Vec<SequenceDifference> =
        pairs.iter().zip(&differences).map(|(pair, differences)| of_sequence(pair, differences)).collect();
    let (low, high) = interval(&differences, resamples.max(1), seed);
    let column = |value: fn(&SequenceDifference) -> f64| mean(sequences.iter().map(value));
    Some(Comparison {
        first: column(|one| one.first),
        second: column(|one| one.second),
        difference: column(|one| one.difference),
        low,
        high,
        first_wins: sequences.iter().filter(|one| one.difference > 0.0).count(),
        second_wins: sequences.iter().filter(|one| one.difference < 0.0).count(),
        sequences,
    })
}

/// Step 1.
fn of_sequence(pair: &Pair, differences: &[f64]) -> SequenceDifference {
    SequenceDifference {
        sequence: pair.sequence.clone(),
        first: mean(pair.first.iter().copied()),
        second: mean(pair.second.iter().copied()),
        difference: mean(differences.iter().copied()),
        deviation: deviation(differences),
    }
}

/// Step 3.
fn interval(differences: &[Vec<f64>], resamples: usize, seed: u64) -> (f64, f64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut means: Vec<f64> = (0..resamples).map(|_| resampled_mean(differences, &mut random)).collect();
    means.sort_by(f64::total_cmp);
    let tail = (1.0 - COVERAGE) / 2.0;
    (quantile(&means, tail), quantile(&means, 1.0 - tail))
}

fn resampled_mean(differences: &[Vec<f64>], random: &mut ChaCha8Rng) -> f64 {
    mean((0..differences.len()).map(|_| {
        let seeds = &differences[random.random_range(0..differences.len())];
        let drawn: f64 = (0..seeds.len()).map(|_| seeds[random.random_range(0..seeds.len())]).sum();
        drawn / seeds.len() as f64
    }))
}

/// Interpolated between neighbours; `sorted` is not empty.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let position = share * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[position.floor() as usize], sorted[position.ceil() as usize]);
    below + position.fract() * (above - below)
}

/// The mean; 0 of nothing.
pub fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1);
    values.sum::<f64>() / count as f64
}

/// The sample standard deviation; `None` of fewer than two values.
pub fn deviation(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let mean = mean(values.iter().copied());
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn pair(sequence: &str, first: &[f64], second: &[f64]) -> Pair {
        Pair { sequence: sequence.into(), first: first.to_vec(), second: second.to_vec() }
    }

    #[test]
    fn differences_are_paired_by_seed_and_weigh_sequences_alike() {
        let pairs =
            [pair("a", &[0.8, 0.6], &[0.5, 0.5]), pair("b", &[0.4], &[0.6]), pair("c", &[0.1], &[0.1])];
        let comparison = compare(&pairs, 200, 1).unwrap();
        assert!((comparison.first - (0.7 + 0.4 + 0.1) / 3.0).abs() < 1e-12);
        assert!((comparison.difference - (0.2 - 0.2) / 3.0).abs() < 1e-12);
        assert_eq!((comparison.first_wins, comparison.second_wins), (1, 1));
        let a = &comparison.sequences[0];
        assert!((a.deviation.unwrap() - 0.02_f64.sqrt()).abs() < 1e-12, "0.3 and 0.1 about 0.2");
        assert_eq!(comparison.sequences[1].deviation, None);
    }

    #[test]
    fn a_constant_difference_has_no_width_and_a_mixed_one_spans_zero() {
        let constant: Vec<Pair> = (0..6).map(|_| pair("s", &[0.75, 0.5], &[0.5, 0.25])).collect();
        let comparison = compare(&constant, 500, 1).unwrap();
        assert_eq!((comparison.low, comparison.high), (0.25, 0.25));
        assert!(comparison.is_clear());
        let mixed: Vec<Pair> =
            (0..6).map(|i| pair("s", &[0.5], &[if i % 2 == 0 { 0.7 } else { 0.3 }])).collect();
        assert!(!compare(&mixed, 500, 1).unwrap().is_clear());
    }

    #[test]
    fn the_interval_of_one_level_is_that_of_the_normal_mean() {
        // With one seed a sequence, the bootstrap's standard error of a mean is the known s / sqrt(n).
        let pairs: Vec<Pair> = (0..100).map(|i| pair("s", &[f64::from(i) / 100.0], &[0.0])).collect();
        let comparison = compare(&pairs, 20_000, 3).unwrap();
        let population: f64 = (0..100).map(|i| (f64::from(i) / 100.0 - 0.495).powi(2)).sum::<f64>() / 100.0;
        let half = 1.96 * (population / 100.0).sqrt();
        assert!((comparison.high - comparison.low - 2.0 * half).abs() < 0.005);
        assert_eq!(comparison, compare(&pairs, 20_000, 3).unwrap());
    }

    #[test]
    fn nothing_to_compare_is_none() {
        assert_eq!(compare(&[], 10, 1), None);
        assert_eq!(compare(&[pair("a", &[], &[])], 10, 1), None);
    }

    proptest! {
        #[test]
        fn swapping_the_trackers_swaps_the_sign(
            values in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64), 1..12), seed in 0..99u64
        ) {
            let one: Vec<Pair> = values.iter().map(|&(a, b)| pair("s", &[a], &[b])).collect();
            let other: Vec<Pair> = values.iter().map(|&(a, b)| pair("s", &[b], &[a])).collect();
            let (one, other) = (compare(&one, 60, seed).unwrap(), compare(&other, 60, seed).unwrap());
            prop_assert!((one.difference + other.difference).abs() < 1e-12);
            prop_assert!((one.low + other.high).abs() < 1e-9 && (one.high + other.low).abs() < 1e-9);
            prop_assert!(one.low <= one.high);
            prop_assert_eq!(one.first_wins, other.second_wins);
        }
    }
}
