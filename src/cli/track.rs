//! `infopart track`: from an input and a box to rows, pictures and a summary.

use std::{path::Path, sync::Arc};

use anyhow::{Context, Result};
use infopart::{
    geometry::{Rect, Region},
    program::{self, BadInput},
    run::{Pace, RunReport, Summary, run_at, tracker_title},
    sequence::{self, OpenOptions, Sequence, SequenceError, Wait},
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
    several::{SeveralReport, track_several},
    track_args::TrackArgs,
    values::{Init, TrackerName},
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
  infopart track /dev/video0 --init 9,9,80,200   a camera (Linux); the newest frame each time
  infopart track 0 --input-format avfoundation --init 9,9,80,200   a camera (macOS)
  infopart track rtsp://host/stream --live --init 9,9,80,200       a network camera
  cat walk.mkv | infopart track - --init 120,80,40,110             a video from standard input
  infopart track anno/UAV123/person12_2.txt      a part of a folder of UAV123

Rows: one a frame from the first tracked on, which holds the first box. A lost target has a row too: the best guess.

Summary: on standard error. With ground truth it has R1 (percentage of frames with a centre error of at most 20 \
pixels), R2 (of frames with an overlap above 0.5) and AUC (area under the success curve, from 0 to 0.952).

Pictures: the box is green while tracking, orange if uncertain, red if lost; thinner the tracked part, yellow dots \
the particles, dashed white the ground truth. An annotated video has one constant rate, that of the input's first \
five frames (25 a second for images): an input of variable rate is seen faster or slower than it was. The true time \
of each frame is in csv and jsonl rows.

Streams: a video that breaks off, or has less than its container promises, ends with exit code 2 and the last good frame; \
the rows up to there are kept. With --live frames that came while the tracker was busy have no row; csv and jsonl rows \
have the numbers of those that do. A file whose name begins with a dash is ./-name.

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
        if sequence::is_stream(&self.input, &options)? {
            let input = if self.input == "-" { "standard input".to_owned() } else { self.input.clone() };
            let purpose = "--init auto";
            return Err(SequenceError::ReadOnce { input, purpose }.into());
        }
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
        OpenOptions {
            target: self.target,
            start: self.start,
            end: self.end,
            origin: self.origin,
            live: self.live,
            input_format: self.input_format.clone(),
            wait: Wait {
                stop: Some(program::interrupted()),
                tell: if self.quiet { None } else { Some(tell_of_waiting) },
            },
        }
    }

    fn pace(&self) -> Pace {
        match (self.stride, self.realtime) {
            (Some(stride), _) => Pace::Stride(stride),
            (None, Some(frames_per_second)) => Pace::RealTime { frames_per_second },
            (None, None) => Pace::EveryFrame,
        }
    }
}

fn tell_of_waiting(stream: &Path) {
    eprintln!("note: {}: no frame for 5 seconds; waiting for the next (Ctrl-C ends it)", stream.display());
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
