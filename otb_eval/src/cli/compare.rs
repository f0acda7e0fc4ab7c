//! `otb_eval compare`: two trackers on the same sequences and seeds.

use std::{fmt::Write as _, path::PathBuf};

use anyhow::Result;
use clap::Args;
use infopart::{output::TextTable, program::BadInput};
use otb_eval::{
    compare::Comparison,
    protocol::Protocol,
    scoring::{Measure, Table, TrackerScores, common_seeds, compare_scores},
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
    auc: Comparison,
    precision: Comparison,
    /// Time of A over time of B, per update: the geometric mean over sequences.
    time_ratio: Option<f64>,
}

pub fn run(args: &CompareArgs) -> Result<()> {
    args.scored.refuse_trackers()?;
    let (dataset, mut problems) = args.scored.data.open()?;
    let names = [args.first.clone(), args.second.clone()];
    let results = args.scored.open_results(args.protocol)?.only(&names)?;
    let toolkit = args.toolkit.unwrap_or_else(|| Toolkit::of(dataset.benchmark()));
    let (table, unscored) = args.scored.score(&dataset, &results, toolkit, args.protocol)?;
    tell(&unscored, &mut problems);
    let outcome = outcome(args, &table)?;
    print(&text(&outcome))?;
    if let Some(path) = &args.json {
        write(path, format!("{}\n", serde_json::to_string_pretty(&outcome)?).as_bytes())?;
    }
    problems.into_strict_result(args.scored.strict)
}

fn outcome(args: &CompareArgs, table: &Table) -> Result<Outcome> {
    let (first, second) = (&table.trackers[0], &table.trackers[1]);
    let of = |measure: Measure| {
        compare_scores(first, second, measure).ok_or_else(|| {
            BadInput(format!(
                "{} and {} have no sequence in common; run both with the same --sequences",
                args.first, args.second
            ))
        })
    };
    Ok(Outcome {
        first: args.first.clone(),
        second: args.second.clone(),
        protocol: args.protocol,
        toolkit: table.toolkit,
        auc: of(Measure::Auc)?,
        precision: of(Measure::Precision)?,
        time_ratio: time_ratio(first, second),
        seeds: common_seeds(first, second),
    })
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
    let Outcome { first, second, auc, precision, .. } = outcome;
    let mut text = format!(
        "{first} against {second}: {} under the rules of {}, {} sequences, {}\n\n",
        outcome.protocol.title(),
        outcome.toolkit,
        auc.sequences.len(),
        match outcome.seeds.len() {
            0 => "each one's mean over its own seeds, of which none is in common".to_owned(),
            count => format!("{count} paired seed(s)"),
        }
    );
    let mut summary =
        TextTable::new(["measure", first, second, "difference", "95 % interval", "", "p", "wins"]);
    for (measure, one) in [(Measure::Auc, auc), (Measure::Precision, precision)] {
        summary.row([
            measure.title().to_owned(),
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
    let mut rows = TextTable::new([
        "sequence",
        "AUC of A",
        "of B",
        "difference",
        "precision of A",
        "of B",
        "difference",
    ]);
    for (auc, precision) in auc.sequences.iter().zip(&precision.sequences) {
        let spread =
            |deviation: Option<f64>| deviation.map_or(String::new(), |value| format!(" ± {value:.4}"));
        rows.row([
            auc.sequence.clone(),
            format!("{:.4}", auc.first),
            format!("{:.4}", auc.second),
            format!("{:+.4}{}", auc.difference, spread(auc.deviation)),
            format!("{:.4}", precision.first),
            format!("{:.4}", precision.second),
            format!("{:+.4}{}", precision.difference, spread(precision.deviation)),
        ]);
    }
    text + &rows.to_string()
}
