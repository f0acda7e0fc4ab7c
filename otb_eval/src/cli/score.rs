//! `otb_eval score`: tables under one toolkit's rules, or under all six.

use std::{
    io::Write as _,
    path::{Path, PathBuf},
};

use anyhow::Result;
use clap::{Args, ValueEnum, builder::TypedValueParser as _};
use infopart::{
    output::{Destination, OutputError, StandardOutput},
    program::BadInput,
};
use otb_eval::{
    protocol::Protocol,
    scoring::{LongTermScores, Measure, ScoreProblem, Table},
    store::write_whole,
    tables::{self, Digits, OverallOptions, ScoreTable, TableFormat},
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

For a paper: LaTeX with every tracker tested against one, percentages; a spreadsheet of every sequence:
  otb_eval score --data OTB100.json --results published --toolkit pysot --format latex --percent --against ATOM
  otb_eval score --data OTB100.json --results published --format csv --table sequence > auc.csv

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
    /// Whose rules: plain (no toolkit's special rules), matlab, jwlim, pysot, stvir, got10k, pytracking, or all six; or a data
    /// set's: lasot, uav123, got10k-ao [default: the data set's own; for OTB plain]
    #[arg(long, value_name = "NAME|all", value_parser = parse_toolkits)]
    toolkit: Option<Toolkits>,
    /// Which results: ope, tre or sre
    #[arg(long, value_name = "ope|tre|sre", default_value = "ope")]
    protocol: Protocol,
    /// What the tables by sequence and by attribute show: auc, precision, success, success-75, normalised,
    /// normalised-area or overlap
    #[arg(long, value_name = "NAME", default_value = "auc")]
    measure: Measure,
    /// The measures of the table over all sequences [default: those that the rules have]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    measures: Option<Vec<Measure>>,
    /// How tables are written: text, csv (every digit), markdown or latex (booktabs)
    #[arg(long, value_name = "text|csv|markdown|latex", default_value = "text")]
    format: TableFormat,
    /// Which tables [default: all as text, else overall]
    #[arg(long, value_enum, value_delimiter = ',')]
    table: Option<Vec<TableKind>>,
    /// Digits after the point [default: 4 as text, else 3; with --percent 2 and 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=15).map(usize::from))]
    digits: Option<usize>,
    /// Show scores as percentages
    #[arg(long)]
    percent: bool,
    /// Show the 95 % interval over sequences beside every score of the table over all sequences; csv always has it
    #[arg(long)]
    intervals: bool,
    /// Test every tracker against this one, in --measure: the mean difference, its 95 % interval and the probability by
    /// Wilcoxon's signed-rank test over sequences, also corrected by Holm's rule for the number of trackers
    #[arg(long, value_name = "TRACKER")]
    against: Option<String>,
    /// Write everything, curves too, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// State thresholds, inequalities and rules in force, and score nothing
    #[arg(long)]
    explain: bool,
}

/// A table that can be asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TableKind {
    /// Trackers over all sequences
    Overall,
    /// Trackers over all sequences in --measure alone, with intervals, and the test of --against
    Certainty,
    /// --measure by attribute
    Attribute,
    /// --measure by sequence
    Sequence,
    /// F, precision and recall where targets are absent for a while, with --long-term
    LongTerm,
}

impl TableKind {
    /// Those of scores over all frames.
    const OF_EVERY_FRAME: [Self; 4] = [Self::Overall, Self::Certainty, Self::Attribute, Self::Sequence];
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
    let toolkits_of = |chosen| match chosen {
        Toolkits::One(toolkit) => vec![toolkit],
        Toolkits::Six => Toolkit::SIX.to_vec(),
    };
    if args.explain {
        let toolkits = toolkits_of(args.toolkit.unwrap_or(Toolkits::One(Toolkit::Plain)));
        let texts: Vec<String> =
            toolkits.iter().map(|toolkit| args.scored.rules(*toolkit).explain()).collect();
        return print(&texts.join("\n"));
    }
    let results = args.scored.open_results(args.protocol)?;
    let (dataset, mut problems) = args.scored.data.open()?;
    let chosen = args.toolkit.unwrap_or_else(|| Toolkits::One(Toolkit::of(dataset.benchmark())));
    let mut scored = Vec::new();
    for toolkit in toolkits_of(chosen) {
        scored.push(args.scored.score(&dataset, &results, toolkit, args.protocol)?);
    }
    if chosen == Toolkits::Six && (args.format != TableFormat::Text || args.against.is_some()) {
        return Err(BadInput(
            "--toolkit all: --format and --against are of one toolkit's table; choose one".into(),
        )
        .into());
    }
    let mut long_term = None;
    match chosen {
        Toolkits::One(toolkit) => {
            let (table, unscored) = &scored[0];
            tell(unscored, &mut problems);
            long_term = args.scored.long_term(&dataset, &results, toolkit, false)?;
            print(&args.written(table, long_term.as_deref())?)?;
        }
        Toolkits::Six => {
            tell_once(&scored, &mut problems);
            print(&differences::text(&dataset, &results, &scored))?;
        }
    }
    if let Some(path) = &args.json {
        write_json(path, &scored, long_term.as_deref())?;
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

fn write_json(
    path: &Path,
    scored: &[(Table, Vec<ScoreProblem>)],
    long_term: Option<&[LongTermScores]>,
) -> Result<()> {
    let tables: Vec<serde_json::Value> = scored
        .iter()
        .map(|(table, problems)| {
            let problems: Vec<String> = problems.iter().map(ToString::to_string).collect();
            Ok(serde_json::json!({ "table": serde_json::to_value(table)?, "problems": problems }))
        })
        .collect::<Result<_, serde_json::Error>>()?;
    let program = format!("otb_eval {}", infopart::VERSION);
    let mut all = serde_json::json!({ "program": program, "tables": tables });
    if let Some(scores) = long_term {
        all["long_term"] = serde_json::to_value(scores)?;
    }
    let text = serde_json::to_string_pretty(&all)?;
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

impl ScoreArgs {
    /// The tables asked for, in the format asked for.
    fn written(&self, table: &Table, long_term: Option<&[LongTermScores]>) -> Result<String> {
        let is_text = self.format == TableFormat::Text;
        let wanted = self.table.clone().unwrap_or_else(|| match (is_text, long_term) {
            (true, Some(_)) => TableKind::value_variants().to_vec(),
            (true, None) => TableKind::OF_EVERY_FRAME.to_vec(),
            (false, Some(_)) => vec![TableKind::LongTerm],
            (false, None) => vec![TableKind::Overall],
        });
        if self.format == TableFormat::Csv && wanted.len() > 1 {
            return Err(BadInput(
                "--format csv: give one table with --table, since each has its own columns".into(),
            )
            .into());
        }
        let digits = self.digits();
        let mut parts = Vec::new();
        for (place, kind) in wanted.iter().enumerate() {
            for one in self.tables_of(*kind, table, long_term)? {
                let heading = match (is_text, place) {
                    (true, 0) => format!(
                        "{} under the rules of {} ({}), {} sequences; `--explain` states them\n\n",
                        table.protocol.title(),
                        table.toolkit,
                        table.toolkit.title(),
                        table.sequences.len()
                    ),
                    (true, _) => format!("{}\n", one.title),
                    _ => String::new(),
                };
                parts.push(heading + &one.written(self.format, digits));
            }
        }
        if is_text {
            parts.push("* best, + second; an interval holds the mean over sequences with 95 %\n".to_owned());
        }
        Ok(parts.join("\n"))
    }

    fn digits(&self) -> Digits {
        let decimals = match (self.digits, self.format, self.percent) {
            (Some(digits), ..) => digits,
            (None, TableFormat::Text, false) => 4,
            (None, TableFormat::Text, true) => 2,
            (None, _, false) => 3,
            (None, _, true) => 1,
        };
        Digits { decimals, percent: self.percent }
    }

    fn tables_of(
        &self,
        kind: TableKind,
        table: &Table,
        long_term: Option<&[LongTermScores]>,
    ) -> Result<Vec<ScoreTable>> {
        Ok(match kind {
            TableKind::Overall => vec![tables::overall(table, &self.overall_options(table)?)],
            TableKind::Certainty => {
                let options = OverallOptions {
                    measures: vec![self.measure],
                    intervals: true,
                    ..self.overall_options(table)?
                };
                let mut one = tables::overall(table, &options);
                one.title = format!("{}, its 95 % interval over sequences", self.measure.title());
                vec![one]
            }
            TableKind::Attribute => tables::by_attribute(table, self.measure).into_iter().collect(),
            TableKind::Sequence => vec![tables::by_sequence(table, self.measure)],
            TableKind::LongTerm => {
                let how = "--table long-term: add --long-term";
                let scores = long_term.ok_or_else(|| BadInput(how.into()))?;
                let all = [tables::long_term(scores), tables::long_term_by_sequence(scores)];
                // A file of comma-separated values holds one table.
                let count = if self.format == TableFormat::Csv { 1 } else { 2 };
                all.into_iter().take(count).collect()
            }
        })
    }

    fn overall_options(&self, table: &Table) -> Result<OverallOptions> {
        let measures = self.measures.clone().unwrap_or_else(|| Measure::quoted(table.toolkit).to_vec());
        let against = match &self.against {
            None => None,
            Some(name) => {
                let place = table.trackers.iter().position(|one| one.tracker == *name).ok_or_else(|| {
                    let there: Vec<&str> = table.trackers.iter().map(|one| one.tracker.as_str()).collect();
                    BadInput(format!(
                        "--against: there are no results of the tracker `{name}`, but of: {}",
                        there.join(", ")
                    ))
                })?;
                Some((place, self.measure))
            }
        };
        Ok(OverallOptions { measures, intervals: self.intervals || self.format == TableFormat::Csv, against })
    }
}
