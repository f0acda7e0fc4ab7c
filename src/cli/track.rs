//! `infopart track`: from an input and a box to rows, pictures and a summary.

use std::{path::PathBuf, sync::Arc};

use anyhow::{Context, Error, Result};
use clap::Args;
use infopart::{
    geometry::{Origin, Rect},
    output::{Summary, tracker_title},
    run::{RunError, RunFailure, RunReport, run},
    sequence::{self, OpenOptions, Sequence},
    tracker::{CheckedParameters, InfoPart, Tracker},
};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{
    exit::BadInput,
    interrupt,
    outputs::Outputs,
    parameters::ParameterArgs,
    values::{Format, parse_box, parse_count, parse_origin},
};

#[derive(Debug, Args)]
pub struct TrackArgs {
    /// An OTB folder (img/ and groundtruth_rect.txt), a folder or a quoted glob of images, or a video
    input: String,
    /// The target's box in the first frame; without it, the ground truth's
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_box, allow_hyphen_values = true)]
    init: Option<Rect>,
    /// Which target of an OTB folder that has several
    #[arg(long, value_name = "K", value_parser = parse_count)]
    target: Option<usize>,
    /// The number of the first pixel, in --init and in the rows [default: 1 for OTB folders, else 0]
    #[arg(long, value_name = "0|1", value_parser = parse_origin)]
    origin: Option<Origin>,
    /// The first frame to track, counted from 1
    #[arg(long, value_name = "N", value_parser = parse_count)]
    start: Option<usize>,
    /// The last frame to track, counted from 1
    #[arg(long, value_name = "M", value_parser = parse_count)]
    end: Option<usize>,
    /// Where the rows go, one a frame; they are in FILE.partial until they are all there [default: standard output]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// How rows are written [default: by the extension of --out, else otb]
    #[arg(long)]
    pub format: Option<Format>,
    #[command(flatten)]
    parameters: ParameterArgs,
    /// Draw boxes and particles on every frame: pictures in a folder, or a video (mp4, mkv, mov, avi; needs ffmpeg)
    #[arg(long, value_name = "DIR|FILE.mp4")]
    pub annotate: Option<PathBuf>,
    /// How many threads weigh particles [default: one a core]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    threads: Option<usize>,
    /// Add the milliseconds of each stage to the summary, and of each frame to csv and jsonl rows
    #[arg(long)]
    pub timing: bool,
    /// Make the summary (on standard error) one JSON object
    #[arg(long)]
    pub json: bool,
    /// No progress bar and no summary (--json still gives its object)
    #[arg(long)]
    pub quiet: bool,
}

pub fn track(args: &TrackArgs) -> Result<()> {
    let parameters = args.parameters.resolve()?;
    let pool = args.threads.map(thread_pool).transpose()?;
    let mut sequence = sequence::open(&args.input, &args.open_options())?;
    let first = first_box(args, &sequence)?;
    let mut outputs = Outputs::open(args, sequence.origin, first.as_given, sequence.source.remaining())?;
    let interrupted = interrupt::watch()?;
    let threads = pool.as_ref().map_or_else(rayon::current_num_threads, |pool| pool.current_num_threads());
    let mut tracker = start_tracker(parameters.clone(), pool);
    let report = run(
        sequence.source.as_mut(),
        &sequence.ground_truth,
        &mut tracker,
        first.in_frame,
        &mut outputs.observers(),
        interrupted,
    )
    .map_err(|error| name_bad_init(args, outputs.explain(error)))?;
    tell_summary(args, summary(args, sequence.name, tracker.name(), &parameters, threads, report))
}

impl TrackArgs {
    fn open_options(&self) -> OpenOptions {
        OpenOptions { target: self.target, start: self.start, end: self.end, origin: self.origin }
    }
}

/// The target's box in the first frame.
struct FirstBox {
    in_frame: Rect,
    /// With the input's origin.
    as_given: Rect,
}

fn first_box(args: &TrackArgs, sequence: &Sequence) -> Result<FirstBox> {
    let origin = sequence.origin;
    if let Some(as_given) = args.init {
        return Ok(FirstBox { in_frame: origin.to_frame(as_given), as_given });
    }
    match sequence.ground_truth.first() {
        Some(Some(in_frame)) => Ok(FirstBox { in_frame: *in_frame, as_given: as_in_file(origin, *in_frame) }),
        Some(None) => Err(BadInput(format!(
            "{}: the ground truth has no box in the first frame; give the target's box with --init X,Y,W,H, or begin \
             at a later frame with --start N",
            args.input
        ))
        .into()),
        None => Err(BadInput(format!(
            "{}: there is no ground truth to take the first box from; give the target's box in the first frame with \
             --init X,Y,W,H",
            args.input
        ))
        .into()),
    }
}

/// The box as the ground truth's file has it. Subtracting the origin and adding it again costs a last digit; the
/// nearest short decimal that means the same box gives it back.
fn as_in_file(origin: Origin, in_frame: Rect) -> Rect {
    let written = origin.from_frame(in_frame);
    let short = |value: f64| (value * 1e9).round() / 1e9;
    let rounded = Rect { x: short(written.x), y: short(written.y), ..written };
    if origin.to_frame(rounded) == in_frame { rounded } else { written }
}

/// Puts --init before the tracker's complaint about the first box, if that is where the box came from.
fn name_bad_init(args: &TrackArgs, error: Error) -> Error {
    let refused_at_once = error
        .downcast_ref::<RunError>()
        .is_some_and(|run| run.frames_done == 0 && matches!(*run.failure, RunFailure::Track { .. }));
    match args.init {
        Some(Rect { x, y, w, h }) if refused_at_once => error.context(format!("--init {x},{y},{w},{h}")),
        _ => error,
    }
}

fn thread_pool(threads: usize) -> Result<Arc<ThreadPool>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| BadInput(format!("--threads {threads}: {error}; give fewer threads")))?;
    Ok(Arc::new(pool))
}

fn start_tracker(parameters: CheckedParameters, pool: Option<Arc<ThreadPool>>) -> InfoPart {
    match pool {
        Some(pool) => InfoPart::with_pool(parameters, pool),
        None => InfoPart::new(parameters),
    }
}

fn summary(
    args: &TrackArgs,
    sequence: String,
    tracker: &str,
    parameters: &CheckedParameters,
    threads: usize,
    report: RunReport,
) -> Summary {
    Summary {
        sequence,
        tracker: tracker_title(tracker, parameters.region),
        region: parameters.region,
        preset: args.parameters.preset.clone(),
        seed: parameters.seed,
        threads,
        report,
    }
}

fn tell_summary(args: &TrackArgs, summary: Summary) -> Result<()> {
    if args.json {
        eprintln!("{}", summary.to_json(args.timing).context("the summary cannot be made JSON")?);
    } else if !args.quiet {
        eprintln!("{}", summary.to_text(args.timing));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_truth_with_fractions_comes_back_as_it_was_written() {
        for value in [0.1, 205.0, 0.7, 198.39, 1.0 / 3.0] {
            let in_frame = Origin::One.to_frame(Rect::new(value, value, 5.0, 6.0));
            let back = as_in_file(Origin::One, in_frame);
            assert!((back.x - value).abs() < 1e-12);
            if value != 1.0 / 3.0 {
                assert_eq!((back.x, back.y), (value, value));
            }
        }
    }
}
