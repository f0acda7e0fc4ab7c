//! `otb_eval report`: everything on one HTML page.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use infopart::program::BadInput;
use otb_eval::{
    figures::{PageOptions, page, strips, timelines},
    protocol::Protocol,
    results::Results,
    scoring::Table,
    toolkits::Toolkit,
};

use super::{score::write, scored::ScoredArgs};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval report --data otb people --results results --out report.html
  otb_eval report --data OTB100.json --results published --no-frames --out report.html

One page that needs nothing else: ranked plots with values under the pointer, tables with 95 % intervals that sort, filter and \
download, a map of scores by attribute, every sequence over time with the frames in which trackers fail (boxes of each \
one's first seed), failed jobs, what scoring met, rules, parameters and commands.";

#[derive(Debug, Args)]
pub struct ReportArgs {
    #[command(flatten)]
    scored: ScoredArgs,
    /// The page
    #[arg(long, value_name = "FILE.html")]
    out: PathBuf,
    /// Whose rules, as `otb_eval score` has them [default: the data set's own; for OTB plain]
    #[arg(long, value_name = "NAME")]
    toolkit: Option<Toolkit>,
    /// Which results: ope, tre or sre [default: all there are]
    #[arg(long, value_name = "ope|tre|sre")]
    protocol: Option<Protocol>,
    /// Show no frames: a small page without anybody's pictures
    #[arg(long, conflicts_with = "frames")]
    no_frames: bool,
    /// Frames of each sequence that are shown, those first in which trackers begin to fail
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u16).range(1..=500))]
    frames: u16,
    /// Test every tracker against this one: mean difference, its 95 % interval and probability
    #[arg(long, value_name = "TRACKER")]
    against: Option<String>,
    /// The page's title
    #[arg(long, value_name = "TEXT", default_value = "Tracker evaluation")]
    title: String,
    /// A command that made the results, to be shown before that of the page; may be repeated
    #[arg(long, value_name = "TEXT")]
    command: Vec<String>,
}

pub fn report(args: &ReportArgs) -> Result<()> {
    let (dataset, mut problems) = args.scored.data.open()?;
    let toolkit = args.toolkit.unwrap_or_else(|| Toolkit::of(dataset.benchmark()));
    let tables = args.scored.tables(&dataset, args.protocol, toolkit, &mut problems)?;
    let long_term = match tables.iter().find(|(_, table)| table.protocol == Protocol::Ope) {
        Some((results, _)) => args.scored.long_term(&dataset, results, toolkit, true)?.unwrap_or_default(),
        None => Vec::new(),
    };
    let against = args.place_of_against(&tables)?;
    let (mut shown, mut over_time) = (Vec::new(), Vec::new());
    if let Some((results, table)) = tables.iter().find(|(_, table)| table.protocol == Protocol::Ope) {
        over_time = timelines(&dataset, results, table);
    }
    if !args.no_frames
        && let Some((results, table)) = tables.first()
    {
        let (strips, unreadable) = strips(&dataset, results, table, usize::from(args.frames));
        unreadable.iter().for_each(|problem| problems.tell(problem));
        shown = strips;
    }
    let options = PageOptions {
        title: args.title.clone(),
        commands: args.command.iter().cloned().chain([this_command()]).collect(),
        problems: problems.told().to_vec(),
        strips: shown,
        timelines: over_time,
        against,
        long_term,
    };
    let html = page(&tables, options).html().context("the report cannot be made")?;
    write(&args.out, html.as_bytes())?;
    eprintln!("{}: {} kB", args.out.display(), html.len() / 1000);
    problems.into_strict_result(args.scored.strict)
}

impl ReportArgs {
    /// The place of the tracker that all are tested against.
    fn place_of_against(&self, tables: &[(Results, Table)]) -> Result<Option<usize>> {
        let Some(name) = &self.against else { return Ok(None) };
        let trackers = tables.first().map(|(_, table)| table.trackers.as_slice()).unwrap_or_default();
        let place = trackers.iter().position(|one| one.tracker == *name);
        place.map(Some).ok_or_else(|| {
            let there: Vec<&str> = trackers.iter().map(|one| one.tracker.as_str()).collect();
            let there = there.join(", ");
            BadInput(format!("--against: there are no results of the tracker `{name}`, but of: {there}"))
                .into()
        })
    }
}

/// The command line as a shell takes it, without the flags that only say what the page says of other commands.
fn this_command() -> String {
    let mut words = std::env::args().skip(1).peekable();
    let mut command = "otb_eval".to_owned();
    while let Some(word) = words.next() {
        if word == "--command" {
            words.next();
        } else if !word.starts_with("--command=") {
            command += &format!(" {}", quoted(&word));
        }
    }
    command
}

fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "/._-:,=+".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
