//! The command line: one file a subcommand, flags turned into checked options, errors told in one place.

use std::{path::Path, process::ExitCode};

use clap::{CommandFactory, Parser, Subcommand};
use infopart::program;

mod annotate;
mod auto_init;
mod background;
mod config;
mod demo;
mod demo_folder;
mod estimate;
mod first_box;
mod outputs;
mod parameters;
mod several;
mod track;
mod track_args;
mod trax;
mod values;

const EXAMPLES: &str = "\
Examples:
  infopart demo                                  see it work; needs no data
  infopart track Crossing --out boxes.txt        an OTB folder
  infopart track video.mp4 --init 120,80,40,110  a video, the first box given
  infopart track video.mp4 --init auto           a static camera: what moves first is tracked
  infopart annotate video.mp4 --keys keys.json --out boxes.csv   a box in every frame from a few that are drawn
  infopart config > my.toml                      parameters to edit

Exit codes:
  0    success
  1    internal failure
  2    bad input: a flag, a file or a box
  130  interrupted with Ctrl-C";

/// Tracks one person, or any other target, through a video.
#[derive(Debug, Parser)]
#[command(name = "infopart", version, max_term_width = 120, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Render a walking person and track it by the part and by the whole body; needs no data
    #[command(after_help = demo::EXAMPLES)]
    Demo(demo::DemoArgs),
    /// Track a target from its box in the first frame
    #[command(after_help = track::EXAMPLES)]
    Track(Box<track_args::TrackArgs>),
    /// Draw an object in a few frames of a video and get its box in every frame
    #[command(after_help = annotate::EXAMPLES)]
    Annotate(Box<annotate::AnnotateArgs>),
    /// Learn a static camera's background and show what moves: masks, blobs, a picture
    #[command(after_help = background::EXAMPLES)]
    Background(background::BackgroundArgs),
    /// Print every parameter with its default, meaning and unit, as a TOML that --config takes
    #[command(after_help = config::EXAMPLES)]
    Config(config::ConfigArgs),
    /// Serve the tracker to a TraX client, such as the VOT toolkit, on standard input and output
    #[command(after_help = trax::EXAMPLES)]
    Trax(Box<trax::TraxArgs>),
    /// Print what a shell needs to complete the program's words, or write man pages
    #[command(after_help = program::completions_examples("infopart"))]
    Completions(program::CompletionsArgs),
    /// Compare state estimators on a simulated oscillator; needs no data
    #[command(after_help = estimate::EXAMPLES)]
    Estimate(estimate::EstimateArgs),
}

/// Tells what clap says of a command line, and of a file whose name was taken for a flag.
fn refused(error: &clap::Error) -> ExitCode {
    // Nothing can be told where not even this can be written.
    let _ = error.print();
    if error.kind() == clap::error::ErrorKind::UnknownArgument {
        for word in std::env::args_os().skip(1).filter(|word| Path::new(word).is_file()) {
            let name = word.to_string_lossy();
            if name.starts_with('-') {
                eprintln!("  tip: `{name}` is a file here: give it as ./{name}");
            }
        }
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(program::BAD_INPUT))
}

/// Runs the program on its command line.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return refused(&error),
    };
    let outcome = match cli.command {
        Command::Track(args) => track::track(&args),
        Command::Annotate(args) => annotate::annotate(&args),
        Command::Demo(args) => demo::demo(&args),
        Command::Background(args) => background::background(&args),
        Command::Trax(args) => trax::trax(&args),
        Command::Completions(args) => program::completions(Cli::command(), &args).map_err(Into::into),
        Command::Config(args) => config::config(&args),
        Command::Estimate(args) => estimate::estimate(&args),
    };
    let is_interrupted =
        |error: &anyhow::Error| error.is::<several::Interrupted>() || error.is::<annotate::Interrupted>();
    program::report_with(outcome, |error| is_interrupted(error).then_some(program::INTERRUPTED))
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_consistent() {
        <super::Cli as clap::CommandFactory>::command().debug_assert();
    }
}
