//! `mot track`: what moves before a static camera.

use std::{
    io::Write,
    path::{Path, PathBuf},
    sync::atomic::Ordering,
    time::{Duration, Instant},
};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use image::RgbImage;
use infopart::{
    background::CleanUp,
    frame::FrameView,
    geometry::{Origin, Rect},
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
    objects::{ObjectError, ObjectParameters, ObjectTracker},
    tracking::{
        BlobTracker, Detector, Report, Reports, RowKind, SceneWarning, TrackState, TrackingParameters,
        USUAL_MIN_AREA,
    },
};

use super::{Interrupted, filter::FilterArgs, foreground::ForegroundArgs};

pub const EXAMPLES: &str = "\
Examples:
  mot track view1.avi --out tracks.txt --annotate seen.mp4
  mot track street.mp4 --region-of-interest 0,200,640,160 --noise-sigma 8 --write-detections det.txt --out tracks.txt
  mot track atrium.mp4 --preset paper --filter pf --motion ctrv --particles 500 > tracks.txt

The camera must not move. A row is FRAME,ID,X,Y,WIDTH,HEIGHT,SEEN,-1,-1,-1; frames and pixels count from 1. An object's rows begin \
with its first sight and are written once it has moved and was seen often enough; SEEN is 0 in frames in which it was hidden \
and that were filled in when it was seen again, and else 1. The output grows as FILE.partial and is renamed when it is whole.

--preset paper is the pipeline of the filters paper with the constants of the MATLAB example for atrium.mp4: what `mot compare` \
measures. It reports an object where it was detected, from its eighth such frame on.";

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MotionArg {
    /// Constant velocity
    Cv,
    /// Constant turn rate and speed
    Ctrv,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PresetArg {
    /// Objects by place, size and colour, in foreground that two may share
    Default,
    /// Blobs by their motion alone, as in the filters paper
    Paper,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BoxesArg {
    /// The filters' own, with a smoothed size
    Smoothed,
    /// As they were seen in the frame
    Raw,
}

#[derive(Debug, Args)]
pub struct TrackArgs {
    /// A video (needs ffmpeg), or a folder or quoted glob of images
    video: String,
    /// How objects are found and followed
    #[arg(long, value_enum, default_value = "default")]
    preset: PresetArg,
    #[command(flatten)]
    filter: FilterArgs,
    /// How objects move
    #[arg(long, value_enum, default_value = "cv")]
    motion: MotionArg,
    /// Frames that an object is kept without a sight
    #[arg(long, value_name = "FRAMES", default_value_t = 20)]
    max_age: u32,
    /// Frames whose background is learnt before the first is tracked, so that who stands there at first leaves no ghost; not
    /// with --preset paper
    #[arg(long, value_name = "FRAMES", default_value_t = 100)]
    look_ahead: usize,
    #[command(flatten, next_help_heading = "Foreground (what is not given is the preset's)")]
    foreground: ForegroundArgs,
    /// Which boxes are written
    #[arg(long, value_enum, default_value = "smoothed", help_heading = "Output")]
    boxes: BoxesArg,
    /// Write the tracks here instead of to standard output
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    out: Option<PathBuf>,
    /// Write what is detected in each frame, whatever the tracks, for `mot sort` and others
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    write_detections: Option<PathBuf>,
    /// Draw identities and trails: a video (mp4, mkv, mov, avi), or a folder of pictures
    #[arg(long, value_name = "FILE.mp4|DIR", help_heading = "Output")]
    annotate: Option<PathBuf>,
}

/// From frames to what becomes of tracks.
trait Pipeline {
    fn learn(&mut self, frame: FrameView<'_>) -> Result<(), ObjectError>;
    fn update(&mut self, frame: FrameView<'_>) -> Result<(), ObjectError>;
    fn states(&self) -> &[TrackState];
    fn detections(&mut self) -> Vec<Rect>;
    fn warning(&mut self) -> Option<SceneWarning>;
    fn mean_prediction_time(&self) -> Option<Duration>;
    /// Whether rows wait until it is known what they belong to.
    fn has_hindsight(&self) -> bool;
}

struct Paper<D, const N: usize> {
    detector: Detector,
    tracker: BlobTracker<D, N>,
    detections: Vec<Rect>,
    states: Vec<TrackState>,
    warning: Option<SceneWarning>,
}

impl<D: CentreModel<N>, const N: usize> Pipeline for Paper<D, N> {
    fn learn(&mut self, _: FrameView<'_>) -> Result<(), ObjectError> {
        Ok(())
    }

    fn update(&mut self, frame: FrameView<'_>) -> Result<(), ObjectError> {
        (self.detections, self.warning) = self.detector.detect(frame)?;
        self.states = self.tracker.update(&self.detections)?.to_vec();
        Ok(())
    }

    fn states(&self) -> &[TrackState] {
        &self.states
    }

    fn detections(&mut self) -> Vec<Rect> {
        self.detections.clone()
    }

    fn warning(&mut self) -> Option<SceneWarning> {
        self.warning.take()
    }

    fn mean_prediction_time(&self) -> Option<Duration> {
        self.tracker.mean_prediction_time()
    }

    fn has_hindsight(&self) -> bool {
        false
    }
}

struct Objects<D, const N: usize> {
    tracker: ObjectTracker<D, N>,
    states: Vec<TrackState>,
}

impl<D: CentreModel<N>, const N: usize> Pipeline for Objects<D, N> {
    fn learn(&mut self, frame: FrameView<'_>) -> Result<(), ObjectError> {
        self.tracker.learn(frame)
    }

    fn update(&mut self, frame: FrameView<'_>) -> Result<(), ObjectError> {
        self.states = self.tracker.update(frame)?.to_vec();
        Ok(())
    }

    fn states(&self) -> &[TrackState] {
        &self.states
    }

    fn detections(&mut self) -> Vec<Rect> {
        self.tracker.detections().to_vec()
    }

    fn warning(&mut self) -> Option<SceneWarning> {
        self.tracker.warning()
    }

    fn mean_prediction_time(&self) -> Option<Duration> {
        self.tracker.mean_prediction_time()
    }

    fn has_hindsight(&self) -> bool {
        true
    }
}

impl TrackArgs {
    fn pipeline(&self) -> Result<Box<dyn Pipeline>> {
        match self.motion {
            MotionArg::Cv => self.under::<ConstantVelocity, 4>(),
            MotionArg::Ctrv if self.filter.kind() == FilterKind::Kalman => {
                let message = "--motion ctrv with --filter kalman: constant turn is not linear; give --filter ekf, ukf or pf";
                Err(BadInput(message.to_owned()).into())
            }
            MotionArg::Ctrv => self.under::<ConstantTurn, 5>(),
        }
    }

    fn under<D: CentreModel<N> + 'static, const N: usize>(&self) -> Result<Box<dyn Pipeline>> {
        let refused = |error| BadInput(format!("the flags of the foreground: {error}"));
        let (filter, filter_options) = (self.filter.kind(), self.filter.options()?);
        let flags = &self.foreground;
        if self.preset == PresetArg::Default {
            let preset = ObjectParameters::default();
            let parameters = ObjectParameters {
                background: flags.background(preset.background.clone()),
                clean_up: flags.clean_up(preset.clean_up.clone()),
                regions_in_frame: flags.regions(),
                filter,
                filter_options,
                max_age: self.max_age,
                ..preset
            };
            let tracker = ObjectTracker::<D, N>::new(parameters.check().map_err(refused)?);
            return Ok(Box::new(Objects { tracker, states: Vec::new() }));
        }
        let clean_up = flags.clean_up(CleanUp { min_area: USUAL_MIN_AREA, ..CleanUp::default() });
        let background = flags.background(Detector::paper_background());
        let parameters = TrackingParameters {
            filter,
            filter_options,
            max_invisible: self.max_age,
            ..TrackingParameters::default()
        };
        Ok(Box::new(Paper {
            detector: Detector::with(background, clean_up, flags.regions()).map_err(refused)?,
            tracker: BlobTracker::<D, N>::new(parameters)?,
            detections: Vec::new(),
            states: Vec::new(),
            warning: None,
        }))
    }

    /// The beginning of the video is opened for itself.
    fn learn(&self, pipeline: &mut dyn Pipeline) -> Result<()> {
        if self.look_ahead == 0 || !pipeline.has_hindsight() {
            return Ok(());
        }
        let options = OpenOptions { end: Some(self.look_ahead), ..OpenOptions::default() };
        let mut source = open(&self.video, &options)?.source;
        while let Some(frame) = next_frame(source.as_mut())? {
            let learnt = pipeline.learn(frame.frame.view());
            learnt.map_err(|error| self.of_frame(&frame, &error))?;
        }
        Ok(())
    }

    fn of_frame(&self, frame: &SourceFrame, error: &ObjectError) -> BadInput {
        BadInput(format!("{}, {}: {error}", self.video, frame.label))
    }
}

pub fn track(args: &TrackArgs) -> Result<()> {
    let mut pipeline = args.pipeline()?;
    let interrupted = program::watch().context("Ctrl-C cannot be watched for")?;
    let mut source = open(&args.video, &OpenOptions::default())?.source;
    let mut rows = Rows::create(args, pipeline.has_hindsight())?;
    let mut pictures = args.annotate.as_deref().map(Pictures::create).transpose()?;
    let (start, mut frames) = (Instant::now(), 0);
    args.learn(pipeline.as_mut())?;
    while let Some(frame) = next_frame(source.as_mut())? {
        pipeline.update(frame.frame.view()).map_err(|error| args.of_frame(&frame, &error))?;
        if let Some(warning) = pipeline.warning() {
            eprintln!("warning: {}: {warning}", args.video);
        }
        rows.add(frame.number, pipeline.as_mut())?;
        if let Some(pictures) = &mut pictures {
            pictures.write(&frame, pipeline.states())?;
        }
        frames += 1;
        if interrupted.load(Ordering::Relaxed) {
            if let Some(pictures) = &mut pictures {
                pictures.flush()?;
            }
            return Err(Interrupted { frames }.into());
        }
    }
    rows.complete()?;
    if let Some(pictures) = &mut pictures {
        pictures.finish()?;
    }
    tell(frames, start.elapsed(), &rows, pipeline.mean_prediction_time());
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

/// The rows of the established tracks, and those of the detections.
struct Rows {
    destination: Box<dyn Destination>,
    detections: Option<PartialFile>,
    /// Where rows wait until it is known whose they are.
    reports: Option<Reports>,
    is_raw: bool,
    boxes: usize,
    identities: std::collections::HashSet<u64>,
}

impl Rows {
    fn create(args: &TrackArgs, has_hindsight: bool) -> Result<Self> {
        let destination: Box<dyn Destination> = match &args.out {
            Some(path) => Box::new(PartialFile::create(path)?),
            None => Box::new(StandardOutput::new()),
        };
        Ok(Self {
            destination,
            detections: args.write_detections.as_deref().map(PartialFile::create).transpose()?,
            reports: has_hindsight.then(Reports::default),
            is_raw: args.boxes == BoxesArg::Raw,
            boxes: 0,
            identities: std::collections::HashSet::new(),
        })
    }

    fn add(&mut self, number: usize, pipeline: &mut dyn Pipeline) -> Result<()> {
        let frame = u32::try_from(number).context("there are more frames than a row can count")?;
        if let Some(file) = &mut self.detections {
            for seen in pipeline.detections() {
                let Rect { x, y, w, h } = Origin::One.from_frame(seen);
                writeln!(file, "{frame},-1,{x:.2},{y:.2},{w:.2},{h:.2},1,-1,-1,-1")
                    .map_err(|error| file.name_error(error))?;
            }
        }
        let is_raw = self.is_raw;
        let box_of = |state: &TrackState| match state.detected_in_frame {
            Some(seen) if is_raw => seen,
            _ => state.box_in_frame,
        };
        let states = pipeline.states();
        let ready = match &mut self.reports {
            Some(reports) => reports.add(frame, states, box_of),
            None => {
                let seen = states.iter().filter(|one| one.is_established && one.detected_in_frame.is_some());
                let report = |one: &TrackState| {
                    let (identity, box_in_frame) = (one.identity, box_of(one));
                    Report { frame, identity, box_in_frame, kind: RowKind::Seen }
                };
                seen.map(report).collect()
            }
        };
        self.write(&ready)
    }

    fn write(&mut self, reports: &[Report]) -> Result<()> {
        for &Report { frame, identity, box_in_frame, kind } in reports {
            let confidence = if kind == RowKind::Seen { 1.0 } else { 0.0 };
            let box_in_file = Origin::One.from_frame(box_in_frame);
            let row = TrackRow { frame, identity, box_in_file, confidence };
            let written = self.destination.write_all(row_text(&row).as_bytes());
            written.map_err(|error| self.destination.name_error(error))?;
            self.boxes += 1;
            self.identities.insert(identity);
        }
        Ok(())
    }

    fn complete(&mut self) -> Result<()> {
        let rest = self.reports.as_mut().map(Reports::finish).unwrap_or_default();
        self.write(&rest)?;
        self.destination.complete()?;
        Ok(self.detections.as_mut().map_or(Ok(()), Destination::complete)?)
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
