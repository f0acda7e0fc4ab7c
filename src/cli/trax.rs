//! `infopart trax`: the tracker as a TraX server on standard input and output.

use std::io::{self, BufWriter};

use anyhow::Result;
use clap::Args;
use infopart::{
    parallel::Threads,
    program::BadInput,
    tracker::{InfoPart, Tracker, colour::ColourTracker},
    trax::{About, TraxError, serve},
};

use super::{
    parameters::ParameterArgs,
    track::thread_pool,
    values::{TrackerName, parse_count},
};

pub const EXAMPLES: &str = "\
Examples:
  infopart trax                                  for a TraX client, such as the VOT toolkit; not for typing
  otb_eval run --data otb --tracker mine='infopart trax --region whole' --out results

A section of the VOT toolkit's trackers.ini:
  [InfoPart]
  label = InfoPart
  protocol = trax
  command = infopart trax

Images may be sent as paths, as bytes of JPEG or PNG files, or as pixels; regions as rectangles or as polygons, of which \
the upright box around them is tracked. Each answer has the box, confidence, status and the seconds that tracking took. \
One target at a time; another `initialize` starts anew. The seed is that of --seed, else of INFOPART_SEED.

Exit codes: 0 success, 2 a parameter, or a message that is not understood or asks for what cannot be tracked";

#[derive(Debug, Args)]
pub struct TraxArgs {
    /// What tracks
    #[arg(long, value_name = "infopart|colour", default_value = "infopart")]
    tracker: TrackerName,
    #[command(flatten)]
    parameters: ParameterArgs,
    /// How many threads weigh particles; the boxes do not depend on it
    #[arg(long, value_name = "N", value_parser = parse_count, default_value = "1")]
    threads: usize,
}

pub fn trax(args: &TraxArgs) -> Result<()> {
    let parameters = args.parameters.with_seed_of("INFOPART_SEED")?;
    let threads = match args.threads {
        1 => Threads::Calling,
        more => Threads::Pool(thread_pool(more)?),
    };
    let (name, mut tracker): (_, Box<dyn Tracker>) = match args.tracker {
        TrackerName::Infopart => {
            ("infopart", Box::new(InfoPart::with_threads(parameters.resolve()?, threads)))
        }
        TrackerName::Colour => {
            ("colour", Box::new(ColourTracker::with_threads(parameters.resolve_colour()?, threads)))
        }
    };
    let about = About { name: name.to_owned(), identifier: format!("infopart {}", infopart::VERSION) };
    let output = BufWriter::new(io::stdout().lock());
    match serve(io::stdin().lock(), output, tracker.as_mut(), &about) {
        // A client that goes away has seen enough.
        Err(TraxError::Io(error)) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome.map_err(|error| BadInput(error.to_string()).into()),
    }
}
