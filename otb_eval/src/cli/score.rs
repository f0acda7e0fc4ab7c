//! `otb_eval score`: tables under one toolkit's rules, or under all six.

use std::{
    fmt::Write as _,
    io::Write as _,
    path::{Path, PathBuf},
};

use anyhow::Result;
use clap::Args;
use infopart::{
    output::{Destination, OutputError, StandardOutput, TextTable},
    program::BadInput,
};
use otb_eval::{
    protocol::Protocol,
    scoring::{Measure, ScoreProblem, Spread, Table, TrackerScores},
    store::write_whole,
    toolkits::{Toolkit, UnknownToolkit},
};

use super::{
    differences,
    inputs::Problems,
    scored::{ScoredArgs, tell},
};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval score --data otb people --results results
  otb_eval score --data OTB100.json --results published --toolkit matlab --json scores.json

Where the six toolkits differ, and why; and the rules of one:
  otb_eval score --data OTB100.json --results published --toolkit all
  otb_eval score --explain --toolkit got10k

Only sequences count of which some tracker has a result, or those of --sequences; one without the result of another \
tracker is named. Frames per second are updates alone, without init and decoding; under got10k the mean of every \
frame's own, init among them. Normalised precision is quoted at 0.2, as pysot, stvir and pytracking print it.

A result is rows of x,y,w,h. A header line, semicolons, a column of frame numbers or of scores, polygons and VOT's code for \
the box given are read where they have one meaning, and told; anything else is refused with its line.

Exit codes: 0 everything is scored, defects of others' results too, which are listed (--strict takes them for problems), \
1 internal failure, 2 bad input, or something could not be scored (it is named, and everything else is scored)";

#[derive(Debug, Args)]
pub struct ScoreArgs {
    #[command(flatten)]
    scored: ScoredArgs,
    /// Whose rules: plain (no toolkit's special rules), matlab, jwlim, pysot, stvir, got10k, pytracking, or all six
    #[arg(long, value_name = "NAME|all", default_value = "plain", value_parser = parse_toolkits)]
    toolkit: Toolkits,
    /// Which results: ope, tre or sre
    #[arg(long, value_name = "ope|tre|sre", default_value = "ope")]
    protocol: Protocol,
    /// What the tables by sequence and by attribute show: auc, precision, success, normalised, normalised-area or overlap
    #[arg(long, value_name = "NAME", default_value = "auc")]
    measure: Measure,
    /// Write everything, curves too, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// State thresholds, inequalities and rules in force, and score nothing
    #[arg(long)]
    explain: bool,
}

/// One toolkit or all six.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Toolkits {
    One(Toolkit),
    Six,
}

pub fn parse_toolkits(word: &str) -> Result<Toolkits, UnknownToolkit> {
    if word.eq_ignore_ascii_case("all") { Ok(Toolkits::Six) } else { word.parse().map(Toolkits::One) }
}

pub fn score(args: &ScoreArgs) -> Result<()> {
    let toolkits = match args.toolkit {
        Toolkits::One(toolkit) => vec![toolkit],
        Toolkits::Six => Toolkit::SIX.to_vec(),
    };
    if args.explain {
        let texts: Vec<String> =
            toolkits.iter().map(|toolkit| args.scored.rules(*toolkit).explain()).collect();
        return print(&texts.join("\n"));
    }
    let results = args.scored.open_results(args.protocol)?;
    let (dataset, mut problems) = args.scored.data.open()?;
    let mut scored = Vec::new();
    for toolkit in toolkits {
        scored.push(args.scored.score(&dataset, &results, toolkit, args.protocol)?);
    }
    match args.toolkit {
        Toolkits::One(_) => {
            let (table, unscored) = &scored[0];
            tell(unscored, &mut problems);
            print(&text_of(table, args.measure))?;
        }
        Toolkits::Six => {
            tell_once(&scored, &mut problems);
            print(&differences::text(&dataset, &results, &scored))?;
        }
    }
    if let Some(path) = &args.json {
        write_json(path, &scored)?;
    }
    problems.into_strict_result(args.scored.strict)
}

/// Under six toolkits, the failures of some are a finding; what none can score is a problem, told once.
fn tell_once(scored: &[(Table, Vec<ScoreProblem>)], problems: &mut Problems) {
    if let Some((_, unscored)) = scored.first() {
        let is_finding = |problem: &&ScoreProblem| problem.is_crash() || problem.is_length();
        tell(unscored.iter().filter(|problem| !is_finding(problem)), problems);
    }
}

fn write_json(path: &Path, scored: &[(Table, Vec<ScoreProblem>)]) -> Result<()> {
    let tables: Vec<serde_json::Value> = scored
        .iter()
        .map(|(table, problems)| {
            let problems: Vec<String> = problems.iter().map(ToString::to_string).collect();
            Ok(serde_json::json!({ "table": serde_json::to_value(table)?, "problems": problems }))
        })
        .collect::<Result<_, serde_json::Error>>()?;
    let program = format!("otb_eval {}", infopart::VERSION);
    let text = serde_json::to_string_pretty(&serde_json::json!({ "program": program, "tables": tables }))?;
    write(path, format!("{text}\n").as_bytes())
}

/// Writes a file whole.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    Ok(write_whole(path, bytes).map_err(|source| OutputError::Io { path: path.to_owned(), source })?)
}

/// Prints to standard output.
pub fn print(text: &str) -> Result<()> {
    let mut output = StandardOutput::new();
    let written = output.write_all(text.as_bytes()).map_err(|error| output.name_error(error));
    written.and_then(|()| output.complete()).map_err(|error| match error {
        OutputError::Closed => error.into(),
        // The library's own words name a flag that not every command has.
        other => BadInput(
            other.to_string().replace("write to a file with --out", "make room, or send it elsewhere"),
        )
        .into(),
    })
}

fn text_of(table: &Table, measure: Measure) -> String {
    let mut text = format!(
        "{} under the rules of {} ({}), {} sequences; `--explain` states them\n\n",
        table.protocol.title(),
        table.toolkit,
        table.toolkit.title(),
        table.sequences.len()
    );
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{}", overall(table));
    if let Some(source) = table.attributes {
        let by_attribute = by_attribute(table, measure);
        let _ = writeln!(text, "{} by attribute, as {source} has them\n{by_attribute}", measure.title());
    }
    let _ = write!(text, "{} by sequence\n{}", measure.title(), by_sequence(table, measure));
    text
}

/// Trackers by AUC, the best first; those without scores last.
pub fn ranked(table: &Table) -> Vec<&TrackerScores> {
    let mut trackers: Vec<&TrackerScores> = table.trackers.iter().collect();
    let auc = |one: &TrackerScores| one.overall.map_or(f64::NEG_INFINITY, |scores| scores.auc.mean);
    trackers.sort_by(|a, b| auc(b).total_cmp(&auc(a)));
    trackers
}

/// A mean with its spread, if it has one.
pub fn with_spread(value: Option<Spread>) -> String {
    match value {
        None => "-".into(),
        Some(Spread { mean, deviation: None }) => format!("{mean:.4}"),
        Some(Spread { mean, deviation: Some(deviation) }) => format!("{mean:.4} ± {deviation:.4}"),
    }
}

fn overall(table: &Table) -> TextTable {
    let headings = ["tracker", "seeds", "sequences"].into_iter();
    let mut text = TextTable::new(headings.chain(Measure::ALL.map(Measure::title)).chain(["frames/s"]));
    for one in ranked(table) {
        let seeds = if one.seeds == [0] { "-".to_owned() } else { one.seeds.len().to_string() };
        let mut cells = vec![one.tracker.clone(), seeds, one.scored.to_string()];
        cells.extend(Measure::ALL.map(|measure| with_spread(one.overall.and_then(|s| measure.of(&s)))));
        cells.push(one.frames_per_second.map_or("-".into(), |speed| format!("{speed:.1}")));
        text.row(cells);
    }
    text
}

fn by_attribute(table: &Table, measure: Measure) -> TextTable {
    let trackers = ranked(table);
    let mut text = TextTable::new(
        ["attribute", "sequences"].into_iter().chain(trackers.iter().map(|one| one.tracker.as_str())),
    );
    for attribute in otb_eval::catalogue::Attribute::ALL {
        let of =
            |one: &TrackerScores| one.attributes.iter().find(|scores| scores.attribute == attribute).cloned();
        let Some(sequences) = trackers.iter().filter_map(|one| of(one)).map(|scores| scores.sequences).max()
        else {
            continue;
        };
        let cells = trackers.iter().map(|one| mean_of(of(one).and_then(|scores| measure.of(&scores.scores))));
        text.row([attribute.code().to_owned(), sequences.to_string()].into_iter().chain(cells));
    }
    text
}

fn by_sequence(table: &Table, measure: Measure) -> TextTable {
    let trackers = ranked(table);
    let mut text =
        TextTable::new(["sequence"].into_iter().chain(trackers.iter().map(|one| one.tracker.as_str())));
    for (index, sequence) in table.sequences.iter().enumerate() {
        let of = |one: &&TrackerScores| one.sequences[index].scores.and_then(|scores| measure.of(&scores));
        text.row([sequence.clone()].into_iter().chain(trackers.iter().map(|one| mean_of(of(one)))));
    }
    text
}

fn mean_of(value: Option<Spread>) -> String {
    value.map_or("-".into(), |value| format!("{:.4}", value.mean))
}
