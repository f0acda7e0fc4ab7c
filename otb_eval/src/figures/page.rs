//! The report's page from scores.

use serde_json::Value;

use super::{NamedPlot, plots};
use crate::{
    catalogue::Attribute,
    plots::Plot,
    report::{
        AttributeChart, AttributeScores, Failure, OverallRow, OverallTable, PlotGroup, Report, Score,
        SequenceRow, SequenceTable, Strip, Tested, Timeline, Tracker,
    },
    results::{Results, TrackerResults},
    scoring::{LongTermScores, Measure, Spread, Table, TrackerScores, against, certainty},
};

/// What the page says besides scores.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PageOptions {
    /// The title.
    pub title: String,
    /// The commands that make the results and the page again.
    pub commands: Vec<String>,
    /// What scoring met.
    pub problems: Vec<String>,
    /// Each sequence over time.
    pub timelines: Vec<Timeline>,
    /// The tracker that all others are tested against, by its place.
    pub against: Option<usize>,
    /// Frames with boxes.
    pub strips: Vec<Strip>,
    /// Long-term scores of all trackers in the tables' order; may be empty.
    pub long_term: Vec<LongTermScores>,
}

/// The page of some protocols' scores, all of the same trackers in the same order, some of them without results in a
/// protocol, which the page says.
pub fn page(tables: &[(Results, Table)], options: PageOptions) -> Report {
    let Some((_, first)) = tables.first() else { return Report::default() };
    let missing = missing_protocols(tables);
    let failures = failures(tables);
    let against = options.against;
    let (versions, trackers) = (versions(tables), trackers(tables));
    let long_term = super::long_term_plot(&options.long_term);
    let long_term =
        long_term.map(|named| PlotGroup { title: "long term".to_owned(), plots: vec![named.plot] });
    let tables: Vec<&Table> = tables.iter().map(|(_, table)| table).collect();
    Report {
        title: options.title,
        subtitle: subtitle(&tables),
        made: None,
        versions,
        trackers,
        commands: options.commands,
        overall: tables.iter().map(|table| overall(table, against)).collect(),
        plots: tables.iter().flat_map(|table| groups(table)).chain(long_term).collect(),
        attributes: tables.iter().flat_map(|table| chart(table)).collect(),
        sequences: tables.iter().flat_map(|table| by_sequence(table)).collect(),
        strips: options.strips,
        timelines: options.timelines,
        failures,
        scoring: options.problems,
        notes: missing.into_iter().chain(notes(first)).collect(),
    }
}

fn subtitle(tables: &[&Table]) -> String {
    let protocols = tables.iter().map(|table| table.protocol.title()).collect::<Vec<_>>().join(", ");
    let (trackers, sequences) =
        tables.first().map_or((0, 0), |one| (one.trackers.len(), one.sequences.len()));
    let toolkit = tables.first().map(|table| table.toolkit.name()).unwrap_or_default();
    format!("{protocols}: {trackers} trackers on {sequences} sequences, under the rules of {toolkit}")
}

/// What is missing: the trackers that have no results of a protocol of which others have some, a line a protocol.
pub fn missing_protocols(tables: &[(Results, Table)]) -> Vec<String> {
    let line = |(results, table): &(Results, Table)| {
        let without = results.trackers.iter().filter(|tracker| tracker.seeds.is_empty());
        let names: Vec<&str> = without.map(|tracker| tracker.name.as_str()).collect();
        (!names.is_empty()).then(|| format!("{}: no results of {}", table.protocol.title(), names.join(", ")))
    };
    tables.iter().filter_map(line).collect()
}

/// Each tracker as the first protocol has it that `run` ran it on, or as it is.
fn first_runs(tables: &[(Results, Table)]) -> Vec<&TrackerResults> {
    let of = |place: usize| {
        let mut all = tables.iter().map(|(results, _)| &results.trackers[place]);
        all.clone().find(|tracker| tracker.run.is_some()).or_else(|| all.next())
    };
    let places = tables.first().map_or(0, |(results, _)| results.trackers.len());
    (0..places).filter_map(of).collect()
}

fn trackers(tables: &[(Results, Table)]) -> Vec<Tracker> {
    first_runs(tables).into_iter().map(tracker).collect()
}

fn versions(tables: &[(Results, Table)]) -> Vec<(String, String)> {
    let mut versions = vec![("scored by".to_owned(), format!("otb_eval {}", infopart::VERSION))];
    for tracker in first_runs(tables) {
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

fn overall(table: &Table, chosen: Option<usize>) -> OverallTable {
    let measures = Measure::quoted(table.toolkit);
    let intervals = certainty(table);
    let chosen = chosen.and_then(|place| Some((place, &table.trackers.get(place)?.tracker)));
    let tested = chosen.map(|(place, _)| against(table, place, measures[0]));
    let row = |(place, one): (usize, &TrackerScores)| {
        let scores = one.overall?;
        let score = |measure: &Measure| {
            let spread: Spread = measure.of(&scores)?;
            let interval = intervals[place][*measure as usize];
            Some(Score { mean: spread.mean, spread: spread.deviation, interval })
        };
        let against = tested.as_ref().and_then(|tested| tested[place].as_ref());
        Some(OverallRow {
            tracker: place,
            seeds: one.seeds.len(),
            scores: measures.iter().map(score).collect(),
            fps: one.frames_per_second,
            against: against.map(|one| Tested {
                difference: one.comparison.difference,
                interval: one.comparison.interval(),
                p: one.corrected_p,
            }),
        })
    };
    OverallTable {
        title: format!("{}, rules of {}", table.protocol.title(), table.toolkit),
        metrics: measures.iter().map(|measure| measure.title().to_owned()).collect(),
        against: chosen.map(|(_, name)| format!("{} less that of {name}", measures[0].title())),
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
    Measure::quoted(table.toolkit).iter().copied().map(of).filter(has_values).collect()
}

fn failures(tables: &[(Results, Table)]) -> Vec<Failure> {
    let mut failures = Vec::new();
    for (results, table) in tables {
        for tracker in &results.trackers {
            for seed in &tracker.seeds {
                failures.extend(seed.failures().map(|(stem, reason)| Failure {
                    job: format!("{}: {}, seed {}, {stem}", table.protocol.title(), tracker.name, seed.seed),
                    reason: reason.to_owned(),
                }));
            }
        }
    }
    failures
}

fn notes(table: &Table) -> Vec<String> {
    let rules = table.toolkit.rules().explain();
    let mut notes: Vec<String> =
        rules.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    notes.push("A score is the mean over seeds; ± is the standard deviation over them, [ ] the 95 % interval over sequences. A difference is paired by sequence, its p is by Wilcoxon's signed-rank test with Holm's correction for the trackers compared. Frames per second are as the line frames/s says, without decoding.".to_owned());
    notes
}
