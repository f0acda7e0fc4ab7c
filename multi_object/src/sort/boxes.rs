//! What every tracker of boxes is given, gives back, and is built on.

use infopart::{bayes::FilterError, geometry::Rect};

use super::box_model::{BoxModel, MEASURED, STATE};
use crate::{camera_motion::CameraMotion, motion::StateFilter};

/// What predicts a box.
pub(super) type BoxFilter = StateFilter<BoxModel, STATE, MEASURED>;

/// A detector's box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScoredBox {
    /// The box, in coordinates of the caller's choice.
    pub area: Rect,
    /// The detector's confidence, usually in [0, 1].
    pub confidence: f64,
    /// What it is, if the detector says so.
    pub class: Option<u32>,
}

/// A track as it is reported in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReportedBox {
    /// The track, counted from 1 in the order of their starts.
    pub identity: u64,
    /// Its box.
    pub tracked_box: Rect,
    /// The class of its detection.
    pub class: Option<u32>,
    /// Index of its detection among those given for the frame, for whatever else is known of it.
    pub detection: usize,
}

/// A tracker of given boxes, a call a frame.
pub trait BoxTracker: Send {
    /// The next frame's detections, also if there are none; gives the tracks to report.
    ///
    /// # Errors
    /// [`FilterError`] if a detection is so odd that no track can start from it.
    fn track(&mut self, detections: &[ScoredBox]) -> Result<&[ReportedBox], FilterError>;

    /// Tells, before the next call of [`track`](Self::track), how the camera has moved since the last: whatever is
    /// remembered moves with the picture.
    fn move_camera(&mut self, motion: &CameraMotion);
}
