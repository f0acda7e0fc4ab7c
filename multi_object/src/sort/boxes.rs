//! What every tracker of boxes is given, gives back, and is built on.

use infopart::{bayes::FilterError, geometry::Rect};

use super::box_model::{self, BoxModel, BoxNoise, MEASURED, STATE};
use crate::{
    camera_motion::CameraMotion,
    motion::{FilterKind, FilterOptions, StateFilter},
};

/// What predicts a box.
pub(super) type BoxFilter = StateFilter<BoxModel, STATE, MEASURED>;

/// Pixels beyond this are taken for a mistake: no picture has so many in a row, and areas and their squares stay exact enough.
const MOST_PIXELS: f64 = 1e7;

/// Whether a tracker can take a box: finite, with sides above 0, within 10,000,000 pixels of the origin and no larger, and of an
/// area that is a number.
pub fn is_trackable(area: &Rect) -> bool {
    let Rect { x, y, w, h } = *area;
    area.is_proper() && [x, y, w, h].iter().all(|value| value.abs() <= MOST_PIXELS) && area.area().is_normal()
}

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

/// What predicts the boxes of a tracker's tracks; by default the Kalman filter on the reference's noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxFilterParameters {
    /// The filter.
    pub kind: FilterKind,
    /// How it runs.
    pub options: FilterOptions,
    /// How uncertain boxes are.
    pub noise: BoxNoise,
}

impl Default for BoxFilterParameters {
    fn default() -> Self {
        Self { kind: FilterKind::Kalman, options: FilterOptions::default(), noise: BoxNoise::Reference }
    }
}

/// What the tracks of every tracker of boxes have.
#[derive(Debug)]
pub(super) struct BoxTrack {
    pub identity: u64,
    pub filter: BoxFilter,
    /// Where it is expected in this frame.
    pub predicted: Rect,
    pub class: Option<u32>,
    /// The detection that it was last updated with.
    pub detection: usize,
    /// Frames since the last update; 0 if it was updated in this frame.
    pub unseen: u32,
}

impl BoxTrack {
    /// A track that starts with the detection of that index, of that box and class.
    pub(super) fn new(
        identity: u64,
        detection: usize,
        (seen, class): (&Rect, Option<u32>),
        parameters: &BoxFilterParameters,
    ) -> Result<Self, FilterError> {
        let (model, belief) = BoxModel::starting(seen, parameters.noise)?;
        let options = parameters.options.for_track(identity);
        Ok(Self {
            identity,
            filter: StateFilter::new(parameters.kind, model, belief, options)?,
            predicted: *seen,
            class,
            detection,
            unseen: 0,
        })
    }

    /// Predicts the next frame, in which it was not seen yet; whether what is predicted is a box.
    pub(super) fn predict(&mut self) -> bool {
        self.unseen += 1;
        let is_alive = self.filter.predict().is_ok();
        let prediction = self.believed_box().filter(|_| is_alive);
        prediction.map(|area| self.predicted = area).is_some()
    }

    /// Takes the detection of that index.
    pub(super) fn update(&mut self, detection: usize, seen: &Rect) {
        // A measurement that the filter cannot take leaves its prediction.
        let _ = self.filter.update(&box_model::measured(seen));
        self.detection = detection;
        self.unseen = 0;
    }

    /// The box that is believed in, if it is one.
    pub(super) fn believed_box(&self) -> Option<Rect> {
        box_model::box_of(&self.filter.belief().mean)
    }

    /// What is reported of it if it is at `tracked_box`.
    pub(super) fn report(&self, tracked_box: Rect) -> ReportedBox {
        let &Self { identity, class, detection, .. } = self;
        ReportedBox { identity, tracked_box, class, detection }
    }
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
