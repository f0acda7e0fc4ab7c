//! `otb_eval report`: everything on one HTML page.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use otb_eval::{
    figures::{PageOptions, page, strips},
    protocol::Protocol,
    toolkits::Toolkit,
};

use super::{score::write, scored::ScoredArgs};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval report --data otb people --results results --out report.html
  otb_eval report --data OTB100.json --results published --no-frames --out report.html

One page that needs nothing else: ranked plots with values under the pointer, tables that sort, bars by attribute, frames \
with every tracker's box (of its first seed), failures, parameters and commands.";

#[derive(Debug, Args)]
pub struct ReportArgs {
    #[command(flatten)]
    scored: ScoredArgs,
    /// The page
    #[arg(long, value_name = "FILE.html")]
    out: PathBuf,
    /// Whose rules
    #[arg(long, value_name = "NAME", default_value = "plain")]
    toolkit: Toolkit,
    /// Which results: ope, tre or sre [default: all there are]
    #[arg(long, value_name = "ope|tre|sre")]
    protocol: Option<Protocol>,
    /// Show no frames: a small page without anybody's pictures
    #[arg(long)]
    no_frames: bool,
    /// The page's title
    #[arg(long, value_name = "TEXT", default_value = "Tracker evaluation")]
    title: String,
    /// A command that made the results, to be shown before that of the page; may be repeated
    #[arg(long, value_name = "TEXT")]
    command: Vec<String>,
}

pub fn report(args: &ReportArgs) -> Result<()> {
    let (dataset, mut problems) = args.scored.data.open()?;
    let tables = args.scored.tables(&dataset, args.protocol, args.toolkit, &mut problems)?;
    let mut shown = Vec::new();
    if !args.no_frames
        && let Some((results, table)) = tables.first()
    {
        let (strips, unreadable) = strips(&dataset, results, table);
        unreadable.iter().for_each(|problem| problems.tell(problem));
        shown = strips;
    }
    let options = PageOptions {
        title: args.title.clone(),
        commands: args.command.iter().cloned().chain([this_command()]).collect(),
        problems: problems.told().to_vec(),
        strips: shown,
    };
    let html = page(&tables, options).html().context("the report cannot be made")?;
    write(&args.out, html.as_bytes())?;
    eprintln!("{}: {} kB", args.out.display(), html.len() / 1000);
    problems.into_strict_result(args.scored.strict)
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
