//! SORT (Bewley et al. 2016): tracks from given detections, online. In each frame:
//!
//! 1. Predict every track; one that was not updated in the frame before starts its hit streak again. A track whose prediction
//!    is no box is dropped.
//! 2. Pair detections and predictions by overlap (`association`).
//! 3. Update the paired tracks; start a track from each detection that is left.
//! 4. Report a track that was updated in this frame and has a hit streak of `min_hits`, or is in one of the first `min_hits`
//!    frames. Drop tracks that were not updated for more than `max_age` frames.
//!
//! ```
//! use infopart::geometry::Rect;
//! use multi_object::sort::{Sort, SortParameters};
//!
//! let mut sort = Sort::new(SortParameters::default());
//! for frame in 0..5 {
//!     let seen = [Rect::new(10.0 + 3.0 * f64::from(frame), 20.0, 30.0, 60.0)];
//!     let reported = sort.update(&seen, None)?;
//!     assert_eq!((reported.len(), reported[0].identity), (1, 1));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use infopart::{bayes::FilterError, geometry::Rect};

use crate::{
    appearance::{Appearance, similarity},
    assignment::Assigner,
    camera_motion::CameraMotion,
    grid::Grid,
};

mod association;
mod box_model;
mod boxes;
mod byte;
mod oc;
#[cfg(test)]
mod tests;

use association::Association;
pub use box_model::BoxNoise;
use boxes::{BoxFilter, BoxTrack};
pub use boxes::{BoxFilterParameters, BoxTracker, ReportedBox, ScoredBox, is_trackable};
pub use byte::{ByteParameters, ByteTracker};
pub use oc::{OcParameters, OcTracker};

/// How SORT works; the defaults are those of the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct SortParameters {
    /// Frames that a track is kept without a detection.
    pub max_age: u32,
    /// Updates in a row before a track is reported, but for the first frames.
    pub min_hits: u32,
    /// Least overlap of a detection and a prediction that are paired, in [0, 1].
    pub min_overlap: f64,
    /// What predicts a track.
    pub filter: BoxFilterParameters,
    /// What likeness of colours counts in the pairing, against overlap, in [0, 1); only where appearances are given.
    pub appearance_weight: f64,
}

impl Default for SortParameters {
    fn default() -> Self {
        Self {
            max_age: 1,
            min_hits: 3,
            min_overlap: 0.3,
            filter: BoxFilterParameters::default(),
            appearance_weight: 0.5,
        }
    }
}

/// A track as it is reported in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reported {
    /// The track, counted from 1 in the order of their starts.
    pub identity: u64,
    /// Its box, in the coordinates of the detections.
    pub tracked_box: Rect,
    /// Index of its detection among those given for the frame.
    pub detection: usize,
}

#[derive(Debug)]
struct Track {
    common: BoxTrack,
    /// Updates in a row.
    hit_streak: u32,
    appearance: Option<Appearance>,
}

/// The tracker.
#[derive(Debug)]
pub struct Sort {
    parameters: SortParameters,
    tracks: Vec<Track>,
    started: u64,
    frames: u32,
    predicted: Vec<Rect>,
    overlap: Grid,
    score: Grid,
    assigner: Assigner,
    association: Association,
    reported: Vec<Reported>,
    boxes: Vec<Rect>,
    reported_boxes: Vec<ReportedBox>,
}

impl Sort {
    /// A tracker that has seen nothing.
    pub fn new(parameters: SortParameters) -> Self {
        Self {
            parameters,
            tracks: Vec::new(),
            started: 0,
            frames: 0,
            predicted: Vec::new(),
            overlap: Grid::default(),
            score: Grid::default(),
            assigner: Assigner::default(),
            association: Association::default(),
            reported: Vec::new(),
            boxes: Vec::new(),
            reported_boxes: Vec::new(),
        }
    }

    /// The next frame's detections, also if there are none; gives the tracks to report, the youngest first.
    /// `appearances`, where known, are those of `detections`.
    ///
    /// # Errors
    /// [`FilterError`] if a detection is so odd that no track can start from it.
    pub fn update(
        &mut self,
        detections: &[Rect],
        appearances: Option<&[Appearance]>,
    ) -> Result<&[Reported], FilterError> {
        self.frames += 1;
        self.predict();
        self.pair(detections, appearances);
        self.correct(detections, appearances)?;
        self.report();
        Ok(&self.reported)
    }

    /// Step 1.
    fn predict(&mut self) {
        self.predicted.clear();
        let predicted = &mut self.predicted;
        self.tracks.retain_mut(|track| {
            if track.common.unseen > 0 {
                track.hit_streak = 0;
            }
            let is_box = track.common.predict();
            predicted.extend(is_box.then_some(track.common.predicted));
            is_box
        });
    }

    /// Step 2.
    fn pair(&mut self, detections: &[Rect], appearances: Option<&[Appearance]>) {
        let Self { overlap, predicted, score, tracks, .. } = self;
        overlap.fill(detections.len(), predicted.len(), |row, column| {
            detections[row].overlap(&predicted[column])
        });
        let min_overlap = self.parameters.min_overlap;
        let Some(appearances) = appearances else {
            self.association.by_overlap(overlap, min_overlap, &mut self.assigner);
            return;
        };
        let weight = self.parameters.appearance_weight;
        score.fill(detections.len(), predicted.len(), |row, column| {
            let likeness =
                tracks[column].appearance.as_ref().map_or(0.0, |known| similarity(known, &appearances[row]));
            (1.0 - weight) * overlap.at(row, column) + weight * likeness
        });
        self.association.by_score(score, overlap, min_overlap, &mut self.assigner);
    }

    /// Step 3.
    fn correct(
        &mut self,
        detections: &[Rect],
        appearances: Option<&[Appearance]>,
    ) -> Result<(), FilterError> {
        for &(detection, track) in &self.association.pairs {
            let track = &mut self.tracks[track];
            track.hit_streak += 1;
            track.common.update(detection, &detections[detection]);
            if let (Some(known), Some(seen)) = (&mut track.appearance, appearances) {
                known.follow(&seen[detection]);
            }
        }
        for &detection in &self.association.detections_left {
            self.started += 1;
            let seen = (&detections[detection], None);
            self.tracks.push(Track {
                common: BoxTrack::new(self.started, detection, seen, &self.parameters.filter)?,
                hit_streak: 0,
                appearance: appearances.map(|seen| seen[detection].clone()),
            });
        }
        Ok(())
    }

    /// Step 4.
    fn report(&mut self) {
        let SortParameters { min_hits, max_age, .. } = self.parameters;
        self.reported.clear();
        for track in self.tracks.iter().rev() {
            let is_due = track.hit_streak >= min_hits || self.frames <= min_hits;
            if track.common.unseen > 0 || !is_due {
                continue;
            }
            if let Some(tracked_box) = track.common.believed_box() {
                let &BoxTrack { identity, detection, .. } = &track.common;
                self.reported.push(Reported { identity, tracked_box, detection });
            }
        }
        self.tracks.retain(|track| track.common.unseen <= max_age);
    }
}

impl BoxTracker for Sort {
    /// Confidences and classes do not count in the pairing.
    fn track(&mut self, detections: &[ScoredBox]) -> Result<&[ReportedBox], FilterError> {
        let mut boxes = std::mem::take(&mut self.boxes);
        boxes.clear();
        boxes.extend(detections.iter().map(|seen| seen.area));
        let updated = self.update(&boxes, None).map(|_| ());
        self.boxes = boxes;
        updated?;
        self.reported_boxes.clear();
        self.reported_boxes.extend(self.reported.iter().map(|one| ReportedBox {
            identity: one.identity,
            tracked_box: one.tracked_box,
            class: detections[one.detection].class,
            detection: one.detection,
        }));
        Ok(&self.reported_boxes)
    }

    fn move_camera(&mut self, motion: &CameraMotion) {
        self.tracks.iter_mut().for_each(|track| box_model::move_camera(&mut track.common.filter, motion));
    }
}
