//! What comes out of the loop. Everything that watches it is an [`Observer`].

use std::{path::PathBuf, time::Duration};

use thiserror::Error;

use crate::{
    frame::FrameView,
    geometry::Rect,
    tracker::{Estimate, Tracker},
};

/// What happened in one frame of the loop.
#[non_exhaustive]
pub struct FrameEvent<'a> {
    /// Position of the frame in its source, counted from 1.
    pub number: usize,
    /// What a message calls the frame.
    pub label: &'a str,
    /// Presentation time in a video.
    pub time: Option<Duration>,
    /// The pixels.
    pub frame: FrameView<'a>,
    /// What the tracker says; in the first frame, the initial box.
    pub estimate: &'a Estimate,
    /// The true box in frame coordinates, where it is known and the target present.
    pub ground_truth: Option<Rect>,
    /// The tracker, for its hypotheses and stage times.
    pub tracker: &'a dyn Tracker,
    /// Wall time of `init` (first frame) or `update`.
    pub tracking_time: Duration,
    /// Wall time of getting the frame from its source.
    pub decoding_time: Duration,
}

/// Watches the loop: writes rows, draws pictures, measures, shows progress.
pub trait Observer {
    /// Called once a frame, the first among them.
    ///
    /// # Errors
    /// [`OutputError`] ends the loop.
    fn on_frame(&mut self, event: &FrameEvent<'_>) -> Result<(), OutputError>;

    /// Called once after the last frame, and only if the loop came to its end: files become whole here.
    ///
    /// # Errors
    /// [`OutputError`], if what was written cannot be completed.
    fn finish(&mut self) -> Result<(), OutputError> {
        Ok(())
    }
}

/// Output that could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The file system refused.
    #[error("{path}: cannot be written: {source}; choose another path or make room", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}
