//! How far a mean over sequences and seeds would move if other sequences and seeds had been taken.
//!
//! A percentile bootstrap of two levels:
//! 1. sequences are drawn with replacement, since other sequences could have been filmed,
//! 2. within each its seeds are drawn, since other seeds could have been taken,
//! 3. the ends of the interval are quantiles of the means of many such draws.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

/// Resamples unless something else is asked for.
pub const RESAMPLES: usize = 10_000;

/// Share of the bootstrap's distribution inside the interval.
pub const COVERAGE: f64 = 0.95;

/// Where a mean lies with a probability of 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether zero lies outside.
    pub fn is_clear_of_zero(&self) -> bool {
        self.low > 0.0 || self.high < 0.0
    }
}

/// The interval of each column's mean. A column is a list of sequences, each with a value a seed; all columns are of the same
/// sequences and seeds, and are drawn together. A NaN is a value that does not count. The same `seed` gives the same
/// intervals; `None` without a sequence, or where one has no seed.
pub fn intervals<const N: usize>(
    columns: [&[Vec<f64>]; N],
    resamples: usize,
    seed: u64,
) -> Option<[Interval; N]> {
    let seeds: Vec<usize> = columns.first()?.iter().map(Vec::len).collect();
    let is_alike = |column: &&[Vec<f64>]| column.iter().map(Vec::len).eq(seeds.iter().copied());
    if seeds.is_empty() || seeds.contains(&0) || !columns.iter().all(is_alike) {
        return None;
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut means: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity(resamples));
    for _ in 0..resamples.max(1) {
        for (means, mean) in means.iter_mut().zip(resampled_means(columns, &seeds, &mut random)) {
            means.push(mean);
        }
    }
    let tail = (1.0 - COVERAGE) / 2.0;
    Some(means.map(|mut means| {
        means.sort_by(f64::total_cmp);
        Interval { low: quantile(&means, tail), high: quantile(&means, 1.0 - tail) }
    }))
}

/// Steps 1 and 2.
fn resampled_means<const N: usize>(
    columns: [&[Vec<f64>]; N],
    seeds: &[usize],
    random: &mut ChaCha8Rng,
) -> [f64; N] {
    let (mut sums, mut counts) = ([0.0; N], [0_usize; N]);
    for _ in 0..seeds.len() {
        let sequence = random.random_range(0..seeds.len());
        let mut of_sequence = [(0.0, 0_usize); N];
        for _ in 0..seeds[sequence] {
            let drawn = random.random_range(0..seeds[sequence]);
            for ((sum, count), column) in of_sequence.iter_mut().zip(&columns) {
                let value = column[sequence][drawn];
                if !value.is_nan() {
                    *sum += value;
                    *count += 1;
                }
            }
        }
        for (place, (sum, count)) in of_sequence.into_iter().enumerate().filter(|(_, (_, count))| *count > 0)
        {
            sums[place] += sum / count as f64;
            counts[place] += 1;
        }
    }
    std::array::from_fn(|place| sums[place] / counts[place].max(1) as f64)
}

/// Interpolated between neighbours; `sorted` is not empty.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let position = share * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[position.floor() as usize], sorted[position.ceil() as usize]);
    below + position.fract() * (above - below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_one_level_is_that_of_the_normal_mean() {
        // With one seed a sequence, the bootstrap's standard error of a mean is the known s / sqrt(n).
        let column: Vec<Vec<f64>> = (0..100).map(|i| vec![f64::from(i) / 100.0]).collect();
        let [interval] = intervals([&column], 20_000, 3).unwrap();
        let population: f64 = (0..100).map(|i| (f64::from(i) / 100.0 - 0.495).powi(2)).sum::<f64>() / 100.0;
        let half = 1.96 * (population / 100.0).sqrt();
        assert!((interval.high - interval.low - 2.0 * half).abs() < 0.005);
        assert_eq!(intervals([&column], 20_000, 3), Some([interval]));
    }

    #[test]
    fn columns_that_are_drawn_together_get_what_each_gets_alone() {
        let one: Vec<Vec<f64>> = (0..9).map(|i| vec![f64::from(i * i), 3.0]).collect();
        let other: Vec<Vec<f64>> = (0..9).map(|i| vec![0.5, f64::from(7 - i)]).collect();
        let both = intervals([&one, &other], 300, 5).unwrap();
        assert_eq!([both[0]], intervals([&one], 300, 5).unwrap());
        assert_eq!([both[1]], intervals([&other], 300, 5).unwrap());
    }

    #[test]
    fn values_that_do_not_count_are_left_out_of_the_mean() {
        let column: Vec<Vec<f64>> =
            (0..12).map(|i| vec![if i % 3 == 0 { f64::NAN } else { 0.25 }, f64::NAN]).collect();
        let [interval] = intervals([&column], 400, 1).unwrap();
        assert_eq!(interval, Interval { low: 0.25, high: 0.25 });
    }

    #[test]
    fn nothing_to_draw_from_is_none() {
        assert_eq!(intervals([&[][..]], 10, 1), None);
        assert_eq!(intervals([&[vec![]][..]], 10, 1), None);
        assert_eq!(intervals([&[vec![1.0]][..], &[vec![1.0, 2.0]][..]], 10, 1), None);
    }
}
