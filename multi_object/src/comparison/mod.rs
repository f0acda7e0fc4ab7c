//! How well filters predict: the experiment of "Đánh giá hiệu năng các thuật toán theo vết đối tượng chuyển động", Table III.
//!
//! The truth is what background subtraction detects. For each track in each frame, the box that its filter gives, before
//! and after the correction by that detection, is compared with the detection's box; a box has the size of the track's
//! last detection. Each frame's measures are over its tracks, and a video's are the means over its frames:
//!
//! - RMSE = sqrt(mean((x' - x)² + (y' - y)²)) of the centres, pixels,
//! - overlap = |S ∩ S'| / |S ∪ S'|,
//! - accuracy = |S ∩ S'| / min(|S|, |S'|).
//!
//! Each track in each frame is one of:
//!
//! - free: detected, and its prediction meets no other track's,
//! - overlapping: detected, and its prediction shares more than a tenth of the smaller with another track's,
//! - hidden: not detected, but detected again later; the truth is then between the detections before and after, in
//!   proportion to time. It has no correction.

use std::{collections::HashMap, time::Duration};

use infopart::{bayes::FilterError, geometry::Rect};

use crate::{
    motion::CentreModel,
    tracking::{BlobTracker, TrackState, TrackingParameters},
};

mod measures;
mod paper;
#[cfg(test)]
mod tests;

pub use measures::{FrameMeasures, Measures, mean_over_frames};
pub use paper::{PaperRow, paper_row};

/// Share of the smaller of two predictions above which they overlap.
const SHARED: f64 = 0.1;

/// What the filter could see of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Visibility {
    /// Detected, alone.
    Free,
    /// Detected, near another track.
    Overlapping,
    /// Not detected, but found again.
    Hidden,
}

impl Visibility {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Free, Self::Overlapping, Self::Hidden];

    /// What tables call it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Overlapping => "overlapping",
            Self::Hidden => "hidden",
        }
    }
}

/// One track in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The frame, counted from 1.
    pub frame: usize,
    /// The track.
    pub identity: u64,
    /// What could be seen of it.
    pub visibility: Visibility,
    /// Where it is.
    pub truth: Rect,
    /// Where the filter expected it.
    pub predicted: Rect,
    /// Where the filter believes it to be, knowing the detection; `None` if there was none.
    pub corrected: Option<Rect>,
}

/// A filter's samples of one video.
#[derive(Debug, Clone, Default)]
pub struct FilterRun {
    /// By frame, and in a frame by track; hidden ones after those seen.
    pub samples: Vec<Sample>,
    /// Mean time of a prediction.
    pub prediction_time: Option<Duration>,
}

/// Runs a filter over a video's detections (a slice a frame) and compares.
///
/// # Errors
/// [`FilterError`] if no track can start from a detection.
pub fn run_filter<D: CentreModel<N>, const N: usize>(
    detections_in_frames: &[Vec<Rect>],
    parameters: TrackingParameters,
) -> Result<FilterRun, FilterError> {
    let mut tracker = BlobTracker::<D, N>::new(parameters)?;
    let mut sampler = Sampler::default();
    for (index, detections) in detections_in_frames.iter().enumerate() {
        sampler.add(index + 1, tracker.update(detections)?);
    }
    sampler
        .samples
        .sort_by_key(|sample| (sample.frame, sample.visibility == Visibility::Hidden, sample.identity));
    Ok(FilterRun { samples: sampler.samples, prediction_time: tracker.mean_prediction_time() })
}

/// The last detection of a track, and its predictions since, that wait for the next one.
#[derive(Debug)]
struct Unseen {
    frame: usize,
    detection: Rect,
    predictions: Vec<Rect>,
}

#[derive(Debug, Default)]
struct Sampler {
    samples: Vec<Sample>,
    unseen: HashMap<u64, Unseen>,
}

impl Sampler {
    fn add(&mut self, frame: usize, states: &[TrackState]) {
        for (index, state) in states.iter().enumerate() {
            match (state.detected_in_frame, state.predicted_in_frame) {
                (Some(detection), Some(predicted)) => {
                    let visibility = visibility_of(index, predicted, states);
                    self.add_seen(frame, state, detection, predicted, visibility);
                }
                (None, Some(predicted)) => {
                    if let Some(unseen) = self.unseen.get_mut(&state.identity) {
                        unseen.predictions.push(predicted);
                    }
                }
                (_, None) => {}
            }
            if let Some(detection) = state.detected_in_frame {
                self.unseen.insert(state.identity, Unseen { frame, detection, predictions: Vec::new() });
            }
        }
        self.unseen.retain(|identity, _| states.iter().any(|state| state.identity == *identity));
    }

    fn add_seen(
        &mut self,
        frame: usize,
        state: &TrackState,
        truth: Rect,
        predicted: Rect,
        visibility: Visibility,
    ) {
        let identity = state.identity;
        self.samples.push(Sample {
            frame,
            identity,
            visibility,
            truth,
            predicted,
            corrected: Some(state.box_in_frame),
        });
        let Some(unseen) = self.unseen.get(&identity) else { return };
        for (index, &predicted) in unseen.predictions.iter().enumerate() {
            let hidden = unseen.frame + 1 + index;
            let share = (hidden - unseen.frame) as f64 / (frame - unseen.frame) as f64;
            self.samples.push(Sample {
                frame: hidden,
                identity,
                visibility: Visibility::Hidden,
                truth: between(&unseen.detection, &truth, share),
                predicted,
                corrected: None,
            });
        }
    }
}

fn visibility_of(index: usize, predicted: Rect, states: &[TrackState]) -> Visibility {
    let meets =
        |other: &Rect| predicted.intersection_area(other) > SHARED * predicted.area().min(other.area());
    let others = states.iter().enumerate().filter(|&(other, _)| other != index);
    let is_met = others.filter_map(|(_, state)| state.predicted_in_frame).any(|other| meets(&other));
    if is_met { Visibility::Overlapping } else { Visibility::Free }
}

fn between(before: &Rect, after: &Rect, share: f64) -> Rect {
    let mix = |a: f64, b: f64| a + share * (b - a);
    Rect::new(mix(before.x, after.x), mix(before.y, after.y), mix(before.w, after.w), mix(before.h, after.h))
}
