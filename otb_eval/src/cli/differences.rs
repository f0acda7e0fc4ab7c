//! One tracker under six toolkits: where they differ, and why.

use std::{collections::BTreeMap, fmt::Write};

use infopart::output::TextTable;
use otb_eval::{
    dataset::Dataset,
    protocol::Protocol,
    results::{Results, TrackerResults},
    runner::stem,
    scoring::{Measure, ScoreProblem, Table, segments_of, start_of},
    toolkits::{Reason, reasons},
};

/// Sequences that are named; of the others only the number is told.
const NAMED: usize = 3;

/// Scores under every toolkit, what fails where, and what in the files they treat differently.
pub fn text(dataset: &Dataset, results: &Results, scored: &[(Table, Vec<ScoreProblem>)]) -> String {
    let mut text = String::new();
    for measure in [Measure::Auc, Measure::Precision, Measure::Normalised, Measure::NormalisedArea] {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}\n{}", measure.title(), scores(scored, measure));
    }
    let _ = writeln!(
        text,
        "A mean is over the sequences that the toolkit does not fail on; * marks one without some."
    );
    text += &failures(scored);
    text += "\nWhy they differ\n";
    let protocol = scored.first().map_or(Protocol::Ope, |(table, _)| table.protocol);
    text + &why(dataset, &results.trackers, protocol)
}

/// A line for each toolkit and each tracker that it fails on.
fn failures(scored: &[(Table, Vec<ScoreProblem>)]) -> String {
    let mut lines = String::new();
    for (table, problems) in scored {
        for tracker in &table.trackers {
            let (mut stems, mut causes) = (Vec::new(), Vec::new());
            for problem in problems {
                if let ScoreProblem::Crash { tracker: of, stem, source } = problem
                    && *of == tracker.tracker
                {
                    add(&mut stems, stem.clone());
                    add(&mut causes, source.cause());
                }
            }
            if !stems.is_empty() {
                let (name, count) = (&tracker.tracker, stems.len());
                let causes = causes.join("; ");
                lines +=
                    &format!("  {} on {name}, {count}: {}: {causes}\n", table.toolkit, shortened(&stems));
            }
        }
    }
    if lines.is_empty() {
        return lines;
    }
    format!("\nWhere a toolkit would fail (--toolkit plain scores them all; --json has every row)\n{lines}")
}

fn add<T: PartialEq>(list: &mut Vec<T>, one: T) {
    if !list.contains(&one) {
        list.push(one);
    }
}

/// The first few names, and how many more there are.
fn shortened(stems: &[String]) -> String {
    let named = stems.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    match stems.len().saturating_sub(NAMED) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

fn scores(scored: &[(Table, Vec<ScoreProblem>)], measure: Measure) -> TextTable {
    let names = scored.iter().map(|(table, _)| table.toolkit.name());
    let mut text = TextTable::new(["tracker"].into_iter().chain(names));
    let Some((first, _)) = scored.first() else { return text };
    for (index, tracker) in first.trackers.iter().enumerate() {
        let cell = |(table, _): &(Table, Vec<ScoreProblem>)| {
            let one = &table.trackers[index];
            let mark = if one.scored < table.sequences.len() { "*" } else { "" };
            let value = one.overall.and_then(|scores| measure.of(&scores));
            value.map_or("-".into(), |value| format!("{:.6}{mark}", value.mean))
        };
        text.row([tracker.tracker.clone()].into_iter().chain(scored.iter().map(cell)));
    }
    text
}

/// A reason in a tracker's files: of how many rows, and in which.
struct Found {
    reason: Reason,
    rows: usize,
    stems: Vec<String>,
}

/// The reasons in all files, each told once of the trackers that share it.
fn why(dataset: &Dataset, trackers: &[TrackerResults], protocol: Protocol) -> String {
    let mut told: Vec<(Found, Vec<&str>)> = Vec::new();
    for tracker in trackers {
        for found in reasons_in(dataset, tracker, protocol).into_values() {
            let same = |(other, _): &&mut (Found, Vec<&str>)| {
                kind(other.reason) == kind(found.reason)
                    && (other.rows, &other.stems) == (found.rows, &found.stems)
            };
            match told.iter_mut().find(same) {
                Some((_, names)) => names.push(&tracker.name),
                None => told.push((found, vec![&tracker.name])),
            }
        }
    }
    if told.is_empty() {
        return "  nothing in these files that toolkits treat differently\n".to_owned();
    }
    told.sort_by_key(|(found, _)| kind(found.reason));
    let line = |(Found { reason, rows, stems }, names): &(Found, Vec<&str>)| {
        let everyone = names.len() == trackers.len() && names.len() > 1;
        let names = if everyone { "every tracker".to_owned() } else { names.join(", ") };
        format!("  {names}: {}; in {}\n", reason.with_rows(*rows), shortened(stems))
    };
    told.iter().map(line).collect()
}

fn reasons_in(dataset: &Dataset, tracker: &TrackerResults, protocol: Protocol) -> BTreeMap<u8, Found> {
    let mut all: BTreeMap<u8, Found> = BTreeMap::new();
    for seed in &tracker.seeds {
        for target in &dataset.targets {
            for (label, by_rule) in segments_of(protocol, target, seed).unwrap_or_default() {
                let Some(Ok(mut file)) = seed.read(&target.name, label.as_deref()) else { continue };
                if protocol != Protocol::Tre {
                    target.align(&mut file.rows);
                }
                let Some(start) = start_of(protocol, target, by_rule, &file) else { continue };
                for reason in reasons(&target.truth[start..], &file.rows) {
                    let nothing = Found { reason, rows: 0, stems: Vec::new() };
                    let found = all.entry(kind(reason)).or_insert(nothing);
                    found.rows += reason.rows();
                    add(&mut found.stems, stem(&target.name, label.as_deref()));
                }
            }
        }
    }
    all
}

fn kind(reason: Reason) -> u8 {
    match reason {
        Reason::FirstRow => 0,
        Reason::NotPositive(_) => 1,
        Reason::NanTruth(_) => 2,
        Reason::LostBoxes(_) => 3,
        Reason::Shorter(_) => 4,
        Reason::Longer(_) => 5,
    }
}
