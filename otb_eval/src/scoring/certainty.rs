//! How sure scores are: intervals over sequences and seeds, and every tracker against a chosen one.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::{LongTermScores, LongTermSequence, Measure, Table, TrackerScores};
use crate::{
    compare::{Comparison, Pair, compare},
    statistics::{Interval, RESAMPLES, holm, intervals_of_sets, mean},
    toolkits::{Curves, Rules},
};

/// Seed of the bootstrap: the same results give the same interval.
const BOOTSTRAP_SEED: u64 = 1;

/// A measure's values: sequences, each with a value a seed.
type Columns = [Vec<Vec<f64>>; Measure::COUNT];

/// The 95 % interval of each measure of [`Measure::ALL`], for each tracker of a table in its order; `None` where there is no
/// score.
pub fn certainty(table: &Table) -> Vec<[Option<Interval>; Measure::COUNT]> {
    let rules = table.toolkit.rules();
    let columns: Vec<Columns> = table.trackers.par_iter().map(|one| columns_of(one, &rules)).collect();
    // Nearly always all trackers have the same sequences and seeds, which then are drawn once.
    let mut alike: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (place, columns) in columns.iter().enumerate() {
        alike.entry(columns[0].iter().map(Vec::len).collect()).or_default().push(place);
    }
    let mut found = vec![[None; Measure::COUNT]; columns.len()];
    for places in alike.values() {
        let sets: Vec<_> = places.iter().map(|place| columns[*place].each_ref().map(Vec::as_slice)).collect();
        let intervals = intervals_of_sets(&sets, RESAMPLES, BOOTSTRAP_SEED).unwrap_or_default();
        for (place, intervals) in places.iter().zip(intervals) {
            let is_known = |column: &Vec<Vec<f64>>| column.iter().flatten().any(|value| !value.is_nan());
            found[*place] = std::array::from_fn(|measure| {
                Some(intervals[measure]).filter(|_| is_known(&columns[*place][measure]))
            });
        }
    }
    found
}

/// Of the sequences that it has a score of.
fn columns_of(one: &TrackerScores, rules: &Rules) -> Columns {
    Measure::ALL.map(|measure| {
        let value = |curves: &Curves| measure.counted(curves, rules).unwrap_or(f64::NAN);
        let sequences = one.sequences.iter().map(|row| row.curves.iter().flatten().map(value).collect());
        sequences.filter(|seeds: &Vec<f64>| !seeds.is_empty()).collect()
    })
}

/// A tracker against the chosen one.
#[derive(Debug, Clone, PartialEq)]
pub struct Against {
    /// Its scores less those of the chosen one, paired by sequence and seed.
    pub comparison: Comparison,
    /// The probability by Wilcoxon's signed-rank test, corrected by Holm's rule for all trackers that were compared.
    pub corrected_p: f64,
}

/// Every tracker of a table against the one at `chosen`, in the table's order; `None` for that one itself, and for those
/// that have no sequence and seed with it.
pub fn against(table: &Table, chosen: usize, measure: Measure) -> Vec<Option<Against>> {
    let Some(other) = table.trackers.get(chosen) else { return Vec::new() };
    let compared = |(place, one): (usize, &TrackerScores)| {
        if place == chosen { None } else { compare_scores(one, other, measure) }
    };
    let comparisons: Vec<Option<Comparison>> = table.trackers.par_iter().enumerate().map(compared).collect();
    let probabilities: Vec<f64> = comparisons.iter().flatten().map(|one| one.p_value).collect();
    let corrected = holm(&probabilities);
    let mut corrected = corrected.into_iter();
    let mut against = Vec::new();
    for comparison in comparisons {
        against.push(match comparison {
            Some(comparison) => corrected.next().map(|corrected_p| Against { comparison, corrected_p }),
            None => None,
        });
    }
    against
}

/// Two trackers of a table in a measure; `None` if they have no sequence and seed in common.
pub fn compare_scores(first: &TrackerScores, second: &TrackerScores, measure: Measure) -> Option<Comparison> {
    compare(&pairs(first, second, measure), RESAMPLES, BOOTSTRAP_SEED)
}

/// Sequences that both have, with the values of the seeds that both have. Trackers of different seeds, such as a published one
/// that knows none, are paired by the mean of each over its own seeds.
fn pairs(first: &TrackerScores, second: &TrackerScores, measure: Measure) -> Vec<Pair> {
    let seeds = common_seeds(first, second);
    let value = |one: &TrackerScores, row: usize, seed: u64| {
        let place = one.seeds.iter().position(|known| *known == seed)?;
        measure.on(one.sequences[row].curves[place].as_ref()?).filter(|value| !value.is_nan())
    };
    let of_all = |one: &TrackerScores, row: usize| {
        let curves = one.sequences[row].curves.iter().flatten();
        let values: Vec<f64> =
            curves.filter_map(|curves| measure.on(curves)).filter(|value| !value.is_nan()).collect();
        (!values.is_empty()).then(|| mean(values.into_iter()))
    };
    let pair = |row: usize| {
        let both = |seed: &u64| Some((value(first, row, *seed)?, value(second, row, *seed)?));
        let (one, other): (Vec<f64>, Vec<f64>) = if seeds.is_empty() {
            of_all(first, row).zip(of_all(second, row)).into_iter().unzip()
        } else {
            seeds.iter().filter_map(both).unzip()
        };
        Pair { sequence: first.sequences[row].sequence.clone(), first: one, second: other }
    };
    (0..first.sequences.len()).map(pair).filter(|pair| !pair.first.is_empty()).collect()
}

/// Two trackers in the best F of each sequence, paired by the seeds that both have, or by their means where they have none in
/// common; `None` without a sequence of both.
pub fn compare_long_term(first: &LongTermScores, second: &LongTermScores) -> Option<Comparison> {
    let pair = |one: &LongTermSequence| {
        let other = second.sequences.iter().find(|other| other.sequence == one.sequence)?;
        let of =
            |seeds: &[(u64, f64)], seed: u64| seeds.iter().find(|(known, _)| *known == seed).map(|(_, f)| *f);
        let both = |&(seed, f): &(u64, f64)| Some((f, of(&other.seeds, seed)?));
        let (mut one_has, mut other_has): (Vec<f64>, Vec<f64>) = one.seeds.iter().filter_map(both).unzip();
        if one_has.is_empty() {
            (one_has, other_has) = (vec![one.f], vec![other.f]);
        }
        Some(Pair { sequence: one.sequence.clone(), first: one_has, second: other_has })
    };
    let pairs: Vec<Pair> = first.sequences.iter().filter_map(pair).collect();
    compare(&pairs, RESAMPLES, BOOTSTRAP_SEED)
}

/// The seeds that both trackers have.
pub fn common_seeds(first: &TrackerScores, second: &TrackerScores) -> Vec<u64> {
    first.seeds.iter().copied().filter(|seed| second.seeds.contains(seed)).collect()
}
