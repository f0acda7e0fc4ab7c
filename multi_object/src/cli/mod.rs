//! The command line: one file a subcommand, errors told in one place.

use std::{path::Path, process::ExitCode};

use anyhow::{Error, Result};
use clap::{CommandFactory, Parser, Subcommand};
use infopart::{
    output::{Destination, PartialFile, StandardOutput},
    program::{self, BAD_INPUT, INTERRUPTED},
};
use multi_object::motchallenge::MotError;

mod compare;
mod filter;
mod foreground;
mod score;
mod sort;
mod track;

const EXAMPLES: &str = "\
Examples:
  mot track view1.avi --out tracks.txt --annotate seen.mp4
  mot sort det.txt --out result.txt
  mot score gt.txt result.txt
Exit codes:
  0    success
  1    internal failure
  2    bad input: a flag, a file or a row
  130  interrupted with Ctrl-C";

/// Tracks many objects, and scores tracks as the usual toolkits do.
#[derive(Debug, Parser)]
#[command(name = "mot", version, max_term_width = 120, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compare how well the filters predict, beside the paper's table
    #[command(after_help = compare::EXAMPLES)]
    Compare(compare::CompareArgs),
    /// Score tracks against the ground truth: CLEAR-MOT, identity scores, HOTA
    #[command(after_help = score::EXAMPLES)]
    Score(score::ScoreArgs),
    /// Track what moves before a static camera: background model, blobs, a Bayesian filter for each object
    #[command(after_help = track::EXAMPLES)]
    Track(track::TrackArgs),
    /// Track given detections (SORT)
    #[command(after_help = sort::EXAMPLES)]
    Sort(sort::SortArgs),
    /// Print what a shell needs to complete the program's words, or write man pages
    #[command(after_help = program::completions_examples("mot"))]
    Completions(program::CompletionsArgs),
}

/// Runs the program on its command line.
pub fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Score(args) => score::score(&args),
        Command::Track(args) => track::track(&args),
        Command::Compare(args) => compare::compare(&args),
        Command::Sort(args) => sort::sort(&args),
        Command::Completions(args) => program::completions(Cli::command(), &args).map_err(Into::into),
    };
    program::report_with(outcome, code_of)
}

/// Ctrl-C, after the frame at hand.
#[derive(Debug, thiserror::Error)]
#[error("interrupted after {frames} frames; what was done is in FILE.partial")]
struct Interrupted {
    frames: u32,
}

fn code_of(error: &Error) -> Option<u8> {
    if error.is::<Interrupted>() {
        return Some(INTERRUPTED);
    }
    error.is::<MotError>().then_some(BAD_INPUT)
}

/// Writes a file whole, or prints where there is none.
fn deliver(path: Option<&Path>, text: &str) -> Result<()> {
    let mut destination: Box<dyn Destination> = match path {
        Some(path) => Box::new(PartialFile::create(path)?),
        None => Box::new(StandardOutput::new()),
    };
    destination.write_all(text.as_bytes()).map_err(|error| destination.name_error(error))?;
    Ok(destination.complete()?)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_consistent() {
        <super::Cli as clap::CommandFactory>::command().debug_assert();
    }
}
