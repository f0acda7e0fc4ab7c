//! Two trackers on the same sequences and seeds: how much they differ, and how sure that is.
//!
//! Steps:
//! 1. the difference of a sequence is the mean of its seeds' differences, seed paired with seed,
//! 2. the difference is the unweighted mean over sequences, as the benchmark's own means are,
//! 3. its interval is a percentile bootstrap of two levels: sequences are drawn with replacement, since other
//!    sequences could have been filmed, and within each its seeds, since other seeds could have been taken,
//! 4. whether the sequences' differences lie about zero is asked by Wilcoxon's signed-rank test, too.

use serde::Serialize;

use crate::statistics::{Interval, deviation, intervals, mean, signed_rank};

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
    /// Two-sided probability of such differences if the trackers were alike, by Wilcoxon's signed-rank test.
    pub p_value: f64,
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
        self.interval().is_clear_of_zero()
    }

    /// The 95 % interval of the difference.
    pub fn interval(&self) -> Interval {
        Interval { low: self.low, high: self.high }
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
    let [Interval { low, high }] = intervals([&differences], resamples, seed)?;
    let of_sequences: Vec<f64> = sequences.iter().map(|one| one.difference).collect();
    let column = |value: fn(&SequenceDifference) -> f64| mean(sequences.iter().map(value));
    Some(Comparison {
        first: column(|one| one.first),
        second: column(|one| one.second),
        difference: column(|one| one.difference),
        low,
        high,
        p_value: signed_rank(&of_sequences),
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
