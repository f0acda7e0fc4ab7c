//! The report's page from scores.

use serde_json::Value;

use super::{NamedPlot, plots};
use crate::{
    catalogue::Attribute,
    plots::Plot,
    report::{
        AttributeChart, AttributeScores, Failure, OverallRow, OverallTable, PlotGroup, Report, Score,
        SequenceRow, SequenceTable, Strip, Tracker,
    },
    results::{Results, TrackerResults},
    scoring::{Measure, Spread, Table, TrackerScores},
};

/// What the page says besides scores.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PageOptions {
    /// The title.
    pub title: String,
    /// The commands that make the results and the page again.
    pub commands: Vec<String>,
    /// What could not be scored.
    pub problems: Vec<String>,
    /// Frames with boxes.
    pub strips: Vec<Strip>,
}

/// The page of some protocols' scores, all of the same trackers and in the same order.
pub fn page(tables: &[(Results, Table)], options: PageOptions) -> Report {
    let Some((results, first)) = tables.first() else { return Report::default() };
    let tables: Vec<&Table> = tables.iter().map(|(_, table)| table).collect();
    Report {
        title: options.title,
        subtitle: subtitle(&tables),
        made: None,
        versions: versions(results),
        trackers: results.trackers.iter().map(tracker).collect(),
        commands: options.commands,
        overall: tables.iter().map(|table| overall(table)).collect(),
        plots: tables.iter().flat_map(|table| groups(table)).collect(),
        attributes: tables.iter().flat_map(|table| chart(table)).collect(),
        sequences: tables.iter().flat_map(|table| by_sequence(table)).collect(),
        strips: options.strips,
        failures: failures(results, options.problems),
        notes: notes(first),
    }
}

fn subtitle(tables: &[&Table]) -> String {
    let protocols = tables.iter().map(|table| table.protocol.title()).collect::<Vec<_>>().join(", ");
    let (trackers, sequences) =
        tables.first().map_or((0, 0), |one| (one.trackers.len(), one.sequences.len()));
    let toolkit = tables.first().map(|table| table.toolkit.name()).unwrap_or_default();
    format!("{protocols}: {trackers} trackers on {sequences} sequences, under the rules of {toolkit}")
}

fn versions(results: &Results) -> Vec<(String, String)> {
    let mut versions = vec![("scored by".to_owned(), format!("otb_eval {}", infopart::VERSION))];
    for tracker in &results.trackers {
        if let Some((identity, machine)) = &tracker.run {
            let processor = machine.processor.as_deref().unwrap_or("unknown processor");
            let hash: String = identity.parameters_hash.chars().take(12).collect();
            let run = format!(
                "{}, parameters {hash}, {} on {processor}, {} jobs of {} thread(s)",
                identity.program, machine.system, machine.jobs, machine.threads_per_job
            );
            versions.push((tracker.name.clone(), run));
        }
    }
    versions
}

fn tracker(results: &TrackerResults) -> Tracker {
    let parameters = results.run.as_ref().and_then(|(identity, _)| identity.parameters.as_object());
    let told = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let parameters = parameters.into_iter().flatten().map(|(name, value)| (name.clone(), told(value)));
    Tracker { label: results.name.clone(), parameters: parameters.collect() }
}

fn overall(table: &Table) -> OverallTable {
    let score = |spread: Spread| Score { mean: spread.mean, spread: spread.deviation };
    let row = |(place, one): (usize, &TrackerScores)| {
        let scores = one.overall?;
        Some(OverallRow {
            tracker: place,
            seeds: one.seeds.len(),
            scores: Measure::ALL.map(|measure| measure.of(&scores).map(score)).to_vec(),
            fps: one.frames_per_second,
        })
    };
    OverallTable {
        title: format!("{}, rules of {}", table.protocol.title(), table.toolkit),
        metrics: Measure::ALL.map(|measure| measure.title().to_owned()).to_vec(),
        rows: table.trackers.iter().enumerate().filter_map(row).collect(),
    }
}

/// A tab with the plots over all sequences, and one with those by attribute.
fn groups(table: &Table) -> Vec<PlotGroup> {
    let is_of_attribute =
        |plot: &NamedPlot| Attribute::ALL.iter().any(|one| plot.name.ends_with(&format!("_{one}")));
    let (by_attribute, overall): (Vec<NamedPlot>, Vec<NamedPlot>) =
        plots(table).into_iter().partition(is_of_attribute);
    let of = |named: Vec<NamedPlot>| named.into_iter().map(|one| one.plot).collect::<Vec<Plot>>();
    let protocol = table.protocol.title();
    let groups = [(protocol.to_owned(), of(overall)), (format!("{protocol} by attribute"), of(by_attribute))];
    groups
        .into_iter()
        .filter(|(_, plots)| !plots.is_empty())
        .map(|(title, plots)| PlotGroup { title, plots })
        .collect()
}

fn chart(table: &Table) -> Option<AttributeChart> {
    let source = table.attributes?;
    let of = |one: &TrackerScores, attribute| {
        one.attributes.iter().find(|scores| scores.attribute == attribute).cloned()
    };
    let scores = |attribute: Attribute| {
        let sequences = super::sequences_with(table, attribute)?;
        let scores = table.trackers.iter().map(|one| Some(of(one, attribute)?.scores.auc.mean)).collect();
        Some(AttributeScores { attribute: attribute.code().to_owned(), sequences, scores })
    };
    let attributes: Vec<AttributeScores> = Attribute::ALL.into_iter().filter_map(scores).collect();
    let title = format!("AUC, {}", table.protocol.title());
    (!attributes.is_empty()).then(|| AttributeChart { title, source: source.to_string(), attributes })
}

fn by_sequence(table: &Table) -> Vec<SequenceTable> {
    let of = |measure: Measure| {
        let value = |one: &TrackerScores, row: usize| Some(measure.of(&one.sequences[row].scores?)?.mean);
        let rows = table.sequences.iter().enumerate().map(|(row, sequence)| SequenceRow {
            sequence: sequence.clone(),
            scores: table.trackers.iter().map(|one| value(one, row)).collect(),
        });
        SequenceTable {
            metric: format!("{}, {}", table.protocol.title(), measure.title()),
            rows: rows.collect(),
        }
    };
    let has_values =
        |table: &SequenceTable| table.rows.iter().any(|row| row.scores.iter().any(Option::is_some));
    Measure::ALL.into_iter().map(of).filter(has_values).collect()
}

fn failures(results: &Results, problems: Vec<String>) -> Vec<Failure> {
    let mut failures = Vec::new();
    for tracker in &results.trackers {
        for seed in &tracker.seeds {
            failures.extend(seed.failures().map(|(stem, reason)| Failure {
                job: format!("{}, seed {}, {stem}", tracker.name, seed.seed),
                reason: reason.to_owned(),
            }));
        }
    }
    failures.extend(problems.into_iter().map(|reason| Failure { job: "scoring".to_owned(), reason }));
    failures
}

fn notes(table: &Table) -> Vec<String> {
    let rules = table.toolkit.rules().explain();
    let mut notes: Vec<String> =
        rules.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    notes.push("A score is the mean over seeds; ± is the standard deviation over them. Frames per second are updates alone, without decoding and init.".to_owned());
    notes
}
