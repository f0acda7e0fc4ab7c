//! The scores of all trackers: per sequence, per attribute and overall, with their spread over seeds.

use serde::Serialize;

use crate::{
    catalogue::{Attribute, AttributeSource},
    protocol::Protocol,
    results::TrackerResults,
    statistics::{deviation, mean},
    toolkits::{Curves, Rules, Toolkit},
};

/// Scores of all trackers under one toolkit's rules.
#[derive(Debug, Clone, Serialize)]
pub struct Table {
    /// Whose rules.
    pub toolkit: Toolkit,
    /// The protocol.
    pub protocol: Protocol,
    /// Whose attributes.
    pub attributes: Option<AttributeSource>,
    /// The sequences, in the order of every tracker's rows.
    pub sequences: Vec<String>,
    /// The trackers.
    pub trackers: Vec<TrackerScores>,
}

/// One tracker's scores.
#[derive(Debug, Clone, Serialize)]
pub struct TrackerScores {
    /// The tracker's name.
    pub tracker: String,
    /// Its seeds; 0 alone where results know none.
    pub seeds: Vec<u64>,
    /// Mean over sequences; `None` if there is none to score.
    pub overall: Option<Scores>,
    /// Sequences in the mean: those that could be scored with every seed or some.
    pub scored: usize,
    /// By attribute, of those that enough sequences have.
    pub attributes: Vec<AttributeScores>,
    /// By sequence.
    pub sequences: Vec<SequenceScores>,
    /// Updates a second, the mean over sequences; `None` without times.
    pub frames_per_second: Option<f64>,
    /// Mean curves over sequences and seeds.
    pub curves: Option<Curves>,
}

/// Scores over the sequences that have an attribute.
#[derive(Debug, Clone, Serialize)]
pub struct AttributeScores {
    /// The attribute.
    pub attribute: Attribute,
    /// Sequences that have it.
    pub sequences: usize,
    /// Mean over them.
    pub scores: Scores,
    /// Mean curves over them and seeds.
    #[serde(skip)]
    pub curves: Curves,
}

/// Scores on a sequence.
#[derive(Debug, Clone, Serialize)]
pub struct SequenceScores {
    /// The sequence.
    pub sequence: String,
    /// Mean over seeds; `None` if no seed could be scored.
    pub scores: Option<Scores>,
    /// Updates a second, the mean over seeds; `None` without times.
    pub frames_per_second: Option<f64>,
    /// Frames with a time.
    #[serde(skip)]
    pub timed: usize,
    /// Each seed's curves, in the order of the tracker's seeds; `None` where it could not be scored.
    #[serde(skip)]
    pub curves: Vec<Option<Curves>>,
}

/// The numbers that trackers are judged by, each the mean over seeds with its spread.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Scores {
    /// Area under the success curve, in [0, 20/21].
    pub auc: Spread,
    /// Share of frames with a centre error of at most 20 pixels.
    pub precision_20: Spread,
    /// Share of frames with an overlap above 0.5.
    pub success_50: Spread,
    /// Share of frames with an overlap above 0.75.
    pub success_75: Spread,
    /// Normalised precision at 0.2, which toolkits print; `None` where the toolkit has none.
    pub normalised_precision_20: Option<Spread>,
    /// Area under the normalised precision curve: the mean of its 51 values.
    pub normalised_precision_area: Option<Spread>,
    /// Mean overlap.
    pub mean_overlap: Spread,
}

/// A mean and its sample standard deviation over seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The standard deviation; `None` with fewer than two seeds.
    pub deviation: Option<f64>,
}

impl Spread {
    fn of(values: &[f64]) -> Self {
        Self { mean: mean(values.iter().copied()), deviation: deviation(values) }
    }
}

impl Scores {
    /// Over the curves of each seed; `None` without any.
    fn of(seeds: &[Curves]) -> Option<Self> {
        if seeds.is_empty() {
            return None;
        }
        let spread = |value: fn(&Curves) -> f64| Spread::of(&seeds.iter().map(value).collect::<Vec<_>>());
        let optional = |value: fn(&Curves) -> Option<f64>| {
            let values: Option<Vec<f64>> = seeds.iter().map(value).collect();
            values.map(|values| Spread::of(&values))
        };
        Some(Self {
            auc: spread(Curves::auc),
            precision_20: spread(Curves::precision_at_20),
            success_50: spread(Curves::success_at_half),
            success_75: spread(Curves::success_at_three_quarters),
            normalised_precision_20: optional(Curves::normalised_precision_at_02),
            normalised_precision_area: optional(Curves::normalised_precision_area),
            mean_overlap: spread(|curves| curves.mean_overlap),
        })
    }
}

impl SequenceScores {
    /// `speeds` are each seed's frames a second, and of how many frames.
    pub(super) fn new(sequence: &str, curves: Vec<Option<Curves>>, speeds: &[Option<(f64, usize)>]) -> Self {
        let present: Vec<Curves> = curves.iter().flatten().cloned().collect();
        let timed = speeds.iter().flatten().map(|(_, timed)| timed).sum();
        let speeds: Vec<f64> = speeds.iter().flatten().map(|(speed, _)| *speed).collect();
        Self {
            sequence: sequence.to_owned(),
            scores: Scores::of(&present),
            frames_per_second: (!speeds.is_empty()).then(|| mean(speeds.into_iter())),
            timed,
            curves,
        }
    }
}

impl TrackerScores {
    pub(super) fn new(
        tracker: &TrackerResults,
        sequences: Vec<SequenceScores>,
        attributes: Vec<(Attribute, impl Fn(&str) -> bool)>,
        rules: &Rules,
    ) -> Self {
        let seeds: Vec<u64> = tracker.seeds.iter().map(|seed| seed.seed).collect();
        let of = |belongs: &dyn Fn(&str) -> bool| {
            let seeds = seed_means(&sequences, seeds.len(), belongs, rules);
            Some((Scores::of(&seeds)?, Curves::mean(&Toolkit::Plain.rules(), seeds.iter())?))
        };
        let by_attribute = attributes.into_iter().filter_map(|(attribute, has)| {
            let count = sequences.iter().filter(|row| row.scores.is_some() && has(&row.sequence)).count();
            let (scores, curves) = of(&has).filter(|_| count >= rules.least_sequences_of_an_attribute())?;
            Some(AttributeScores { attribute, sequences: count, scores, curves })
        });
        let attributes = by_attribute.collect();
        let (overall, curves) = of(&|_| true).unzip();
        let weight = |row: &SequenceScores| if rules.pools_frames() { row.timed as f64 } else { 1.0 };
        let speeds: Vec<(f64, f64)> =
            sequences.iter().filter_map(|row| Some((row.frames_per_second?, weight(row)))).collect();
        let weights: f64 = speeds.iter().map(|(_, weight)| weight).sum();
        let speed = speeds.iter().map(|(speed, weight)| speed * weight).sum::<f64>() / weights;
        Self {
            tracker: tracker.name.clone(),
            seeds,
            overall,
            scored: sequences.iter().filter(|row| row.scores.is_some()).count(),
            attributes,
            frames_per_second: (weights > 0.0).then_some(speed),
            curves,
            sequences,
        }
    }
}

/// Step 2: each seed's mean over the sequences that belong.
fn seed_means(
    sequences: &[SequenceScores],
    seeds: usize,
    belongs: &dyn Fn(&str) -> bool,
    rules: &Rules,
) -> Vec<Curves> {
    let of_seed = |seed: usize| {
        let rows = sequences.iter().filter(|row| belongs(&row.sequence));
        Curves::mean(rules, rows.filter_map(|row| row.curves.get(seed)?.as_ref()))
    };
    (0..seeds).filter_map(of_seed).collect()
}
