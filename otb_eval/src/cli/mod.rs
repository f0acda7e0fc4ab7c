//! The command line: one file a subcommand, errors told in one place.

use std::process::ExitCode;

use anyhow::Error;
use clap::{CommandFactory, Parser, Subcommand};
use infopart::program::{self, BAD_INPUT, INTERRUPTED};
use otb_eval::{
    catalogue::CatalogueError,
    convert::ConvertError,
    dataset::DatasetError,
    external::ListError,
    protocol::{HiddenError, ProtocolError},
    results::ResultsError,
    runner::FactoryError,
    store::StoreError,
};

mod check;
mod compare;
mod convert;
mod differences;
mod inputs;
mod jobs;
mod plan;
mod plot;
mod report;
mod run;
mod score;
mod scored;
mod submit;
mod supervise;

const EXAMPLES: &str = "\
Examples, in the order of an evaluation (otb and people are folders of OTB sequences):
  otb_eval check otb people
  otb_eval run --data otb people --sequences people8 --trackers infopart,whole-body --seeds 5 --out results
  otb_eval score --data otb people --results results
  otb_eval compare infopart whole-body --data otb people --results results
  otb_eval plot --data otb people --results results --out plots
  otb_eval report --data otb people --results results --out report.html

Other data sets are recognised by what is in their folders, and scored by their own rules:
  otb_eval score --data LaSOT --results results

Results of other trackers, RESULTS/TRACKER/SEQ.txt, against the boxes of OTB100.json, as six toolkits would score them:
  otb_eval score --data OTB100.json --results published --toolkit all

`otb_eval COMMAND --help` has more examples.

Exit codes:
  0    success
  1    internal failure
  2    bad input: a flag, a file, a sequence or a result; what could be done is done
  130  interrupted with Ctrl-C";

/// Runs trackers over TB-100 and other data sets, scores them as every toolkit would, plots, compares and reports.
#[derive(Debug, Parser)]
#[command(name = "otb_eval", version, max_term_width = 120, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// The command that stands between an evaluation and a tracker in another process.
const SUPERVISE: &str = "supervise";

#[derive(Debug, Subcommand)]
enum Command {
    /// Tell what data holds: frames, rows, odd and damaged files, labels that the boxes contradict
    #[command(after_help = check::EXAMPLES)]
    Check(check::CheckArgs),
    /// Run trackers over sequences; a second run continues where the first was stopped
    #[command(after_help = run::EXAMPLES)]
    Run(run::RunArgs),
    /// Print the jobs of a run as JSON lines, without running them
    #[command(after_help = plan::EXAMPLES)]
    Plan(plan::PlanArgs),
    /// Score results under one toolkit's rules, or under all six and say why they differ
    #[command(after_help = score::EXAMPLES)]
    Score(Box<score::ScoreArgs>),
    /// Compare two trackers on the same sequences and seeds
    #[command(after_help = compare::EXAMPLES)]
    Compare(Box<compare::CompareArgs>),
    /// Turn results from one toolkit's layout into another's
    #[command(after_help = convert::EXAMPLES)]
    Convert(convert::ConvertArgs),
    /// Print what a shell needs to complete the program's words, or write man pages
    #[command(after_help = program::completions_examples("otb_eval"))]
    Completions(program::CompletionsArgs),
    /// Run a tracker's command so that it ends when the evaluation does; `run` uses it
    #[command(name = SUPERVISE, hide = true)]
    Supervise(supervise::SuperviseArgs),
    /// Make the archive that the server of GOT-10k or TrackingNet takes
    #[command(after_help = submit::EXAMPLES)]
    Submit(submit::SubmitArgs),
    /// Draw success and precision plots
    #[command(after_help = plot::EXAMPLES)]
    Plot(Box<plot::PlotArgs>),
    /// Put everything on one HTML page
    #[command(after_help = report::EXAMPLES)]
    Report(Box<report::ReportArgs>),
}

/// Runs the program on its command line.
pub fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Check(args) => check::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Plan(args) => plan::plan(&args),
        Command::Score(args) => score::score(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Completions(args) => program::completions(Cli::command(), &args).map_err(Into::into),
        Command::Supervise(args) => return supervise::supervise(&args),
        Command::Submit(args) => submit::submit(&args),
        Command::Plot(args) => plot::plot(&args),
        Command::Report(args) => report::report(&args),
    };
    program::report_with(outcome, code_of)
}

/// Every error of the library's is about input that the user can put right.
fn code_of(error: &Error) -> Option<u8> {
    if error.is::<run::Interrupted>() {
        return Some(INTERRUPTED);
    }
    let is_input = error.is::<CatalogueError>()
        || error.is::<DatasetError>()
        || error.is::<ProtocolError>()
        || error.is::<HiddenError>()
        || error.is::<FactoryError>()
        || error.is::<ListError>()
        || error.is::<StoreError>()
        || error.is::<ResultsError>()
        || error.is::<ConvertError>();
    is_input.then_some(BAD_INPUT)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_consistent() {
        <super::Cli as clap::CommandFactory>::command().debug_assert();
    }
}
