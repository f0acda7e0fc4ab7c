//! What comes out of the loop. Everything that watches it is an [`Observer`].

use std::time::Duration;

use crate::{
    frame::FrameView,
    geometry::Rect,
    tracker::{BoxWarning, Estimate, Tracker},
};

mod annotate;
pub mod canvas;
mod contact_sheet;
mod destination;
mod error;
mod legend;
mod partial_file;
mod pictures;
mod progress;
mod rows;
#[cfg(test)]
pub(crate) mod testing;
mod text_table;
mod video;

pub use annotate::{annotate, rgb_from_view};
pub use contact_sheet::{ContactSheet, SheetSampler, Tile};
pub use destination::{Destination, StandardOutput};
pub use error::OutputError;
pub use partial_file::PartialFile;
pub use pictures::PictureFolder;
pub use progress::Progress;
pub use rows::{RowFormat, RowOptions, RowWriter};
pub use text_table::TextTable;
pub use video::{VIDEO_EXTENSIONS, VideoWriter};

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
    /// What is odd about the first box; empty in every frame but the first.
    pub warnings: &'a [BoxWarning],
    /// Wall time of `init` (first frame) or `update`; zero if the tracker did not get the frame.
    pub tracking_time: Duration,
    /// Whether the tracker did not get this frame: the estimate is then a prediction from its answers before.
    pub predicted: bool,
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

    /// Called instead of [`finish`](Self::finish) if the loop stopped early, so that what was seen so far is
    /// kept, marked as incomplete.
    ///
    /// # Errors
    /// [`OutputError`], if what was seen so far cannot be kept.
    fn flush(&mut self) -> Result<(), OutputError> {
        Ok(())
    }
}
