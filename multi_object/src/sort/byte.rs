//! ByteTrack's association (Zhang et al. 2022) on SORT's boxes: detections of low confidence are not thrown away, but may only
//! prolong tracks. In each frame:
//!
//! 1. Predict every track.
//! 2. Pair detections of high confidence with all tracks: greatest total overlap, each of at least `min_overlap`.
//! 3. Pair what is left of them with the tracks left over in the same way, both boxes enlarged by `enlarged` of their sides: an
//!    object that was out of sight is not where it was expected (the buffered overlap of Yang et al. 2023; not in ByteTrack).
//! 4. Pair those of low confidence with the tracks left over that were seen in the frame before, from `min_overlap_low` on. What
//!    is then left of them is forgotten.
//! 5. Update the paired tracks. Of those left over, drop the ones seen once only, and the ones unseen for more than `max_age`.
//! 6. Start a track from each detection left over that is sure enough.
//! 7. Report what was seen in this frame at least for the second time, or is in the first frame.
//!
//! Only boxes of one class are paired.
//!
//! ```
//! use infopart::geometry::Rect;
//! use multi_object::sort::{BoxTracker, ByteParameters, ByteTracker, ScoredBox};
//!
//! // Any detector's boxes, frame by frame; in the fourth it is not sure.
//! let mut tracker = ByteTracker::new(ByteParameters::default());
//! for (frame, confidence) in [0.9, 0.9, 0.9, 0.2, 0.9].into_iter().enumerate() {
//!     let area = Rect::new(10.0 + 3.0 * frame as f64, 20.0, 30.0, 60.0);
//!     let reported = tracker.track(&[ScoredBox { area, confidence, class: Some(1) }])?;
//!     assert_eq!((reported.len(), reported[0].identity, reported[0].class), (1, 1, Some(1)));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use infopart::{bayes::FilterError, geometry::Rect};

use super::{BoxFilterParameters, BoxTracker, ReportedBox, ScoredBox, box_model, boxes::BoxTrack};
use crate::{assignment::Assigner, camera_motion::CameraMotion, grid::Grid};

/// How ByteTrack works; the defaults are those of its paper, with its `match_thresh` of 0.9 as an overlap of 0.1.
#[derive(Debug, Clone, PartialEq)]
pub struct ByteParameters {
    /// Confidence from which a detection is one of high confidence.
    pub high: f64,
    /// Confidence from which a detection is looked at.
    pub low: f64,
    /// How much surer than `high` a detection must be to start a track.
    pub start_margin: f64,
    /// Least overlap of a pair of steps 2 and 3, in [0, 1].
    pub min_overlap: f64,
    /// How much of its sides a box is enlarged by at each of them in step 3; 0 leaves the step out.
    pub enlarged: f64,
    /// Least overlap of a pair of step 4, in [0, 1].
    pub min_overlap_low: f64,
    /// Frames that a track is kept without a detection.
    pub max_age: u32,
    /// What predicts a track.
    pub filter: BoxFilterParameters,
}

impl Default for ByteParameters {
    fn default() -> Self {
        Self {
            high: 0.6,
            low: 0.1,
            start_margin: 0.1,
            min_overlap: 0.1,
            enlarged: 0.5,
            min_overlap_low: 0.5,
            max_age: 30,
            filter: BoxFilterParameters::default(),
        }
    }
}

#[derive(Debug)]
struct Track {
    common: BoxTrack,
    hits: u32,
}

/// The tracker.
#[derive(Debug)]
pub struct ByteTracker {
    parameters: ByteParameters,
    tracks: Vec<Track>,
    started: u64,
    frames: u64,
    assigner: Assigner,
    reported: Vec<ReportedBox>,
}

impl ByteTracker {
    /// A tracker that has seen nothing.
    pub fn new(parameters: ByteParameters) -> Self {
        Self {
            parameters,
            tracks: Vec::new(),
            started: 0,
            frames: 0,
            assigner: Assigner::default(),
            reported: Vec::new(),
        }
    }

    /// Steps 2 to 4, and the update of step 5; gives the detections that are left.
    fn pair(
        &mut self,
        detections: &[ScoredBox],
        seen: Vec<usize>,
        tracks: &[usize],
        least: f64,
        enlarged: f64,
    ) -> Vec<usize> {
        let grown = |area: &Rect| {
            let (w, h) = ((1.0 + 2.0 * enlarged) * area.w, (1.0 + 2.0 * enlarged) * area.h);
            Rect::new(area.x - enlarged * area.w, area.y - enlarged * area.h, w, h)
        };
        let costs = Grid::from_fn(seen.len(), tracks.len(), |row, column| {
            let (one, track) = (&detections[seen[row]], &self.tracks[tracks[column]].common);
            let overlap = match enlarged > 0.0 {
                true => grown(&one.area).overlap(&grown(&track.predicted)),
                false => one.area.overlap(&track.predicted),
            };
            if overlap < least || one.class != track.class { 0.0 } else { -overlap }
        });
        let mut is_left = vec![true; seen.len()];
        for &(row, column) in self.assigner.solve(&costs) {
            if costs.at(row, column) >= 0.0 {
                continue;
            }
            let track = &mut self.tracks[tracks[column]];
            track.common.update(seen[row], &detections[seen[row]].area);
            track.hits += 1;
            is_left[row] = false;
        }
        seen.into_iter().zip(is_left).filter_map(|(one, left)| left.then_some(one)).collect()
    }

    /// Step 6.
    fn start(&mut self, detection: usize, seen: &ScoredBox) -> Result<(), FilterError> {
        if seen.confidence < self.parameters.high + self.parameters.start_margin {
            return Ok(());
        }
        self.started += 1;
        let common =
            BoxTrack::new(self.started, detection, (&seen.area, seen.class), &self.parameters.filter)?;
        self.tracks.push(Track { common, hits: 1 });
        Ok(())
    }

    /// Step 7.
    fn report(&mut self) {
        let is_first = self.frames == 1;
        let due = self.tracks.iter().filter(|track| track.common.unseen == 0 && (track.hits > 1 || is_first));
        self.reported.clear();
        self.reported.extend(due.filter_map(|track| Some(track.common.report(track.common.believed_box()?))));
    }
}

impl BoxTracker for ByteTracker {
    /// Steps 1 to 7.
    fn track(&mut self, detections: &[ScoredBox]) -> Result<&[ReportedBox], FilterError> {
        self.frames += 1;
        self.tracks.retain_mut(|track| track.common.predict());
        let ByteParameters { high, low, min_overlap, enlarged, min_overlap_low, max_age, .. } =
            self.parameters;
        let with = |wanted: &dyn Fn(f64) -> bool| -> Vec<usize> {
            (0..detections.len()).filter(|&place| wanted(detections[place].confidence)).collect()
        };
        let (sure, unsure) = (with(&|one| one >= high), with(&|one| (low..high).contains(&one)));
        let everyone: Vec<usize> = (0..self.tracks.len()).collect();
        let mut left = self.pair(detections, sure, &everyone, min_overlap, 0.0);
        if enlarged > 0.0 {
            let unseen: Vec<usize> =
                (0..self.tracks.len()).filter(|&index| self.tracks[index].common.unseen > 0).collect();
            left = self.pair(detections, left, &unseen, min_overlap, enlarged);
        }
        let recent: Vec<usize> =
            everyone.into_iter().filter(|&index| self.tracks[index].common.unseen == 1).collect();
        self.pair(detections, unsure, &recent, min_overlap_low, 0.0);
        self.tracks
            .retain(|Track { common, hits }| common.unseen == 0 || (*hits > 1 && common.unseen <= max_age));
        for place in left {
            self.start(place, &detections[place])?;
        }
        self.report();
        Ok(&self.reported)
    }

    fn move_camera(&mut self, motion: &CameraMotion) {
        self.tracks.iter_mut().for_each(|track| box_model::move_camera(&mut track.common.filter, motion));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(frames: &[&[(f64, f64, u32)]]) -> Vec<Vec<u64>> {
        let mut tracker = ByteTracker::new(ByteParameters::default());
        (frames.iter())
            .map(|seen| {
                let boxes: Vec<ScoredBox> = (seen.iter())
                    .map(|&(x, confidence, class)| ScoredBox {
                        area: Rect::new(x, 50.0, 20.0, 40.0),
                        confidence,
                        class: Some(class),
                    })
                    .collect();
                tracker.track(&boxes).unwrap().iter().map(|one| one.identity).collect()
            })
            .collect()
    }

    #[test]
    fn a_weak_box_prolongs_a_track_and_starts_none() {
        let strong: &[(f64, f64, u32)] = &[(100.0, 0.9, 1)];
        let weak: &[(f64, f64, u32)] = &[(100.0, 0.2, 1)];
        let none: &[(f64, f64, u32)] = &[];
        assert_eq!(run(&[strong, strong, weak, weak, strong]), vec![vec![1]; 5]);
        assert_eq!(run(&[weak, weak, weak]), vec![Vec::<u64>::new(); 3]);
        // After a gap a weak box is not enough, and a strong one finds the track again.
        assert_eq!(run(&[strong, strong, none, weak, strong]), [vec![1], vec![1], vec![], vec![], vec![1]]);
        // Below 0.7 nothing starts, below 0.1 nothing is looked at.
        assert_eq!(run(&[&[(100.0, 0.65, 1)], &[(100.0, 0.65, 1)]]), vec![Vec::<u64>::new(); 2]);
    }

    #[test]
    fn one_seen_once_is_forgotten_and_classes_are_not_mixed() {
        let far: &[(f64, f64, u32)] = &[(100.0, 0.9, 1), (300.0, 0.9, 1)];
        let near: &[(f64, f64, u32)] = &[(100.0, 0.9, 1)];
        assert_eq!(run(&[near, far, near, far, far]), [vec![1], vec![1], vec![1], vec![1], vec![1, 3]]);
        let other: &[(f64, f64, u32)] = &[(100.0, 0.9, 2)];
        assert_eq!(run(&[near, near, other, other]), [vec![1], vec![1], vec![], vec![2]]);
    }
}
