//! The one loop: frames from a source, through a tracker, to whatever watches.

use std::{
    fmt,
    sync::atomic::{AtomicBool, Ordering},
    time::{Duration, Instant},
};

use serde::{Serialize, Serializer};
use thiserror::Error;

use crate::{
    frame::FrameStamp,
    geometry::Rect,
    metrics::{self, Scores},
    output::{FrameEvent, Observer, OutputError},
    sequence::{FrameSource, SequenceError, SourceFrame},
    tracker::{BoxWarning, Estimate, StageTime, Status, TrackError, Tracker},
};

mod pacing;
mod prediction;
mod summary;

use pacing::{Gate, sustained_frames_per_second};
use prediction::Predictor;

pub use pacing::Pace;
pub use summary::{Summary, tracker_title};

/// What the loop measured.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct RunReport {
    /// Frames seen, the first among them.
    pub frames: usize,
    /// Frames with status tracking, the first among them.
    pub tracking_frames: usize,
    /// Frames with status uncertain.
    pub uncertain_frames: usize,
    /// Frames with status lost.
    pub lost_frames: usize,
    /// Which frames the tracker was to get.
    #[serde(serialize_with = "as_text")]
    pub pace: Pace,
    /// Frames that the tracker did not get; their boxes are predictions.
    pub skipped_frames: usize,
    /// The highest rate at which frames can arrive, one of them waiting while the tracker is busy, without any being
    /// skipped but those that the stride leaves out, at the updates' measured times; `None` if there was no update.
    pub sustained_frames_per_second: Option<f64>,
    /// Wall time of all updates, seconds.
    pub update_seconds: f64,
    /// Updates a second of update time; `None` if there was no update.
    pub frames_per_second: Option<f64>,
    /// Wall time of `init`, seconds.
    pub init_seconds: f64,
    /// Wall time of getting frames from their source, seconds.
    pub decoding_seconds: f64,
    /// R1, R2 and AUC over the frames that have ground truth; `None` if there are none.
    pub scores: Option<Scores>,
    /// Mean time of each stage of an update, in the tracker's order.
    pub stages: Vec<StageMean>,
    /// What was odd about the first box.
    #[serde(serialize_with = "as_texts")]
    pub warnings: Vec<BoxWarning>,
}

/// How long a stage of an update took in the mean.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StageMean {
    /// The stage's name.
    pub stage: &'static str,
    /// Mean wall time over all updates, milliseconds.
    pub mean_milliseconds: f64,
}

impl RunReport {
    /// Frames that the tracker was given after the first.
    pub fn updates(&self) -> usize {
        self.frames.saturating_sub(1 + self.skipped_frames)
    }
}

fn as_text<S: Serializer>(pace: &Pace, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(pace)
}

fn as_texts<S: Serializer>(warnings: &[BoxWarning], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(warnings.iter().map(BoxWarning::to_string))
}

/// A loop that did not come to its end, and how far it came.
#[derive(Debug, Error)]
#[error("{failure}")]
#[non_exhaustive]
pub struct RunError {
    /// Frames that were tracked and shown to every observer.
    pub frames_done: usize,
    /// The last of them.
    pub last_good: Option<FrameName>,
    /// Why it ended.
    pub failure: Box<RunFailure>,
}

/// How a message names a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameName {
    /// Position in the source, counted from 1.
    pub number: usize,
    /// The file's name, or `frame N`.
    pub label: String,
}

impl fmt::Display for FrameName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.label == format!("frame {}", self.number) {
            f.write_str(&self.label)
        } else {
            write!(f, "frame {} ({})", self.number, self.label)
        }
    }
}

/// Why a loop ended early.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunFailure {
    /// The source could not deliver a frame.
    #[error(transparent)]
    Source(#[from] SequenceError),
    /// The tracker refused a frame or the first box.
    #[error("{frame}: {source}")]
    Track {
        /// The frame.
        frame: FrameName,
        /// The tracker's reason.
        source: TrackError,
    },
    /// An observer could not write.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// The source ended before its first frame.
    #[error("there is no frame to track: check --start and --end, and that the input holds frames")]
    NoFrames,
}

/// Tracks the target that is at `first_box_in_frame` in the source's first frame to the source's last one, showing
/// every frame to the observers in their order. `ground_truth` is the true box of each frame from the first on, as
/// far as it is known. The loop stops before the next frame once `interrupted` is true.
///
/// Frames are not kept: memory grows by a number a frame, and by a pair of boxes if the frame has ground truth.
///
/// # Errors
/// [`RunError`], which tells how far it came; the observers are then flushed, not finished.
pub fn run(
    source: &mut dyn FrameSource,
    ground_truth: &[Option<Rect>],
    tracker: &mut dyn Tracker,
    first_box_in_frame: Rect,
    observers: &mut [&mut dyn Observer],
    interrupted: &AtomicBool,
) -> Result<RunReport, RunError> {
    run_at(Pace::EveryFrame, source, ground_truth, tracker, first_box_in_frame, observers, interrupted)
}

/// [`run`] where the tracker gets only some of the frames. The others are shown as well, with a box that is predicted
/// from the tracker's answers so far, and count in the scores.
///
/// # Errors
/// As [`run`].
pub fn run_at(
    pace: Pace,
    source: &mut dyn FrameSource,
    ground_truth: &[Option<Rect>],
    tracker: &mut dyn Tracker,
    first_box_in_frame: Rect,
    observers: &mut [&mut dyn Observer],
    interrupted: &AtomicBool,
) -> Result<RunReport, RunError> {
    let epoch = Instant::now();
    let clock = || epoch.elapsed();
    let mut session = Session::new(pace, tracker, first_box_in_frame, &clock);
    let outcome = session
        .all_frames(source, ground_truth, observers, interrupted)
        .and_then(|()| Ok(observers.iter_mut().try_for_each(|observer| observer.finish())?));
    let progress = session.progress;
    match outcome {
        Ok(()) => Ok(progress.into_report(pace)),
        Err(failure) => {
            for observer in observers.iter_mut() {
                // The first failure is the one to tell; a second is most often its consequence.
                let _ = observer.flush();
            }
            Err(RunError {
                frames_done: progress.report.frames,
                last_good: progress.last_good,
                failure: Box::new(failure),
            })
        }
    }
}

/// A target on its way through a source.
struct Session<'a> {
    tracker: &'a mut dyn Tracker,
    first_box_in_frame: Rect,
    /// Time since any fixed moment.
    clock: &'a dyn Fn() -> Duration,
    gate: Gate,
    predictor: Predictor,
    progress: Progress,
}

/// What was made of a frame.
struct Step {
    estimate: Estimate,
    warnings: Vec<BoxWarning>,
    /// How long the tracker took; `None` if it did not get the frame.
    time: Option<Duration>,
}

impl<'a> Session<'a> {
    fn new(
        pace: Pace,
        tracker: &'a mut dyn Tracker,
        first_box_in_frame: Rect,
        clock: &'a dyn Fn() -> Duration,
    ) -> Self {
        let (gate, predictor) = (Gate::new(pace), Predictor::default());
        Self { tracker, first_box_in_frame, clock, gate, predictor, progress: Progress::default() }
    }

    fn all_frames(
        &mut self,
        source: &mut dyn FrameSource,
        ground_truth: &[Option<Rect>],
        observers: &mut [&mut dyn Observer],
        interrupted: &AtomicBool,
    ) -> Result<(), RunFailure> {
        let stop = || interrupted.load(Ordering::Relaxed);
        while !stop() {
            let decoding = (self.clock)();
            let next = source.next_frame();
            let decoding_time = (self.clock)() - decoding;
            if stop() {
                // Ctrl-C reaches a video's decoder too: what the source says now is about that.
                break;
            }
            let index = self.progress.report.frames;
            let Some(frame) = next? else {
                return if index == 0 { Err(RunFailure::NoFrames) } else { Ok(()) };
            };
            let step = self.step(index, &frame)?;
            let event = FrameEvent {
                number: frame.number,
                label: &frame.label,
                time: frame.time,
                frame: frame.frame.view(),
                estimate: &step.estimate,
                ground_truth: ground_truth.get(index).copied().flatten(),
                tracker: &*self.tracker,
                warnings: &step.warnings,
                tracking_time: step.time.unwrap_or_default(),
                predicted: step.time.is_none(),
                decoding_time,
            };
            observers.iter_mut().try_for_each(|observer| observer.on_frame(&event))?;
            self.progress.count(&event);
        }
        Err(RunFailure::Interrupted)
    }

    fn step(&mut self, index: usize, frame: &SourceFrame) -> Result<Step, RunFailure> {
        if index > 0
            && !self.gate.admits(index)
            && let Some(estimate) = self.predictor.predict(index, self.gate.answer_is_pending())
        {
            return Ok(Step { estimate, warnings: Vec::new(), time: None });
        }
        let start = (self.clock)();
        let (estimate, warnings) = if index == 0 { self.start(frame) } else { self.update(frame) }?;
        let time = (self.clock)() - start;
        if index > 0 {
            self.gate.updated(index, time.as_secs_f64());
        }
        self.predictor.learn(index, &estimate);
        Ok(Step { estimate, warnings, time: Some(time) })
    }

    fn start(&mut self, frame: &SourceFrame) -> Result<(Estimate, Vec<BoxWarning>), RunFailure> {
        let first_box = self.first_box_in_frame;
        let warnings =
            self.tracker.init(frame.frame.view(), first_box).map_err(|error| refused(frame, error))?;
        let estimate = self.tracker.estimate().cloned();
        let mut estimate =
            estimate.unwrap_or_else(|| Estimate::new(first_box, first_box, 1.0, Status::Tracking));
        // The way through the part and back may cost a last digit; the first row is the box as given.
        estimate.box_in_frame = first_box;
        Ok((estimate, warnings))
    }

    fn update(&mut self, frame: &SourceFrame) -> Result<(Estimate, Vec<BoxWarning>), RunFailure> {
        let index = frame.number.checked_sub(1).map(|index| index as u64);
        let stamp = FrameStamp { index, time: frame.time };
        let estimate =
            self.tracker.update_at(frame.frame.view(), stamp).map_err(|error| refused(frame, error))?;
        Ok((estimate, Vec::new()))
    }
}

fn refused(frame: &SourceFrame, source: TrackError) -> RunFailure {
    RunFailure::Track { frame: FrameName { number: frame.number, label: frame.label.clone() }, source }
}

/// What is known after the frames so far.
#[derive(Default)]
struct Progress {
    report: RunReport,
    last_good: Option<FrameName>,
    scored: Vec<(Rect, Rect)>,
    stage_totals: Vec<StageTime>,
    update_seconds: Vec<f64>,
}

impl Progress {
    fn count(&mut self, event: &FrameEvent<'_>) {
        let report = &mut self.report;
        report.decoding_seconds += event.decoding_time.as_secs_f64();
        if report.frames == 0 {
            report.init_seconds = event.tracking_time.as_secs_f64();
            report.warnings = event.warnings.to_vec();
        } else if event.predicted {
            report.skipped_frames += 1;
        } else {
            self.update_seconds.push(event.tracking_time.as_secs_f64());
            report.update_seconds += event.tracking_time.as_secs_f64();
            add_stages(&mut self.stage_totals, event.tracker.stage_times());
        }
        report.frames += 1;
        match event.estimate.status {
            Status::Tracking => report.tracking_frames += 1,
            Status::Uncertain => report.uncertain_frames += 1,
            Status::Lost => report.lost_frames += 1,
        }
        self.scored.extend(event.ground_truth.map(|truth| (event.estimate.box_in_frame, truth)));
        self.last_good = Some(FrameName { number: event.number, label: event.label.to_owned() });
    }

    fn into_report(self, pace: Pace) -> RunReport {
        let updates = self.report.updates();
        let mean = |total: &StageTime| StageMean {
            stage: total.stage,
            mean_milliseconds: 1e3 * total.time.as_secs_f64() / updates.max(1) as f64,
        };
        let sustained = sustained_frames_per_second(&self.update_seconds);
        RunReport {
            pace,
            sustained_frames_per_second: sustained.map(|rate| rate * pace.stride() as f64),
            frames_per_second: (updates > 0).then(|| updates as f64 / self.report.update_seconds.max(1e-9)),
            scores: metrics::score(&self.scored),
            stages: self.stage_totals.iter().map(mean).collect(),
            ..self.report
        }
    }
}

/// Adds a frame's times to the totals of the stages of the same names.
fn add_stages(totals: &mut Vec<StageTime>, times: &[StageTime]) {
    for time in times {
        match totals.iter_mut().find(|total| total.stage == time.stage) {
            Some(total) => total.time += time.time,
            None => totals.push(*time),
        }
    }
}

#[cfg(test)]
mod tests;
