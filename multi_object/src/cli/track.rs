//! `mot track`: what moves before a static camera.

use std::{
    path::{Path, PathBuf},
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use image::RgbImage;
use infopart::{
    geometry::Origin,
    output::{
        Destination, Observer, OutputError, PartialFile, PictureFolder, StandardOutput, VIDEO_EXTENSIONS,
        VideoWriter,
    },
    program::{self, BadInput},
    sequence::{FrameSource, OpenOptions, SourceFrame, open},
};
use multi_object::{
    drawing::TrackPainter,
    motchallenge::{TrackRow, row_text},
    motion::{CentreModel, ConstantTurn, ConstantVelocity, FilterKind},
    tracking::{BlobTracker, Detector, TrackState, TrackingParameters, USUAL_MIN_AREA},
};

use super::{Interrupted, filter::FilterArgs};

pub const EXAMPLES: &str = "\
Examples:
  mot track view1.avi --out tracks.txt --annotate seen.mp4
  mot track atrium.mp4 --filter pf --motion ctrv --particles 500 > tracks.txt

The camera must not move. A row is FRAME,ID,X,Y,WIDTH,HEIGHT,1,-1,-1,-1: an object in a frame where it was detected, from \
its eighth such frame on; frames and pixels count from 1. The output grows as FILE.partial and is renamed when it is whole.";

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MotionArg {
    /// Constant velocity
    Cv,
    /// Constant turn rate and speed
    Ctrv,
}

#[derive(Debug, Args)]
pub struct TrackArgs {
    /// A video (needs ffmpeg), or a folder or quoted glob of images
    video: String,
    #[command(flatten)]
    filter: FilterArgs,
    /// How objects move
    #[arg(long, value_enum, default_value = "cv")]
    motion: MotionArg,
    /// Smallest object, pixels
    #[arg(long, default_value_t = USUAL_MIN_AREA, value_name = "PIXELS")]
    min_area: usize,
    /// Write the tracks here instead of to standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draw identities and trails: a video (mp4, mkv, mov, avi), or a folder of pictures
    #[arg(long, value_name = "FILE.mp4|DIR")]
    annotate: Option<PathBuf>,
}

pub fn track(args: &TrackArgs) -> Result<()> {
    let parameters = TrackingParameters {
        filter: args.filter.kind(),
        filter_options: args.filter.options()?,
        ..TrackingParameters::default()
    };
    match args.motion {
        MotionArg::Cv => run::<ConstantVelocity, 4>(args, parameters),
        MotionArg::Ctrv if parameters.filter == FilterKind::Kalman => {
            let message = "--motion ctrv with --filter kalman: constant turn is not linear; give --filter ekf, ukf or pf";
            Err(BadInput(message.to_owned()).into())
        }
        MotionArg::Ctrv => run::<ConstantTurn, 5>(args, parameters),
    }
}

fn run<D: CentreModel<N>, const N: usize>(args: &TrackArgs, parameters: TrackingParameters) -> Result<()> {
    let mut source = open(&args.video, &OpenOptions::default())?.source;
    let mut tracker = BlobTracker::<D, N>::new(parameters)?;
    let mut detector = Detector::new(args.min_area)?;
    let mut rows = Rows::create(args.out.as_deref())?;
    let mut pictures = args.annotate.as_deref().map(Pictures::create).transpose()?;
    let interrupted = program::watch().context("Ctrl-C cannot be watched for")?;
    let (start, mut frames) = (Instant::now(), 0);
    while let Some(frame) = next_frame(source.as_mut())? {
        let detected = detector.detect(frame.frame.view());
        let (detections, warning) =
            detected.map_err(|error| BadInput(format!("{}, {}: {error}", args.video, frame.label)))?;
        if let Some(warning) = warning {
            eprintln!("warning: {}: {warning}", args.video);
        }
        let states = tracker.update(&detections)?;
        rows.write(frame.number, states)?;
        if let Some(pictures) = &mut pictures {
            pictures.write(&frame, states)?;
        }
        frames += 1;
        if interrupted.load(Ordering::Relaxed) {
            if let Some(pictures) = &mut pictures {
                pictures.flush()?;
            }
            return Err(Interrupted { frames }.into());
        }
    }
    rows.destination.complete()?;
    if let Some(pictures) = &mut pictures {
        pictures.finish()?;
    }
    tell(frames, start.elapsed(), &rows, tracker.mean_prediction_time());
    Ok(())
}

fn next_frame(source: &mut dyn FrameSource) -> Result<Option<SourceFrame>> {
    Ok(source.next_frame()?)
}

fn tell(frames: u32, time: Duration, rows: &Rows, prediction: Option<Duration>) {
    let seconds = time.as_secs_f64();
    let speed = f64::from(frames) / seconds.max(f64::MIN_POSITIVE);
    let prediction =
        prediction.map_or(String::new(), |time| format!("; {:.2} µs a prediction", time.as_secs_f64() * 1e6));
    eprintln!(
        "{frames} frames in {seconds:.1} s ({speed:.1} frames/s, decoding included); {} boxes of {} objects{prediction}",
        rows.boxes,
        rows.identities.len()
    );
}

/// The rows of the established tracks that were detected.
struct Rows {
    destination: Box<dyn Destination>,
    boxes: usize,
    identities: std::collections::HashSet<u64>,
}

impl Rows {
    fn create(path: Option<&Path>) -> Result<Self> {
        let destination: Box<dyn Destination> = match path {
            Some(path) => Box::new(PartialFile::create(path)?),
            None => Box::new(StandardOutput::new()),
        };
        Ok(Self { destination, boxes: 0, identities: std::collections::HashSet::new() })
    }

    fn write(&mut self, number: usize, states: &[TrackState]) -> Result<()> {
        let frame = u32::try_from(number).context("there are more frames than a row can count")?;
        for state in states.iter().filter(|state| state.is_established && state.detected_in_frame.is_some()) {
            let box_in_file = Origin::One.from_frame(state.box_in_frame);
            let row = TrackRow { frame, identity: state.identity, box_in_file, confidence: 1.0 };
            let written = self.destination.write_all(row_text(&row).as_bytes());
            written.map_err(|error| self.destination.name_error(error))?;
            self.boxes += 1;
            self.identities.insert(state.identity);
        }
        Ok(())
    }
}

/// Where annotated frames go.
struct Pictures {
    painter: TrackPainter,
    place: Place,
}

enum Place {
    Video(Box<VideoWriter>),
    Folder(PictureFolder),
}

impl Pictures {
    fn create(path: &Path) -> Result<Self, OutputError> {
        let extension =
            path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        let is_video = extension.is_some_and(|extension| VIDEO_EXTENSIONS.contains(&extension.as_str()));
        let place = match is_video && !path.is_dir() {
            true => Place::Video(Box::new(VideoWriter::create(path)?)),
            false => Place::Folder(PictureFolder::create(path)?),
        };
        Ok(Self { painter: TrackPainter::default(), place })
    }

    fn write(&mut self, frame: &SourceFrame, states: &[TrackState]) -> Result<(), OutputError> {
        let picture: RgbImage = self.painter.paint(frame.frame.view(), states);
        match &mut self.place {
            Place::Video(video) => video.write(picture, frame.time),
            Place::Folder(folder) => folder.write(&picture, frame.number),
        }
    }

    fn finish(&mut self) -> Result<(), OutputError> {
        match &mut self.place {
            Place::Video(video) => video.finish(),
            Place::Folder(_) => Ok(()),
        }
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        match &mut self.place {
            Place::Video(video) => video.flush(),
            Place::Folder(_) => Ok(()),
        }
    }
}
