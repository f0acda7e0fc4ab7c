//! Trackers: the trait every one of them stands behind, InfoPart, and the colour-histogram particle filter.

pub mod colour;
mod confidence;
mod cues;
mod estimate;
mod evidence_map;
mod first_box;
mod identity;
mod infopart;
mod learning_gate;
mod motion;
mod parameters;
mod proposal;
mod sampling;
#[cfg(feature = "save")]
mod saved;
mod scene;
mod search;
mod stopwatch;
mod streams;
mod window_view;

use thiserror::Error;

use crate::{
    frame::{FrameStamp, FrameView},
    geometry::Rect,
};

pub use estimate::{BoxWarning, Elsewhere, Estimate, Evidence, StageTime, Status, WeightedBox};
pub use infopart::InfoPart;
pub use parameters::{CheckedParameters, ParameterError, Parameters, SCHEMA_VERSION};
#[cfg(feature = "save")]
pub use saved::LoadError;
pub use search::SearchExtent;

/// A single-object tracker. Object-safe and `Send`; it holds no global state, so any number may run at once.
pub trait Tracker: Send {
    /// The tracker's name in tables and result folders.
    fn name(&self) -> &str;

    /// Starts on `frame` with the target in `box_in_frame`. Can be called again at any time: nothing of the
    /// earlier target is kept. A box that can be tracked but hardly as meant comes back with warnings.
    ///
    /// # Errors
    /// [`TrackError::BadBox`] or [`TrackError::BoxOutside`]; the tracker then stays as it was.
    fn init(&mut self, frame: FrameView<'_>, box_in_frame: Rect) -> Result<Vec<BoxWarning>, TrackError>;

    /// Finds the target in the next frame, `stamp` telling where that frame stands in its video.
    ///
    /// # Errors
    /// [`TrackError::NotStarted`] before the first `init`, [`TrackError::SizeChanged`] if the frame differs
    /// in size from the one before; the tracker then stays as it was.
    fn update_at(&mut self, frame: FrameView<'_>, stamp: FrameStamp) -> Result<Estimate, TrackError>;

    /// [`update_at`](Self::update_at) for a frame of which neither index nor time is known.
    ///
    /// # Errors
    /// As [`update_at`](Self::update_at).
    fn update(&mut self, frame: FrameView<'_>) -> Result<Estimate, TrackError> {
        self.update_at(frame, FrameStamp::default())
    }

    /// The estimate of the frame that `init` or `update` saw last, if any.
    fn estimate(&self) -> Option<&Estimate>;

    /// The hypotheses weighed in the last frame, as full boxes, for pictures; none if the tracker has no particles.
    fn hypotheses(&self) -> Vec<WeightedBox> {
        Vec::new()
    }

    /// What else the tracker looked at in the last frame, for pictures; nothing if it looks nowhere else.
    fn elsewhere(&self) -> Elsewhere {
        Elsewhere::default()
    }

    /// How long each stage of the last `init` or `update` took, in order; none if the tracker does not measure.
    fn stage_times(&self) -> &[StageTime] {
        &[]
    }
}

/// Why a tracker could not start or go on.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum TrackError {
    /// The box has a side that is not positive, or a number that is not finite.
    #[error("the box {x},{y},{w},{h} cannot be tracked: give finite numbers and a positive width and height", x = given.x, y = given.y, w = given.w, h = given.h)]
    BadBox {
        /// The box as given, in frame coordinates.
        given: Rect,
    },
    /// No pixel of the box lies in the frame.
    #[error("the box {x},{y},{w},{h} has no pixel inside the {width}x{height} frame: give a box that touches the frame", x = given.x, y = given.y, w = given.w, h = given.h)]
    BoxOutside {
        /// The box as given, in frame coordinates.
        given: Rect,
        /// Width of the frame, pixels.
        width: usize,
        /// Height of the frame, pixels.
        height: usize,
    },
    /// No target, or more than a tracker of several can follow.
    #[error("{given} targets; give from 1 to {most}")]
    TargetCount {
        /// Targets given.
        given: usize,
        /// Targets at most.
        most: usize,
    },
    /// `update` was called before `init`.
    #[error("no target yet: call init with the first frame and the target's box")]
    NotStarted,
    /// The frame has another size than the one before.
    #[error(
        "the frame is {width}x{height} but tracking started on {first_width}x{first_height}: resize it, or call init again"
    )]
    SizeChanged {
        /// Width of this frame, pixels.
        width: usize,
        /// Height of this frame, pixels.
        height: usize,
        /// Width of the first frame, pixels.
        first_width: usize,
        /// Height of the first frame, pixels.
        first_height: usize,
    },
}
