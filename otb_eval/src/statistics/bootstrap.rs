//! How far a mean over sequences and seeds would move if other sequences and seeds had been taken.
//!
//! A percentile bootstrap of two levels:
//! 1. sequences are drawn with replacement, since other sequences could have been filmed,
//! 2. within each its seeds are drawn, since other seeds could have been taken,
//! 3. the ends of the interval are quantiles of the means of many such draws.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

/// Resamples unless something else is asked for.
pub const RESAMPLES: usize = 10_000;

/// Share of the bootstrap's distribution inside the interval.
pub const COVERAGE: f64 = 0.95;

/// Resamples that are drawn before they are used, so few that they stay in the cache.
const BLOCK: usize = 256;

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
    intervals_of_sets(&[columns], resamples, seed)?.pop()
}

/// As [`intervals`], of several sets of columns, for all of which sequences and seeds are drawn once: each set gets what it gets
/// alone.
pub fn intervals_of_sets<const N: usize>(
    sets: &[[&[Vec<f64>]; N]],
    resamples: usize,
    seed: u64,
) -> Option<Vec<[Interval; N]>> {
    let seeds: Vec<usize> = sets.first()?.first()?.iter().map(Vec::len).collect();
    let is_alike = |column: &&[Vec<f64>]| column.iter().map(Vec::len).eq(seeds.iter().copied());
    if seeds.is_empty() || seeds.contains(&0) || !sets.iter().flatten().all(is_alike) {
        return None;
    }
    let resamples = resamples.max(1);
    let mut draws = Draws::new(&seeds, seed);
    let mut sets: Vec<Resampled<N>> = sets.iter().map(|columns| Resampled::new(columns, resamples)).collect();
    for first in (0..resamples).step_by(BLOCK) {
        draws.draw(BLOCK.min(resamples - first));
        sets.par_iter_mut().for_each(|set| set.add(&draws));
    }
    Some(sets.into_par_iter().map(Resampled::intervals).collect())
}

/// Steps 1 and 2 of some resamples.
struct Draws<'a> {
    random: ChaCha8Rng,
    /// Seeds of each sequence.
    seeds: &'a [usize],
    /// Values before each sequence's, were all sequences' in one list.
    before: Vec<usize>,
    /// Sequences drawn, as many a resample as there are.
    sequences: Vec<usize>,
    /// The values drawn in each of them, as places in that list.
    places: Vec<usize>,
}

impl<'a> Draws<'a> {
    fn new(seeds: &'a [usize], seed: u64) -> Self {
        let mut total = 0;
        let before = seeds.iter().map(|count| {
            total += count;
            total - count
        });
        let random = ChaCha8Rng::seed_from_u64(seed);
        Self { random, seeds, before: before.collect(), sequences: Vec::new(), places: Vec::new() }
    }

    fn draw(&mut self, resamples: usize) {
        self.sequences.clear();
        self.places.clear();
        for _ in 0..resamples * self.seeds.len() {
            let sequence = self.random.random_range(0..self.seeds.len());
            self.sequences.push(sequence);
            for _ in 0..self.seeds[sequence] {
                self.places.push(self.before[sequence] + self.random.random_range(0..self.seeds[sequence]));
            }
        }
    }
}

/// The same value of every column of a set.
#[derive(Clone, Copy)]
struct Row<const N: usize> {
    /// 0 where it does not count.
    values: [f64; N],
    /// 1, or 0 where it does not count.
    counts: [f64; N],
}

impl<const N: usize> Row<N> {
    const ZERO: Self = Self { values: [0.0; N], counts: [0.0; N] };

    fn of(columns: &[&[Vec<f64>]; N], sequence: usize, seed: usize) -> Self {
        let mut row = Self::ZERO;
        for (place, column) in columns.iter().enumerate() {
            let value = column[sequence][seed];
            if !value.is_nan() {
                (row.values[place], row.counts[place]) = (value, 1.0);
            }
        }
        row
    }

    fn add(&mut self, other: &Self) {
        for place in 0..N {
            self.values[place] += other.values[place];
            self.counts[place] += other.counts[place];
        }
    }

    /// The mean of what was added, which counts once if anything of it counts.
    fn mean(&self) -> Self {
        Self {
            values: std::array::from_fn(|place| self.values[place] / self.counts[place].max(1.0)),
            counts: self.counts.map(|count| count.min(1.0)),
        }
    }
}

/// A set of columns, and its means so far.
struct Resampled<const N: usize> {
    /// The values of all sequences in one list.
    rows: Vec<Row<N>>,
    means: [Vec<f64>; N],
}

impl<const N: usize> Resampled<N> {
    fn new(columns: &[&[Vec<f64>]; N], resamples: usize) -> Self {
        let sequences = columns.first().map_or(&[][..], |column| *column).iter().enumerate();
        let rows = sequences
            .flat_map(|(sequence, seeds)| (0..seeds.len()).map(move |seed| Row::of(columns, sequence, seed)));
        Self { rows: rows.collect(), means: std::array::from_fn(|_| Vec::with_capacity(resamples)) }
    }

    fn add(&mut self, draws: &Draws<'_>) {
        let mut places = draws.places.as_slice();
        for drawn in draws.sequences.chunks_exact(draws.seeds.len()) {
            let mut total = Row::ZERO;
            for &sequence in drawn {
                let (own, others) = places.split_at(draws.seeds[sequence]);
                places = others;
                // A lone seed is the mean without a division.
                if let [only] = own {
                    total.add(&self.rows[*only]);
                } else {
                    let mut of_sequence = Row::ZERO;
                    own.iter().for_each(|place| of_sequence.add(&self.rows[*place]));
                    total.add(&of_sequence.mean());
                }
            }
            for (means, mean) in self.means.iter_mut().zip(total.mean().values) {
                means.push(mean);
            }
        }
    }

    /// Step 3.
    fn intervals(self) -> [Interval; N] {
        let tail = (1.0 - COVERAGE) / 2.0;
        self.means.map(|mut means| Interval {
            low: quantile(&mut means, tail),
            high: quantile(&mut means, 1.0 - tail),
        })
    }
}

/// Interpolated between neighbours; `values` is not empty, and is left in another order.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    let position = share * (values.len() - 1) as f64;
    let (_, &mut below, greater) = values.select_nth_unstable_by(position.floor() as usize, f64::total_cmp);
    let above = greater.iter().copied().min_by(f64::total_cmp).unwrap_or(below);
    below + position.fract() * (above - below)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

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

    /// The steps as they are told, a column at a time.
    fn naive(column: &[Vec<f64>], resamples: usize, seed: u64) -> Interval {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let counted = |values: &[f64]| {
            let counted: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
            (!counted.is_empty()).then(|| counted.iter().sum::<f64>() / counted.len() as f64)
        };
        let mut means = Vec::new();
        for _ in 0..resamples {
            let mut of_sequences = Vec::new();
            for _ in 0..column.len() {
                let sequence = &column[random.random_range(0..column.len())];
                let drawn: Vec<f64> =
                    sequence.iter().map(|_| sequence[random.random_range(0..sequence.len())]).collect();
                of_sequences.push(counted(&drawn).unwrap_or(f64::NAN));
            }
            means.push(counted(&of_sequences).unwrap_or(0.0));
        }
        means.sort_by(f64::total_cmp);
        let quantile = |share: f64| {
            let position = share * (means.len() - 1) as f64;
            let (below, above) = (means[position.floor() as usize], means[position.ceil() as usize]);
            below + position.fract() * (above - below)
        };
        let tail = (1.0 - COVERAGE) / 2.0;
        Interval { low: quantile(tail), high: quantile(1.0 - tail) }
    }

    proptest! {
        #[test]
        fn many_sets_get_the_bits_of_the_steps_as_they_are_told(
            seeds in prop::collection::vec(1..4_usize, 1..12),
            resamples in 1..600_usize,
            seed in 0..9_u64,
        ) {
            // Numbers without an order, every seventh of which does not count.
            let column = |which: usize| -> Vec<Vec<f64>> {
                let value = |place: usize| if place % 7 == which { f64::NAN } else { (place as f64).sin() };
                let of = |(row, count): (usize, &usize)| (0..*count).map(|i| value(which + 5 * row + i)).collect();
                seeds.iter().enumerate().map(of).collect()
            };
            let columns: Vec<Vec<Vec<f64>>> = (0..6).map(column).collect();
            let sets: Vec<[&[Vec<f64>]; 2]> = columns.chunks(2).map(|two| [&two[0][..], &two[1][..]]).collect();
            let found = intervals_of_sets(&sets, resamples, seed).unwrap();
            for (interval, column) in found.iter().flatten().zip(&columns) {
                prop_assert_eq!(*interval, naive(column, resamples, seed));
            }
        }
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
