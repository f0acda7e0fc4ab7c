//! `mot sort`: tracks from detections.

use std::{
    path::PathBuf,
    time::{Duration, Instant},
};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use infopart::{
    geometry::{Origin, Rect},
    program::BadInput,
    sequence::{FrameSource, OpenOptions, open},
};
use multi_object::{
    appearance::Appearance,
    motchallenge::{Detection, TrackRow, read_detections, row_text, row_text_of_class},
    sort::{BoxNoise, ByteParameters, ByteTracker, ScoredBox, Sort, SortParameters},
};

use super::{deliver, filter::FilterArgs};

pub const EXAMPLES: &str = "\
Examples:
  mot sort mot/PETS09-S2L1/det/det.txt --out result.txt
  mot sort det.txt --method byte > result.txt
  mot sort det.txt --max-age 30 --frames img1 > result.txt

A row of DET is FRAME,-1,X,Y,WIDTH,HEIGHT,CONFIDENCE,CLASS,...; DET may be - for standard input. SORT uses all rows, whatever their \
confidence and class; with --method byte only boxes of one class are paired. The result has a row \
FRAME,ID,X,Y,WIDTH,HEIGHT,1,CLASS,-1,-1 for each track in each frame, CLASS being -1 under SORT and where none is given.";

#[derive(Debug, Clone, Copy, ValueEnum)]
enum NoiseArg {
    /// The reference's, the same for every box
    Reference,
    /// In proportion to the first box of a track; the particle filter needs it
    Proportional,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum MethodArg {
    /// The reference's
    Sort,
    /// ByteTrack's
    Byte,
}

#[derive(Debug, Args)]
pub struct SortArgs {
    /// Detections, MOTChallenge text
    #[arg(value_name = "DET")]
    detections: PathBuf,
    /// SORT as its reference, or ByteTrack's association, which lets detections of low confidence prolong tracks
    #[arg(long, value_enum, default_value = "sort")]
    method: MethodArg,
    /// Frames that a track is kept without a detection [default: 1; 30 for byte]
    #[arg(long, value_name = "FRAMES")]
    max_age: Option<u32>,
    /// Updates in a row before a track is reported
    #[arg(long, default_value_t = 3, value_name = "COUNT")]
    min_hits: u32,
    /// Least overlap of a detection and a track's prediction, from 0 to 1 [default: 0.3; 0.1 for byte]
    #[arg(long, value_name = "OVERLAP")]
    iou: Option<f64>,
    /// Confidence from which a detection is of high confidence, for --method byte; a tenth more starts a track
    #[arg(long, default_value_t = 0.6, value_name = "CONFIDENCE")]
    high: f64,
    /// Confidence from which a detection is looked at, for --method byte
    #[arg(long, default_value_t = 0.1, value_name = "CONFIDENCE")]
    low: f64,
    #[command(flatten)]
    filter: FilterArgs,
    /// How uncertain boxes are: as the reference has it, or in proportion to the box
    #[arg(long, value_enum, default_value = "reference")]
    noise: NoiseArg,
    /// The frames (a folder of images or a video): colours of the boxes count in the association
    #[arg(long, value_name = "DIR")]
    frames: Option<String>,
    /// What colours count against overlap, from 0 to below 1; 0 turns them off
    #[arg(long, default_value_t = 0.5, value_name = "WEIGHT", requires = "frames")]
    appearance: f64,
    /// Write the tracks here instead of to standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl SortArgs {
    fn parameters(&self) -> Result<SortParameters> {
        let usual = SortParameters::default();
        let min_overlap = self.min_overlap(usual.min_overlap)?;
        if !(0.0..1.0).contains(&self.appearance) {
            return Err(BadInput(format!(
                "--appearance {}: give a number from 0 to below 1",
                self.appearance
            ))
            .into());
        }
        Ok(SortParameters {
            max_age: self.max_age.unwrap_or(usual.max_age),
            min_hits: self.min_hits,
            min_overlap,
            filter: self.filter.kind(),
            filter_options: self.filter.options()?,
            noise: self.noise(),
            appearance_weight: self.appearance,
        })
    }

    fn byte_parameters(&self) -> Result<ByteParameters> {
        if self.frames.is_some() {
            return Err(BadInput(
                "--frames with --method byte: its association has no colours; leave it out".to_owned(),
            )
            .into());
        }
        if self.low.is_nan() || self.high.is_nan() || self.low > self.high {
            let message = format!(
                "--low {} --high {}: give a low confidence that is not above the high one",
                self.low, self.high
            );
            return Err(BadInput(message).into());
        }
        let usual = ByteParameters::default();
        Ok(ByteParameters {
            high: self.high,
            low: self.low,
            min_overlap: self.min_overlap(usual.min_overlap)?,
            max_age: self.max_age.unwrap_or(usual.max_age),
            filter: self.filter.kind(),
            filter_options: self.filter.options()?,
            noise: self.noise(),
            ..usual
        })
    }

    fn noise(&self) -> BoxNoise {
        match self.noise {
            NoiseArg::Reference => BoxNoise::Reference,
            NoiseArg::Proportional => BoxNoise::Proportional,
        }
    }

    fn min_overlap(&self, usual: f64) -> Result<f64> {
        let given = self.iou.unwrap_or(usual);
        if !(0.0..=1.0).contains(&given) {
            return Err(BadInput(format!("--iou {given}: give a number from 0 to 1")).into());
        }
        Ok(given)
    }
}

pub fn sort(args: &SortArgs) -> Result<()> {
    match args.method {
        MethodArg::Sort => by_sort(args),
        MethodArg::Byte => by_byte(args),
    }
}

fn by_byte(args: &SortArgs) -> Result<()> {
    let mut tracker = ByteTracker::new(args.byte_parameters()?);
    let detections = read_detections(&args.detections)?;
    let last = detections.last().map_or(0, |last| last.frame);
    let mut rest = detections.as_slice();
    let (mut text, mut time, mut rows) = (String::new(), Duration::ZERO, 0);
    for frame in 1..=last {
        let boxes: Vec<ScoredBox> = (take_frame(&mut rest, frame).iter())
            .map(|seen| ScoredBox { area: seen.box_in_file, confidence: seen.confidence, class: seen.class })
            .collect();
        let start = Instant::now();
        let reported = tracker.update(&boxes)?;
        time += start.elapsed();
        rows += reported.len();
        for one in reported {
            let row =
                TrackRow { frame, identity: one.identity, box_in_file: one.tracked_box, confidence: 1.0 };
            text += &row_text_of_class(&row, one.class);
        }
    }
    deliver(args.out.as_deref(), &text)?;
    tell(last, rows, time);
    Ok(())
}

fn tell(frames: u32, rows: usize, time: Duration) {
    let speed = f64::from(frames) / time.as_secs_f64().max(f64::MIN_POSITIVE);
    eprintln!(
        "{frames} frames, {rows} boxes; {:.6} s in the tracker, {speed:.0} frames/s",
        time.as_secs_f64()
    );
}

fn by_sort(args: &SortArgs) -> Result<()> {
    let mut sort = Sort::new(args.parameters()?);
    let detections = read_detections(&args.detections)?;
    let mut colours = args.frames.as_deref().map(Colours::open).transpose()?;
    let last = detections.last().map_or(0, |last| last.frame);
    let mut rest = detections.as_slice();
    let mut text = String::new();
    let mut time = Duration::ZERO;
    let mut boxes: Vec<Rect> = Vec::new();
    let mut rows = 0;
    for frame in 1..=last {
        boxes.clear();
        boxes.extend(take_frame(&mut rest, frame).iter().map(|seen| seen.box_in_file));
        let appearances = colours.as_mut().map(|colours| colours.of(frame, &boxes)).transpose()?;
        let start = Instant::now();
        let reported = sort.update(&boxes, appearances.as_deref())?;
        time += start.elapsed();
        rows += reported.len();
        for one in reported {
            let box_in_file = one.tracked_box;
            text += &row_text(&TrackRow { frame, identity: one.identity, box_in_file, confidence: 1.0 });
        }
    }
    deliver(args.out.as_deref(), &text)?;
    tell(last, rows, time);
    Ok(())
}

/// Cuts the rows of `frame` off the front.
fn take_frame<'a>(rest: &mut &'a [Detection], frame: u32) -> &'a [Detection] {
    let (of_frame, after) = rest.split_at(rest.partition_point(|seen| seen.frame <= frame));
    *rest = after;
    of_frame
}

/// Frames, one after another, for the colours of boxes.
struct Colours {
    input: String,
    source: Box<dyn FrameSource>,
}

impl Colours {
    fn open(input: &str) -> Result<Self> {
        let sequence = open(input, &OpenOptions::default()).context("--frames")?;
        Ok(Self { input: input.to_owned(), source: sequence.source })
    }

    fn of(&mut self, frame: u32, boxes: &[Rect]) -> Result<Vec<Appearance>> {
        let next = self.source.next_frame()?;
        let Some(picture) = next else {
            let message = format!(
                "--frames {}: it ends before frame {frame}, which has detections after it; give all frames",
                self.input
            );
            return Err(BadInput(message).into());
        };
        let in_frame = boxes.iter().map(|seen| Origin::One.to_frame(*seen));
        Ok(in_frame.map(|area| Appearance::of(picture.frame.view(), &area)).collect())
    }
}
