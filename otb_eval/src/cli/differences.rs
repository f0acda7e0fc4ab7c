//! One tracker under six toolkits: where they differ, and why.

use std::{collections::BTreeMap, fmt::Write};

use otb_eval::{
    dataset::Dataset,
    protocol::{Protocol, starts_of},
    results::{Results, TrackerResults},
    runner::stem,
    scoring::{Measure, ScoreProblem, Table},
    toolkits::{Reason, reasons},
};

use super::text_table::TextTable;

/// Sequences that are named for a reason; of the others only the number is told.
const NAMED: usize = 6;

/// Scores under every toolkit, what fails where, and what in the files they treat differently.
pub fn text(dataset: &Dataset, results: &Results, scored: &[(Table, Vec<ScoreProblem>)]) -> String {
    let mut text = String::new();
    for measure in [Measure::Auc, Measure::Precision, Measure::Normalised] {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}\n{}", measure.title(), scores(scored, measure));
    }
    let _ = writeln!(
        text,
        "A mean is over the sequences that the toolkit does not fail on; * marks one without some."
    );
    let failures: Vec<&ScoreProblem> =
        scored.iter().flat_map(|(_, problems)| problems).filter(|problem| problem.is_crash()).collect();
    if !failures.is_empty() {
        let _ = writeln!(text, "\nWhere a toolkit would fail");
        failures.iter().for_each(|failure| text += &format!("  {failure}\n"));
    }
    text += "\nWhy they differ\n";
    let protocol = scored.first().map_or(Protocol::Ope, |(table, _)| table.protocol);
    for tracker in &results.trackers {
        text += &why(dataset, tracker, protocol);
    }
    text
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

/// The reasons in a tracker's files, each with its sequences.
fn why(dataset: &Dataset, tracker: &TrackerResults, protocol: Protocol) -> String {
    let mut found: BTreeMap<u8, (Reason, usize, Vec<String>)> = BTreeMap::new();
    for seed in &tracker.seeds {
        for target in &dataset.targets {
            for (label, start) in starts_of(protocol, &target.truth).unwrap_or_default() {
                let Some(Ok(file)) = seed.read(&target.name, label.as_deref()) else { continue };
                for reason in reasons(&target.truth[start..], &file.rows) {
                    let entry = found.entry(kind(reason)).or_insert((reason, 0, Vec::new()));
                    entry.1 += reason.rows();
                    entry.2.push(stem(&target.name, label.as_deref()));
                }
            }
        }
    }
    if found.is_empty() {
        return format!("  {}: nothing in its files that toolkits treat differently\n", tracker.name);
    }
    let line = |(reason, rows, mut stems): (Reason, usize, Vec<String>)| {
        stems.dedup();
        let more = stems.len().saturating_sub(NAMED);
        let others = if more > 0 { format!(" and {more} more") } else { String::new() };
        format!(
            "  {}: {}; in {}{others}\n",
            tracker.name,
            reason.with_rows(rows),
            stems[..stems.len() - more].join(", ")
        )
    };
    found.into_values().map(line).collect()
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
