//! `otb_eval compare`: two trackers on the same sequences and seeds.

use std::{fmt::Write as _, path::PathBuf};

use anyhow::Result;
use clap::Args;
use infopart::{output::TextTable, program::BadInput};
use otb_eval::{
    compare::Comparison,
    protocol::Protocol,
    scoring::{
        LongTermScores, Measure, Table, TrackerScores, common_seeds, compare_long_term, compare_scores,
    },
    toolkits::Toolkit,
};
use serde::Serialize;

use super::{
    score::{print, write},
    scored::{ScoredArgs, tell},
};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval compare infopart whole-body --data otb people --results results
  otb_eval compare infopart whole-body --data otb people --results results --json part.json
  otb_eval compare ATOM KCF --data OTB100.json --results published --toolkit pysot
  otb_eval compare infopart mil --data otb people --results results --measure success,normalised,overlap

Where targets leave, by the best F of each sequence, too, each at the threshold that suits it best:
  otb_eval compare infopart mil --data longterm --results results --long-term

A difference is A minus B, paired by sequence and seed; positive is better for A. Its 95 % interval is a bootstrap that \
draws sequences, and seeds within them: where it spans 0, other sequences could well reverse it. p is the two-sided \
probability by Wilcoxon's signed-rank test over sequences. Times are compared \
only if both were measured on one machine with nothing else running.";

#[derive(Debug, Args)]
pub struct CompareArgs {
    /// The first tracker
    #[arg(value_name = "A")]
    first: String,
    /// The second tracker
    #[arg(value_name = "B")]
    second: String,
    #[command(flatten)]
    scored: ScoredArgs,
    /// Whose rules, as `otb_eval score` has them [default: the data set's own; for OTB plain]
    #[arg(long, value_name = "NAME")]
    toolkit: Option<Toolkit>,
    /// Which results: ope, tre or sre
    #[arg(long, value_name = "ope|tre|sre", default_value = "ope")]
    protocol: Protocol,
    /// In which measures: auc, precision, success, success-75, normalised, normalised-area, overlap [default: auc and
    /// precision; for GOT-10k its AO (overlap), SR.5 and SR.75; for LaSOT normalised-area, too]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    measure: Vec<Measure>,
    /// Write the comparison as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Everything that is told of two trackers.
#[derive(Debug, Serialize)]
struct Outcome {
    first: String,
    second: String,
    protocol: Protocol,
    toolkit: Toolkit,
    seeds: Vec<u64>,
    measures: Vec<Compared>,
    /// Time of A over time of B, per update: the geometric mean over sequences.
    time_ratio: Option<f64>,
}

/// The trackers in one measure.
#[derive(Debug, Serialize)]
struct Compared {
    measure: &'static str,
    #[serde(skip)]
    title: &'static str,
    #[serde(flatten)]
    comparison: Comparison,
}

pub fn run(args: &CompareArgs) -> Result<()> {
    args.scored.refuse_trackers()?;
    let (dataset, mut problems) = args.scored.data.open()?;
    let names = [args.first.clone(), args.second.clone()];
    let results = args.scored.open_results(args.protocol)?.only(&names)?;
    let toolkit = args.toolkit.unwrap_or_else(|| Toolkit::of(dataset.benchmark()));
    let (table, unscored) = args.scored.score(&dataset, &results, toolkit, args.protocol)?;
    tell(&unscored, &mut problems);
    if args.scored.long_term && args.protocol != Protocol::Ope {
        return Err(BadInput("--long-term: it is of one-pass results; leave --protocol out".into()).into());
    }
    let long_term = args.scored.long_term(&dataset, &results, toolkit, false)?;
    let outcome = outcome(args, &table, long_term.as_deref())?;
    print(&text(&outcome))?;
    if let Some(path) = &args.json {
        write(path, format!("{}\n", serde_json::to_string_pretty(&outcome)?).as_bytes())?;
    }
    problems.into_strict_result(args.scored.strict)
}

fn outcome(args: &CompareArgs, table: &Table, long_term: Option<&[LongTermScores]>) -> Result<Outcome> {
    let (first, second) = (&table.trackers[0], &table.trackers[1]);
    let nothing = || {
        BadInput(format!(
            "{} and {} have no sequence in common; run both with the same --sequences",
            args.first, args.second
        ))
    };
    common_sequences(first, second).then_some(()).ok_or_else(nothing)?;
    let of = |measure: Measure| {
        let comparison = compare_scores(first, second, measure).ok_or_else(|| {
            let (name, toolkit) = (measure.name(), table.toolkit);
            BadInput(format!("--measure {name}: {toolkit} has none; choose another, or another --toolkit"))
        })?;
        Ok(Compared { measure: measure.key(), title: measure.title(), comparison })
    };
    let asked =
        if args.measure.is_empty() { Measure::compared(table.toolkit) } else { args.measure.as_slice() };
    let mut measures = asked.iter().map(|measure| of(*measure)).collect::<Result<Vec<Compared>>>()?;
    if let Some([first, second]) = long_term {
        let comparison = compare_long_term(first, second).ok_or_else(nothing)?;
        measures.push(Compared { measure: "f", title: "best F", comparison });
    }
    Ok(Outcome {
        first: args.first.clone(),
        second: args.second.clone(),
        protocol: args.protocol,
        toolkit: table.toolkit,
        measures,
        time_ratio: time_ratio(first, second),
        seeds: common_seeds(first, second),
    })
}

/// Whether both have scores of some sequence.
fn common_sequences(first: &TrackerScores, second: &TrackerScores) -> bool {
    first.sequences.iter().zip(&second.sequences).any(|(a, b)| a.scores.is_some() && b.scores.is_some())
}

fn time_ratio(first: &TrackerScores, second: &TrackerScores) -> Option<f64> {
    let logarithms: Vec<f64> = first
        .sequences
        .iter()
        .zip(&second.sequences)
        .filter_map(|(first, second)| Some((second.frames_per_second? / first.frames_per_second?).ln()))
        .collect();
    let mean = logarithms.iter().sum::<f64>() / logarithms.len() as f64;
    (!logarithms.is_empty()).then(|| mean.exp())
}

fn text(outcome: &Outcome) -> String {
    let Outcome { first, second, measures, .. } = outcome;
    let sequences = measures.iter().map(|one| one.comparison.sequences.len()).max().unwrap_or_default();
    let mut text = format!(
        "{first} against {second}: {} under the rules of {}, {sequences} sequences, {}\n\n",
        outcome.protocol.title(),
        outcome.toolkit,
        match outcome.seeds.len() {
            0 => "each one's mean over its own seeds, of which none is in common".to_owned(),
            count => format!("{count} paired seed(s)"),
        }
    );
    let mut summary =
        TextTable::new(["measure", first, second, "difference", "95 % interval", "", "p", "wins"]);
    for Compared { title, comparison: one, .. } in measures {
        summary.row([
            (*title).to_owned(),
            format!("{:.4}", one.first),
            format!("{:.4}", one.second),
            format!("{:+.4}", one.difference),
            format!("[{:+.4}, {:+.4}]", one.low, one.high),
            if one.is_clear() { "clear".into() } else { "spans 0".to_owned() },
            format!("{:.4}", one.p_value),
            format!("{} : {}", one.first_wins, one.second_wins),
        ]);
    }
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{summary}");
    if let Some(ratio) = outcome.time_ratio {
        let _ =
            writeln!(text, "an update of {first} takes {ratio:.3} times one of {second} (geometric mean)\n");
    }
    text + &by_sequence(measures).to_string()
}

/// A row a sequence, three columns a measure.
fn by_sequence(measures: &[Compared]) -> TextTable {
    let of_measure = |one: &Compared| [format!("{} of A", one.title), "of B".into(), "difference".into()];
    let header = ["sequence".to_owned()].into_iter().chain(measures.iter().flat_map(of_measure));
    let mut rows = TextTable::new(header);
    let mut names: Vec<&str> = Vec::new();
    for one in measures.iter().flat_map(|one| &one.comparison.sequences) {
        if !names.contains(&one.sequence.as_str()) {
            names.push(&one.sequence);
        }
    }
    for name in names {
        let cells = |one: &Compared| {
            let Some(found) = one.comparison.sequences.iter().find(|found| found.sequence == name) else {
                return ["-", "-", "-"].map(str::to_owned);
            };
            let spread = found.deviation.map_or(String::new(), |value| format!(" ± {value:.4}"));
            [
                format!("{:.4}", found.first),
                format!("{:.4}", found.second),
                format!("{:+.4}{spread}", found.difference),
            ]
        };
        rows.row([name.to_owned()].into_iter().chain(measures.iter().flat_map(cells)));
    }
    rows
}
