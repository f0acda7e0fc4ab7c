//! Scores every tracker on every sequence under one toolkit's rules.
//!
//! Steps:
//! 1. a sequence's hits are those of its segments together, over the frames of its segments together,
//! 2. a tracker's curves are the unweighted mean of its sequences' curves, for each seed,
//! 3. what is reported is the mean over seeds, and the spread over them.

mod certainty;
mod long_term;
mod measure;
mod problem;
mod segments;
mod sequence;
mod speed;
mod table;

use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::{
    catalogue::{self, Attribute, AttributeSource},
    dataset::{Dataset, Target},
    protocol::Protocol,
    results::{Results, SeedResults, TrackerResults, listed_as},
    toolkits::Rules,
};

pub use certainty::{Against, against, certainty, common_seeds, compare_long_term, compare_scores};
pub use long_term::{LongTermPoint, LongTermScores, LongTermSequence, has_absence, long_term};
pub use measure::{Measure, UnknownMeasure};
pub use problem::{ScoreProblem, Weight};
pub use segments::{Segment, segments_of, start_of};
pub use speed::frames_per_second;
pub use table::{AttributeScores, Scores, SequenceScores, Spread, Table, TrackerScores};

/// How to score.
#[derive(Debug, Clone)]
pub struct ScoreOptions {
    /// The toolkit's rules.
    pub rules: Rules,
    /// The protocol that the results are of.
    pub protocol: Protocol,
    /// The sequences; `None` for all of which any tracker has a result.
    pub sequences: Option<Vec<String>>,
    /// Whose attributes the table by attribute uses; `None` for no such table.
    pub attributes: Option<AttributeSource>,
    /// Whether the scaling of SRE's scaled runs is undone before comparing.
    pub undo_scale: bool,
    /// Whether a result of another length than its truth is scored without being told as a problem.
    pub accept_lengths: bool,
}

/// Scores results against the truth. What cannot be scored is told beside the table of everything else.
pub fn score(dataset: &Dataset, results: &Results, options: &ScoreOptions) -> (Table, Vec<ScoreProblem>) {
    let mut problems = Vec::new();
    let targets = targets(dataset, results, options, &mut problems);
    let mut trackers = Vec::new();
    for tracker in &results.trackers {
        let (scores, of_tracker) = tracker_scores(tracker, &targets, options);
        trackers.push(scores);
        problems.extend(of_tracker);
    }
    let table = Table {
        toolkit: options.rules.toolkit(),
        protocol: options.protocol,
        attributes: options.attributes,
        sequences: targets.iter().map(|target| target.name.clone()).collect(),
        trackers,
    };
    (table, problems)
}

/// The targets to score, in the order of the data; what is asked for and not there is a problem.
fn targets<'a>(
    dataset: &'a Dataset,
    results: &Results,
    options: &ScoreOptions,
    problems: &mut Vec<ScoreProblem>,
) -> Vec<&'a Target> {
    let wanted = match &options.sequences {
        Some(names) => names.iter().cloned().collect(),
        None => sequences_with_results(dataset, results, options.protocol, problems),
    };
    for name in &wanted {
        if dataset.target(name).is_none() {
            problems.push(ScoreProblem::NoTruth { sequence: name.clone() });
        }
    }
    let seeds = || results.trackers.iter().flat_map(|tracker| &tracker.seeds);
    let is_scorable = |target: &&Target| match target.starts(options.protocol) {
        Err(source) if !seeds().any(|seed| segments_of(options.protocol, target, seed).is_ok()) => {
            problems.push(ScoreProblem::Protocol { sequence: target.name.clone(), source });
            false
        }
        _ if target.annotations.first_only => {
            problems.push(ScoreProblem::FirstOnly { sequence: target.name.clone() });
            false
        }
        _ => true,
    };
    dataset.targets.iter().filter(|target| wanted.contains(&target.name)).filter(is_scorable).collect()
}

/// Sequences of the data with a result of any tracker, and of results for which the data has no truth.
fn sequences_with_results(
    dataset: &Dataset,
    results: &Results,
    protocol: Protocol,
    problems: &mut Vec<ScoreProblem>,
) -> BTreeSet<String> {
    let stems: BTreeSet<&str> = results
        .trackers
        .iter()
        .flat_map(|tracker| &tracker.seeds)
        .flat_map(|seed| seed.stems().chain(seed.failures().map(|(stem, _)| stem)))
        .collect();
    let (mut wanted, mut explained) = (BTreeSet::new(), BTreeSet::new());
    for target in &dataset.targets {
        let seeds = results.trackers.iter().flat_map(|tracker| &tracker.seeds);
        let segments = seeds.flat_map(|seed| segments_of(protocol, target, seed).unwrap_or_default());
        let labels: BTreeSet<Option<String>> = segments.map(|(label, _)| label).collect();
        for label in labels {
            let stem = listed_as(&crate::runner::stem(&target.name, label.as_deref()));
            if stems.contains(stem.as_str()) {
                wanted.insert(target.name.clone());
                explained.insert(stem);
            }
        }
    }
    for stem in stems.iter().filter(|stem| !explained.contains(**stem)) {
        problems.push(ScoreProblem::NoTruth { sequence: (*stem).to_owned() });
    }
    wanted
}

fn tracker_scores(
    tracker: &TrackerResults,
    targets: &[&Target],
    options: &ScoreOptions,
) -> (TrackerScores, Vec<ScoreProblem>) {
    let jobs: Vec<(&Target, &SeedResults)> =
        targets.iter().flat_map(|target| tracker.seeds.iter().map(move |seed| (*target, seed))).collect();
    let outcomes: Vec<_> =
        jobs.par_iter().map(|(target, seed)| sequence::score(tracker, seed, target, options)).collect();
    let (mut curves, mut problems, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
    for outcome in outcomes {
        speeds.push(outcome.frames_per_second.map(|speed| (speed, outcome.timed)));
        curves.push(outcome.curves);
        problems.extend(outcome.problems);
    }
    let seeds = tracker.seeds.len();
    let of_target = |(place, target): (usize, &&Target)| {
        let own = place * seeds..(place + 1) * seeds;
        SequenceScores::new(&target.name, curves[own.clone()].to_vec(), &speeds[own])
    };
    let rows: Vec<SequenceScores> = targets.iter().enumerate().map(of_target).collect();
    (TrackerScores::new(tracker, rows, attribute_sets(options.attributes), &options.rules), problems)
}

/// The eleven attributes and the sequences that have each, by that source.
fn attribute_sets(source: Option<AttributeSource>) -> Vec<(Attribute, impl Fn(&str) -> bool)> {
    let has = move |attribute: Attribute, source: AttributeSource| {
        move |sequence: &str| {
            catalogue::find(sequence).is_some_and(|known| known.attributes(source).contains(attribute))
        }
    };
    source
        .map(|source| {
            Attribute::ALL.into_iter().map(|attribute| (attribute, has(attribute, source))).collect()
        })
        .unwrap_or_default()
}

#[cfg(test)]
mod tests;
