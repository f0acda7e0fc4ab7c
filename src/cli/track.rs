//! `infopart track`: from an input and a box to rows, pictures and a summary.

use std::{num::NonZeroUsize, path::PathBuf, sync::Arc};

use anyhow::{Context, Result};
use clap::Args;
use infopart::{
    geometry::{Origin, Rect, Region},
    program::{self, BadInput},
    run::{Pace, RunReport, Summary, run_at, tracker_title},
    sequence::{self, OpenOptions, Sequence},
    tracker::{
        CheckedParameters, InfoPart, Tracker,
        colour::{CheckedColourParameters, ColourTracker},
    },
};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{
    auto_init,
    first_box::FirstBox,
    outputs::Outputs,
    parameters::ParameterArgs,
    several::{SeveralReport, track_several},
    values::{
        Format, Init, TrackerName, parse_count, parse_init, parse_origin, parse_positive, parse_stride,
    },
};

pub const EXAMPLES: &str = "\
Examples:
  infopart track Crossing --out boxes.txt        first box from the ground truth
  infopart track Jogging --target 2              one of its several targets
  infopart track video.mp4 --init 120,80,40,110  a video, the first box given
  infopart track video.mp4 --init auto --target 2  a static camera: the second object that moves
  infopart track 'shots/*.png' --init 5,9,32,80 --out a.csv --annotate seen.mp4
  infopart track Crossing --region whole --json --quiet > /dev/null
  infopart track ships.avi --tracker colour --init 9,40,60,25 --init 200,52,48,20 --out ships.txt
  infopart track Crossing --stride 3             every third frame; the others are predicted
  infopart track Crossing --realtime 30          as with a camera of 30 frames per second

Rows: one a frame from the first tracked on, which holds the first box. A lost target has a row too: the best guess.

Summary: on standard error. With ground truth it has R1 (percentage of frames with a centre error of at most 20 \
pixels), R2 (of frames with an overlap above 0.5) and AUC (area under the success curve, from 0 to 0.952).

Pictures: the box is green while tracking, orange if uncertain, red if lost; thinner the tracked part, yellow dots \
the particles, dashed white the ground truth. An annotated video has one constant rate, that of the input's first \
five frames (25 a second for images): an input of variable rate is seen faster or slower than it was. The true time \
of each frame is in csv and jsonl rows.

Skipped frames: with --stride and --realtime the frames that the tracker does not get have rows too. Their box goes on \
at the velocity of the last two tracked ones known at that time, their status and confidence are those of the last, \
and their effective sample size is 0. They count in R1, R2 and AUC.

Parameters: --config over --preset, and --region, --particles and --seed over both.

Trackers: infopart, or colour, a particle filter on colour histograms. colour takes --init several times: the targets \
are followed together, each with the occlusions by the others in mind, and the rows of target K go to FILE.K.txt for \
--out FILE.txt. Its parameters are those of `infopart config --tracker colour`.

Exit codes:
  0    success
  1    internal failure
  2    bad input: a flag, a file or a box
  130  interrupted with Ctrl-C";

#[derive(Debug, Args)]
pub struct TrackArgs {
    /// An OTB folder (img/ and groundtruth_rect.txt), a folder or a quoted glob of images (jpg, png, bmp),
    /// or a video (needs ffmpeg)
    pub input: String,
    /// What tracks
    #[arg(long, value_name = "infopart|colour", default_value = "infopart")]
    tracker: TrackerName,
    /// The target's box in the first frame: left, top, width, height in pixels; with --tracker colour it may be
    /// given several times, once a target; or auto, before a static camera: the first object that moves for 15 frames,
    /// from then on [default: the ground truth's]
    #[arg(long, value_name = "X,Y,W,H|auto", value_parser = parse_init, allow_hyphen_values = true)]
    init: Vec<Init>,
    /// Which target of an OTB folder that has several: the K of groundtruth_rect.K.txt; with --init auto the K-th object
    #[arg(long, value_name = "K", value_parser = parse_count)]
    target: Option<usize>,
    /// The number of the first pixel, in --init, the ground truth and the rows [default: 1 for OTB folders, else 0]
    #[arg(long, value_name = "0|1", value_parser = parse_origin)]
    origin: Option<Origin>,
    /// The first frame to track, counted from 1; the first box is that of this frame [default: 1]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    start: Option<usize>,
    /// The last frame to track, counted from 1 [default: the last there is]
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
    /// Draw boxes and particles on every frame: pictures DIR/000001.jpg and so on, or a video (mp4, mkv, mov, avi;
    /// needs ffmpeg)
    #[arg(long, value_name = "DIR|FILE.mp4")]
    pub annotate: Option<PathBuf>,
    /// Track only every K-th frame from the first on, and predict the boxes between
    #[arg(long, value_name = "K", value_parser = parse_stride, conflicts_with = "realtime")]
    stride: Option<NonZeroUsize>,
    /// Let frames arrive at this rate, as from a camera with a buffer of one frame: those that arrive while tracking is
    /// busy are skipped, and their boxes predicted. It depends on measured times, so the boxes differ from run to run
    #[arg(long, value_name = "FPS", value_parser = parse_positive)]
    realtime: Option<f64>,
    /// How many threads weigh particles; the boxes do not depend on it [default: one a core]
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

/// The tracker that the flags choose, with its parameters.
enum Chosen {
    InfoPart(Box<CheckedParameters>),
    Colour(CheckedColourParameters),
}

pub fn track(args: &TrackArgs) -> Result<()> {
    let chosen = args.chosen()?;
    let pool = args.threads.map(thread_pool).transpose()?;
    let (mut sequence, boxes) = args.open()?;
    let init = match (boxes.as_slice(), &chosen) {
        ([_, _, ..], Chosen::Colour(parameters)) => {
            let report = track_several(args, &boxes, sequence, parameters.clone(), pool)?;
            tell_several(args, &report);
            return Ok(());
        }
        ([_, _, ..], Chosen::InfoPart(_)) => {
            let message =
                "--init is given several times; InfoPart follows one target: give one, or --tracker colour";
            return Err(BadInput(message.to_owned()).into());
        }
        (given, _) => given.first().copied(),
    };
    let first = FirstBox::find(init, &args.input, &sequence)?;
    let mut outputs = Outputs::open(args, sequence.origin, first.as_given, sequence.source.remaining())?;
    let interrupted = program::watch().context("Ctrl-C cannot be watched for")?;
    let threads = pool.as_ref().map_or_else(rayon::current_num_threads, |pool| pool.current_num_threads());
    let mut tracker = chosen.start(pool);
    let report = run_at(
        args.pace(),
        sequence.source.as_mut(),
        &sequence.ground_truth,
        tracker.as_mut(),
        first.in_frame,
        &mut outputs.observers(),
        interrupted,
    )
    .map_err(|error| match first.refusal(&error) {
        Some(refusal) => refusal.into(),
        None => outputs.explain(error),
    })?;
    tell_summary(args, summary(args, sequence.name, &chosen, threads, report))
}

impl Chosen {
    fn start(&self, pool: Option<Arc<ThreadPool>>) -> Box<dyn Tracker> {
        match (self, pool) {
            (Self::InfoPart(parameters), Some(pool)) => {
                Box::new(InfoPart::with_pool((**parameters).clone(), pool))
            }
            (Self::InfoPart(parameters), None) => Box::new(InfoPart::new((**parameters).clone())),
            (Self::Colour(parameters), Some(pool)) => {
                Box::new(ColourTracker::with_pool(parameters.clone(), pool))
            }
            (Self::Colour(parameters), None) => Box::new(ColourTracker::new(parameters.clone())),
        }
    }
}

impl TrackArgs {
    fn chosen(&self) -> Result<Chosen> {
        Ok(match self.tracker {
            TrackerName::Infopart => Chosen::InfoPart(Box::new(self.parameters.resolve()?)),
            TrackerName::Colour => Chosen::Colour(self.parameters.resolve_colour()?),
        })
    }

    /// The frames from the first to track on, and the boxes of --init as the input counts.
    fn open(&self) -> Result<(Sequence, Vec<Rect>)> {
        match self.init.as_slice() {
            [Init::Auto] => self.open_auto(),
            given => {
                let boxes = given.iter().map(|init| match init {
                    Init::Box(given) => Ok(*given),
                    Init::Auto => {
                        Err(BadInput("--init auto: give it alone, without other --init".to_owned()))
                    }
                });
                let boxes = boxes.collect::<Result<_, _>>()?;
                Ok((sequence::open(&self.input, &self.open_options())?, boxes))
            }
        }
    }

    fn open_auto(&self) -> Result<(Sequence, Vec<Rect>)> {
        let options = OpenOptions { target: None, ..self.open_options() };
        let number = self.target.unwrap_or(1);
        let found = auto_init::find(&self.input, &options, number)?;
        let options = OpenOptions { start: Some(found.frame), ..options };
        let sequence = sequence::open(&self.input, &options)?;
        let as_given = sequence.origin.from_frame(found.box_in_frame);
        if !self.quiet {
            let Rect { x, y, w, h } = as_given;
            let (first_seen, frame) = (found.first_seen, found.frame);
            eprintln!(
                "object {number}, seen from frame {first_seen} on, is the target from frame {frame} on: {x},{y},{w},{h}"
            );
        }
        Ok((sequence, vec![as_given]))
    }

    fn open_options(&self) -> OpenOptions {
        OpenOptions { target: self.target, start: self.start, end: self.end, origin: self.origin }
    }

    fn pace(&self) -> Pace {
        match (self.stride, self.realtime) {
            (Some(stride), _) => Pace::Stride(stride),
            (None, Some(frames_per_second)) => Pace::RealTime { frames_per_second },
            (None, None) => Pace::EveryFrame,
        }
    }
}

pub fn thread_pool(threads: usize) -> Result<Arc<ThreadPool>> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|error| BadInput(format!("--threads {threads}: {error}; give fewer threads")))?;
    Ok(Arc::new(pool))
}

fn summary(
    args: &TrackArgs,
    sequence: String,
    chosen: &Chosen,
    threads: usize,
    report: RunReport,
) -> Summary {
    let (tracker, region, seed) = match chosen {
        Chosen::InfoPart(parameters) => {
            (tracker_title("infopart", parameters.region), parameters.region, parameters.seed)
        }
        Chosen::Colour(parameters) => ("colour".to_owned(), Region::Whole, parameters.seed),
    };
    Summary { sequence, tracker, region, preset: args.parameters.preset.clone(), seed, threads, report }
}

fn tell_several(args: &TrackArgs, report: &SeveralReport) {
    if !args.quiet && !args.json {
        let files: Vec<_> = report.files.iter().map(|file| file.display().to_string()).collect();
        eprintln!("{} frames, {} targets: {}", report.frames, files.len(), files.join(", "));
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
