//! Tracks of the moving objects before a static camera, by their motion alone (the pipeline of "Đánh giá hiệu năng các thuật
//! toán theo vết đối tượng chuyển động", section III, with the constants of the well-known MATLAB example of tracking in
//! atrium.mp4). In each frame:
//!
//! 1. Detections: background model, clean-up, blobs ([`Detector`]).
//! 2. Predict every track.
//! 3. Assign detections to tracks: least total cost, where a pair costs (z - Hx)' S^-1 (z - Hx) + ln |S| and a detection or a
//!    track left alone 20.
//! 4. Update the assigned tracks; the others are invisible. A box has the size of the last detection.
//! 5. Delete tracks that were invisible for 20 frames in a row, and young ones that were mostly invisible.
//! 6. Start a track from each detection that is left.
//!
//! A track is reported in frames where it was detected, from its eighth such frame on.

use std::time::Duration;

use infopart::{
    bayes::{FilterError, State},
    geometry::Rect,
};

use crate::{
    assignment::Assigner,
    grid::Grid,
    motion::{CentreModel, CentreNoise, FilterKind, FilterOptions, StateFilter},
};

mod clock;
mod detector;
mod reports;
#[cfg(test)]
mod tests;

pub(crate) use clock::PredictionClock;
pub use detector::{Detector, SceneWarning, USUAL_MIN_AREA, WarningWatch};
pub use reports::{Report, Reports, RowKind};

/// How tracks live and die.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackingParameters {
    /// What predicts a track.
    pub filter: FilterKind,
    /// How the filter runs.
    pub filter_options: FilterOptions,
    /// What leaving a detection or a track alone costs.
    pub unassigned_cost: f64,
    /// Frames in a row without a detection after which a track is deleted.
    pub max_invisible: u32,
    /// Frames with a detection from which on a track is reported.
    pub min_visible: u32,
    /// Frames below which a track is young.
    pub young: u32,
    /// Least share of frames with a detection that keeps a young track alive.
    pub min_visibility: f64,
}

impl Default for TrackingParameters {
    fn default() -> Self {
        Self {
            filter: FilterKind::Kalman,
            filter_options: FilterOptions::default(),
            unassigned_cost: 20.0,
            max_invisible: 20,
            min_visible: 8,
            young: 8,
            min_visibility: 0.6,
        }
    }
}

/// What became of a track in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackState {
    /// The track, counted from 1 in the order of their starts.
    pub identity: u64,
    /// Where it was expected, with the size of its last detection before; `None` in its first frame.
    pub predicted_in_frame: Option<Rect>,
    /// Its box as it was seen, if it was.
    pub detected_in_frame: Option<Rect>,
    /// Where it is now believed to be: with the size of its last detection, or a smoothed one ([`objects`](crate::objects)).
    pub box_in_frame: Rect,
    /// Whether it has been seen often enough to be reported.
    pub is_established: bool,
}

#[derive(Debug)]
struct Track<D, const N: usize> {
    identity: u64,
    filter: StateFilter<D, N, 2>,
    size: (f64, f64),
    predicted: Option<Rect>,
    detected: Option<Rect>,
    age: u32,
    visible: u32,
    /// Frames in a row without a detection.
    invisible: u32,
}

impl<D: CentreModel<N>, const N: usize> Track<D, N> {
    /// The believed centre with the size of the last detection.
    fn tracked_box(&self) -> Rect {
        let mean = &self.filter.belief().mean;
        let (w, h) = self.size;
        Rect::new(mean[0] - w / 2.0, mean[1] - h / 2.0, w, h)
    }
}

/// Tracks blobs whose centres move by the model `D`.
#[derive(Debug)]
pub struct BlobTracker<D, const N: usize> {
    parameters: TrackingParameters,
    model: D,
    tracks: Vec<Track<D, N>>,
    started: u64,
    costs: Grid,
    assigner: Assigner,
    states: Vec<TrackState>,
    clock: PredictionClock,
}

impl<D: CentreModel<N>, const N: usize> BlobTracker<D, N> {
    /// A tracker that has seen nothing.
    ///
    /// # Errors
    /// [`FilterError`] never, unless the model's constants are broken.
    pub fn new(parameters: TrackingParameters) -> Result<Self, FilterError> {
        Ok(Self {
            parameters,
            model: D::under(CentreNoise::ATRIUM)?,
            tracks: Vec::new(),
            started: 0,
            costs: Grid::default(),
            assigner: Assigner::default(),
            states: Vec::new(),
            clock: PredictionClock::default(),
        })
    }

    /// Steps 2 to 6 for the next frame's detections; gives what became of each track, the oldest first.
    ///
    /// # Errors
    /// [`FilterError`] if no track can start from a detection.
    pub fn update(&mut self, detections_in_frame: &[Rect]) -> Result<&[TrackState], FilterError> {
        self.predict();
        let alone = self.assign(detections_in_frame);
        self.delete();
        self.start(&alone)?;
        self.states.clear();
        self.states.extend(self.tracks.iter().map(|track| TrackState {
            identity: track.identity,
            predicted_in_frame: track.predicted,
            detected_in_frame: track.detected,
            box_in_frame: track.tracked_box(),
            is_established: track.visible >= self.parameters.min_visible,
        }));
        Ok(&self.states)
    }

    /// Mean time of predicting one track by one frame; `None` before the first.
    pub fn mean_prediction_time(&self) -> Option<Duration> {
        self.clock.mean()
    }

    /// Step 2.
    fn predict(&mut self) {
        self.clock.predict(&mut self.tracks, |track| track.filter.predict());
        for track in &mut self.tracks {
            track.predicted = Some(track.tracked_box());
        }
    }

    /// Steps 3 and 4; gives the detections that are left.
    fn assign(&mut self, detections: &[Rect]) -> Vec<Rect> {
        let Self { tracks, costs, assigner, parameters, .. } = self;
        costs.fill(tracks.len(), detections.len(), |track, detection| {
            tracks[track].filter.assignment_cost(&centre_of(&detections[detection]))
        });
        let mut is_left = vec![true; detections.len()];
        for track in tracks.iter_mut() {
            track.detected = None;
            track.age += 1;
            track.invisible += 1;
        }
        for &(track, detection) in assigner.solve_with_unassigned(costs, parameters.unassigned_cost) {
            let (track, seen) = (&mut tracks[track], detections[detection]);
            // A measurement that the filter cannot take leaves its prediction.
            let _ = track.filter.update(&centre_of(&seen));
            track.size = (seen.w, seen.h);
            track.detected = Some(seen);
            track.visible += 1;
            track.invisible = 0;
            is_left[detection] = false;
        }
        detections.iter().zip(is_left).filter_map(|(seen, left)| left.then_some(*seen)).collect()
    }

    /// Step 5.
    fn delete(&mut self) {
        let TrackingParameters { max_invisible, young, min_visibility, .. } = self.parameters;
        self.tracks.retain(|track| {
            let visibility = f64::from(track.visible) / f64::from(track.age);
            track.invisible < max_invisible && (track.age >= young || visibility >= min_visibility)
        });
    }

    /// Step 6.
    fn start(&mut self, alone: &[Rect]) -> Result<(), FilterError> {
        for &seen in alone {
            self.started += 1;
            let belief = D::first_belief(seen.centre(), CentreNoise::ATRIUM)?;
            let options = self.parameters.filter_options.for_track(self.started);
            self.tracks.push(Track {
                identity: self.started,
                filter: StateFilter::new(self.parameters.filter, self.model, belief, options)?,
                size: (seen.w, seen.h),
                predicted: None,
                detected: Some(seen),
                age: 1,
                visible: 1,
                invisible: 0,
            });
        }
        Ok(())
    }
}

fn centre_of(detection: &Rect) -> State<2> {
    let (x, y) = detection.centre();
    State::from([x, y])
}
