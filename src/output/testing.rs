//! Literal events for the observers' tests.

use std::time::Duration;

use super::FrameEvent;
use crate::{
    frame::{Frame, FrameStamp, FrameView, PixelFormat},
    geometry::{Rect, Region},
    tracker::{BoxWarning, Elsewhere, Estimate, Status, TrackError, Tracker, WeightedBox},
};

/// What an event borrows.
pub(crate) struct EventParts {
    pub number: usize,
    pub time: Option<Duration>,
    pub frame: Frame,
    pub estimate: Estimate,
    pub ground_truth: Option<Rect>,
    pub tracker: StillTracker,
}

impl EventParts {
    /// The first frame, black, 64 x 48, with the target in `box_in_frame`.
    pub(crate) fn new(box_in_frame: Rect) -> Self {
        Self::on(Frame::new(vec![0; 64 * 48], 64, 48, PixelFormat::Gray).unwrap(), box_in_frame)
    }

    /// The first frame with the target in `box_in_frame`.
    pub(crate) fn on(frame: Frame, box_in_frame: Rect) -> Self {
        let part = Region::Part.part_from_full(box_in_frame);
        Self {
            number: 1,
            time: None,
            frame,
            estimate: Estimate::new(box_in_frame, part, 1.0, Status::Tracking),
            ground_truth: None,
            tracker: StillTracker::default(),
        }
    }

    pub(crate) fn event(&self) -> FrameEvent<'_> {
        FrameEvent {
            number: self.number,
            label: "a frame",
            time: self.time,
            frame: self.frame.view(),
            estimate: &self.estimate,
            ground_truth: self.ground_truth,
            tracker: &self.tracker,
            warnings: &[],
            tracking_time: Duration::from_micros(2500),
            predicted: false,
            decoding_time: Duration::ZERO,
        }
    }
}

/// A tracker whose box never moves.
#[derive(Default)]
pub(crate) struct StillTracker {
    pub estimate: Option<Estimate>,
    pub hypotheses: Vec<WeightedBox>,
    pub elsewhere: Elsewhere,
}

impl Tracker for StillTracker {
    fn name(&self) -> &str {
        "Still"
    }

    fn init(&mut self, _: FrameView<'_>, given: Rect) -> Result<Vec<BoxWarning>, TrackError> {
        if !given.is_proper() {
            return Err(TrackError::BadBox { given });
        }
        let part = Region::Part.part_from_full(given);
        self.estimate = Some(Estimate::new(given, part, 1.0, Status::Tracking));
        Ok(if given.w < 2.0 { vec![BoxWarning::Tiny] } else { Vec::new() })
    }

    fn update_at(&mut self, _: FrameView<'_>, stamp: FrameStamp) -> Result<Estimate, TrackError> {
        let estimate = self.estimate.as_mut().ok_or(TrackError::NotStarted)?;
        // Every fourth frame is lost, so that counts of statuses can be told apart.
        let lost = stamp.index.is_some_and(|index| index % 4 == 3);
        estimate.status = if lost { Status::Lost } else { Status::Tracking };
        Ok(estimate.clone())
    }

    fn estimate(&self) -> Option<&Estimate> {
        self.estimate.as_ref()
    }

    fn hypotheses(&self) -> Vec<WeightedBox> {
        self.hypotheses.clone()
    }

    fn elsewhere(&self) -> Elsewhere {
        self.elsewhere.clone()
    }
}
