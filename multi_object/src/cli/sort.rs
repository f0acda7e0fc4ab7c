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
    sequence::{FrameSource, OpenOptions, SourceFrame, open},
};
use multi_object::{
    appearance::Appearance,
    camera_motion::{CameraMotion, CameraWatch},
    motchallenge::{Detection, TrackRow, read_detections, row_text_of_class},
    sort::{
        BoxFilterParameters, BoxNoise, BoxTracker, ByteParameters, ByteTracker, OcParameters, OcTracker,
        ReportedBox, ScoredBox, Sort, SortParameters,
    },
};

use super::{deliver, filter::FilterArgs};

pub const EXAMPLES: &str = "\
Examples:
  mot sort mot/PETS09-S2L1/det/det.txt --out result.txt
  mot sort det.txt --method byte > result.txt
  mot sort det.txt --max-age 30 --frames img1 > result.txt
  mot sort det.txt --method oc --frames drive.mp4 --camera-motion --out result.txt

A row of DET is FRAME,-1,X,Y,WIDTH,HEIGHT,CONFIDENCE,CLASS,...; DET may be - for standard input. SORT uses all rows, whatever their \
confidence and class; with --method byte or oc only boxes of one class are paired. The result has a row \
FRAME,ID,X,Y,WIDTH,HEIGHT,1,CLASS,-1,-1 for each track in each frame, CLASS being that of the detection, or -1 where it has none. \
With --method oc the box is the detection's own.

SORT with its defaults gives the reference's tracks. --max-age 30 loses fewer objects, and is the default of byte and oc.";

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
    /// ByteTrack's: detections of low confidence prolong tracks
    Byte,
    /// OC-SORT's: directions count, and a track found again is led there from its last sight
    Oc,
}

#[derive(Debug, Args)]
pub struct SortArgs {
    /// Detections, MOTChallenge text
    #[arg(value_name = "DET")]
    detections: PathBuf,
    /// How detections and tracks are paired
    #[arg(long, value_enum, default_value = "sort")]
    method: MethodArg,
    /// Frames that a track is kept without a detection [default: 1; 30 for byte and oc]
    #[arg(long, value_name = "FRAMES")]
    max_age: Option<u32>,
    /// Updates in a row before a track is reported; not for --method byte
    #[arg(long, default_value_t = 3, value_name = "COUNT")]
    min_hits: u32,
    /// Least overlap of a detection and a track's prediction, from 0 to 1 [default: 0.3; 0.1 for byte]
    #[arg(long, value_name = "OVERLAP")]
    iou: Option<f64>,
    /// Confidence from which a detection is of high confidence, for --method byte, where a tenth more starts a track, and oc, which
    /// looks at no other
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
    /// The frames (a folder of images or a video): under --method sort the boxes' colours count in the association
    #[arg(long, value_name = "DIR")]
    frames: Option<String>,
    /// Find out from the frames how the camera moves, and move what is predicted along
    #[arg(long, requires = "frames")]
    camera_motion: bool,
    /// What colours count against overlap, from 0 to below 1; 0 turns them off; for --method sort
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
            filter: self.box_filter()?,
            appearance_weight: self.appearance,
        })
    }

    fn byte_parameters(&self) -> Result<ByteParameters> {
        self.refuse_colours("byte")?;
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
            filter: self.box_filter()?,
            ..usual
        })
    }

    fn oc_parameters(&self) -> Result<OcParameters> {
        self.refuse_colours("oc")?;
        if self.high.is_nan() {
            return Err(BadInput("--high NaN: give a confidence".to_owned()).into());
        }
        let usual = OcParameters::default();
        Ok(OcParameters {
            high: self.high,
            min_overlap: self.min_overlap(usual.min_overlap)?,
            min_hits: self.min_hits,
            max_age: self.max_age.unwrap_or(usual.max_age),
            filter: self.box_filter()?,
            ..usual
        })
    }

    fn refuse_colours(&self, method: &str) -> Result<()> {
        if self.frames.is_some() && !self.camera_motion {
            let message = format!(
                "--frames with --method {method}: its association has no colours; add --camera-motion, or leave it out"
            );
            return Err(BadInput(message).into());
        }
        Ok(())
    }

    fn box_filter(&self) -> Result<BoxFilterParameters> {
        let noise = match self.noise {
            NoiseArg::Reference => BoxNoise::Reference,
            NoiseArg::Proportional => BoxNoise::Proportional,
        };
        Ok(BoxFilterParameters { kind: self.filter.kind(), options: self.filter.options()?, noise })
    }

    fn min_overlap(&self, usual: f64) -> Result<f64> {
        let given = self.iou.unwrap_or(usual);
        if !(0.0..=1.0).contains(&given) {
            return Err(BadInput(format!("--iou {given}: give a number from 0 to 1")).into());
        }
        Ok(given)
    }
}

/// One of the methods. Only SORT's association has colours.
enum Method {
    Sort(Box<Sort>),
    Other(Box<dyn BoxTracker>),
}

impl Method {
    fn of(args: &SortArgs) -> Result<Self> {
        Ok(match args.method {
            MethodArg::Sort => Self::Sort(Box::new(Sort::new(args.parameters()?))),
            MethodArg::Byte => Self::Other(Box::new(ByteTracker::new(args.byte_parameters()?))),
            MethodArg::Oc => Self::Other(Box::new(OcTracker::new(args.oc_parameters()?))),
        })
    }

    fn has_colours(&self, args: &SortArgs) -> bool {
        matches!(self, Self::Sort(_)) && args.appearance > 0.0
    }

    fn move_camera(&mut self, motion: &CameraMotion) {
        match self {
            Self::Sort(tracker) => tracker.move_camera(motion),
            Self::Other(tracker) => tracker.move_camera(motion),
        }
    }

    /// The rows of a frame and their classes.
    fn track(
        &mut self,
        frame: u32,
        boxes: &[ScoredBox],
        appearances: Option<&[Appearance]>,
    ) -> Result<Vec<(TrackRow, Option<u32>)>> {
        let row = |identity, box_in_file| TrackRow { frame, identity, box_in_file, confidence: 1.0 };
        Ok(match (self, appearances) {
            (Self::Sort(tracker), Some(_)) => {
                let areas: Vec<Rect> = boxes.iter().map(|seen| seen.area).collect();
                let reported = tracker.update(&areas, appearances)?.iter();
                reported.map(|one| (row(one.identity, one.tracked_box), boxes[one.detection].class)).collect()
            }
            (Self::Sort(tracker), None) => rows_of(tracker.track(boxes)?, row),
            (Self::Other(tracker), _) => rows_of(tracker.track(boxes)?, row),
        })
    }
}

fn rows_of(reported: &[ReportedBox], row: impl Fn(u64, Rect) -> TrackRow) -> Vec<(TrackRow, Option<u32>)> {
    reported.iter().map(|one| (row(one.identity, one.tracked_box), one.class)).collect()
}

pub fn sort(args: &SortArgs) -> Result<()> {
    let mut method = Method::of(args)?;
    let detections = read_detections(&args.detections)?;
    let mut pictures = args.frames.as_deref().map(Pictures::open).transpose()?;
    let mut watch = args.camera_motion.then(CameraWatch::default);
    let last = detections.last().map_or(0, |last| last.frame);
    let mut rest = detections.as_slice();
    let (mut text, mut time, mut rows, mut unknown) = (String::new(), Duration::ZERO, 0, 0);
    let (mut boxes, mut before): (Vec<ScoredBox>, Vec<Rect>) = (Vec::new(), Vec::new());
    for frame in 1..=last {
        let scored = |seen: &Detection| ScoredBox {
            area: seen.box_in_file,
            confidence: seen.confidence,
            class: seen.class,
        };
        boxes.clear();
        boxes.extend(take_frame(&mut rest, frame).iter().map(scored));
        let in_frame = || boxes.iter().map(|seen| Origin::One.to_frame(seen.area));
        let mut appearances: Option<Vec<Appearance>> = None;
        if let Some(pictures) = &mut pictures {
            let picture = pictures.next(frame)?;
            let view = picture.frame.view();
            if method.has_colours(args) {
                appearances = Some(in_frame().map(|area| Appearance::of(view, &area)).collect());
            }
            if let Some(watch) = &mut watch {
                match watch.look(view, &before) {
                    Some(motion) => method.move_camera(&motion.with_first_pixel(1.0)),
                    None => unknown += u32::from(frame > 1),
                }
                before.clear();
                before.extend(in_frame());
            }
        }
        let start = Instant::now();
        let of_frame = method.track(frame, &boxes, appearances.as_deref())?;
        time += start.elapsed();
        rows += of_frame.len();
        of_frame.iter().for_each(|(row, class)| text += &row_text_of_class(row, *class));
    }
    deliver(args.out.as_deref(), &text)?;
    tell(last, rows, time);
    if unknown > 0 {
        eprintln!("the camera's motion could not be told in {unknown} of {last} frames, and is none there");
    }
    Ok(())
}

fn tell(frames: u32, rows: usize, time: Duration) {
    let speed = f64::from(frames) / time.as_secs_f64().max(f64::MIN_POSITIVE);
    eprintln!(
        "{frames} frames, {rows} boxes; {:.6} s in the tracker, {speed:.0} frames/s",
        time.as_secs_f64()
    );
}

/// Cuts the rows of `frame` off the front.
fn take_frame<'a>(rest: &mut &'a [Detection], frame: u32) -> &'a [Detection] {
    let (of_frame, after) = rest.split_at(rest.partition_point(|seen| seen.frame <= frame));
    *rest = after;
    of_frame
}

/// Frames, one after another.
struct Pictures {
    input: String,
    source: Box<dyn FrameSource>,
}

impl Pictures {
    fn open(input: &str) -> Result<Self> {
        let sequence = open(input, &OpenOptions::default()).context("--frames")?;
        Ok(Self { input: input.to_owned(), source: sequence.source })
    }

    fn next(&mut self, frame: u32) -> Result<SourceFrame> {
        let message = || {
            let input = &self.input;
            BadInput(format!(
                "--frames {input}: it ends before frame {frame}, which has detections after it; give all frames"
            ))
        };
        Ok(self.source.next_frame()?.ok_or_else(message)?)
    }
}
