//! One job: a tracker from a segment's first frame to the sequence's last.

use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    sync::atomic::AtomicBool,
};

use infopart::{
    geometry::{Origin, Rect},
    output::{FrameEvent, Observer, OutputError},
    run::{RunFailure, run},
    sequence::{OpenOptions, open},
};

use super::{Job, Made, TrackerFactory};
use crate::words::{of_sequence, without_flags};

/// What a job gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The boxes, a row a frame, with the truth's origin; the first is the box given.
    pub rows: Vec<Rect>,
    /// Seconds that `init` and then each `update` took, by the tracker's own account if it gives one.
    pub seconds: Vec<f64>,
    /// What is known besides of a tracker in another process.
    pub external: Option<Conversation>,
    /// How sure the tracker was of each box, in [0, 1].
    pub confidences: Vec<f64>,
    /// The number of the first pixel in the truth's boxes.
    pub origin: Origin,
}

/// How a tracker in another process answered.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversation {
    /// Seconds from each image sent to its answer.
    pub round_trips: Vec<f64>,
    /// Answers that said that the target is lost; their boxes are kept as any.
    pub lost_frames: usize,
}

impl Default for Recording {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            seconds: Vec::new(),
            external: None,
            confidences: Vec::new(),
            origin: Origin::One,
        }
    }
}

impl Observer for Recording {
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError> {
        self.rows.push(self.origin.from_frame(event.estimate.box_in_frame));
        self.confidences.push(event.estimate.confidence);
        self.seconds.push(event.tracking_time.as_secs_f64());
        Ok(())
    }
}

/// How a job ended that gives no result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum JobFailure {
    /// It was told to stop.
    Stopped,
    /// It cannot be done; why, and what to do.
    Failed(String),
}

/// Runs a job to its end, or until `stop` is true. A tracker that panics fails its job, not the run.
///
/// # Errors
/// A failure says what is wrong and what to do.
pub fn execute(job: &Job, factory: &dyn TrackerFactory, stop: &AtomicBool) -> Result<Recording, JobFailure> {
    let outcome = catch_unwind(AssertUnwindSafe(|| track(job, factory, stop)));
    outcome.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Err(JobFailure::Failed(format!("the tracker broke down: {text}; please report this")))
    })
}

fn track(job: &Job, factory: &dyn TrackerFactory, stop: &AtomicBool) -> Result<Recording, JobFailure> {
    let failed = |error: &dyn std::fmt::Display| JobFailure::Failed(without_flags(&error.to_string()));
    let mut tracker = match factory.create(job.seed).map_err(|error| failed(&error))? {
        Made::Here(tracker) => tracker,
        Made::Elsewhere(recorder) => return recorder.record(job, stop),
    };
    let first = job.first_frame();
    let options = OpenOptions {
        target: job.folder.target,
        start: Some(first),
        end: Some(first + job.frames - 1),
        origin: Some(job.folder.origin),
        ..OpenOptions::default()
    };
    let mut sequence =
        open(&job.folder.path.to_string_lossy(), &options).map_err(|error| failed(&of_sequence(&error)))?;
    let mut recording = Recording { origin: job.folder.origin, ..Recording::default() };
    let first_box = job.folder.origin.to_frame(job.segment.first_box);
    run(sequence.source.as_mut(), &[], tracker.as_mut(), first_box, &mut [&mut recording], stop).map_err(
        |error| match *error.failure {
            RunFailure::Interrupted => JobFailure::Stopped,
            _ => failed(&error),
        },
    )?;
    if let Some(row) = recording.rows.first_mut() {
        *row = job.segment.first_box;
    }
    if recording.rows.len() < job.frames {
        return Err(JobFailure::Failed(format!(
            "the folder has only {} of the {} frames that its ground truth has rows for; run `otb_eval check {}`",
            recording.rows.len(),
            job.frames,
            job.folder.path.display()
        )));
    }
    Ok(recording)
}
