//! OC-SORT (Cao et al. 2023, "Observation-Centric SORT"): where a track was seen counts more than what its filter made up while it
//! was not. In each frame, for detections of high confidence:
//!
//! 1. Predict every track.
//! 2. Pair detections and tracks: greatest total of overlap and momentum. Momentum is how well the direction from a track's
//!    sight `look_back` frames ago to the detection agrees with the direction in which it was going, (π/2 - angle) / π, times
//!    the confidence and `momentum`. A pair needs an overlap of `min_overlap`.
//! 3. Recovery: pair what is left by the overlap of a detection and a track's last sight, which is where one who stopped while
//!    hidden still is.
//! 4. Update the paired tracks. One that was not seen before first goes back to where it was at its last sight, and is led in
//!    a straight line, at an even pace, to the detection: the errors that grew in the gap are undone (re-update).
//! 5. Start a track from each detection left. Report a track that was seen in this frame and for `min_hits` frames in a row
//!    before, or is in one of the first `min_hits` frames, with the detection's own box. Drop tracks unseen for more than
//!    `max_age` frames.
//!
//! Only boxes of one class are paired. As in the authors' program, the last step of the re-update is followed by the usual update
//! with the same box.

use std::{collections::VecDeque, f64::consts::PI};

use infopart::{bayes::FilterError, geometry::Rect};

use super::{BoxFilter, BoxFilterParameters, BoxTracker, ReportedBox, ScoredBox, box_model, boxes::BoxTrack};
use crate::{assignment::Assigner, camera_motion::CameraMotion, grid::Grid};

/// How OC-SORT works; the defaults are those of its authors.
#[derive(Debug, Clone, PartialEq)]
pub struct OcParameters {
    /// Confidence from which a detection is looked at.
    pub high: f64,
    /// Least overlap of a pair, in [0, 1].
    pub min_overlap: f64,
    /// What momentum counts against overlap.
    pub momentum: f64,
    /// Frames over which a direction is measured, at least 1.
    pub look_back: u32,
    /// Updates in a row before a track is reported, but for the first frames.
    pub min_hits: u32,
    /// Frames that a track is kept without a detection.
    pub max_age: u32,
    /// What predicts a track.
    pub filter: BoxFilterParameters,
}

impl Default for OcParameters {
    fn default() -> Self {
        Self {
            high: 0.6,
            min_overlap: 0.3,
            momentum: 0.2,
            look_back: 3,
            min_hits: 3,
            max_age: 30,
            filter: BoxFilterParameters::default(),
        }
    }
}

#[derive(Debug)]
struct Track {
    common: BoxTrack,
    /// The filter as predicted for the first frame of the gap at hand.
    before_gap: Option<BoxFilter>,
    age: u32,
    last_seen: Rect,
    /// Age and box of the sights that a direction may be measured from, but for the first of all, as the authors have it.
    sights: VecDeque<(u32, Rect)>,
    /// Of unit length.
    direction: Option<(f64, f64)>,
    /// Updates in a row.
    hit_streak: u32,
}

/// The tracker.
#[derive(Debug)]
pub struct OcTracker {
    parameters: OcParameters,
    tracks: Vec<Track>,
    started: u64,
    frames: u32,
    assigner: Assigner,
    reported: Vec<ReportedBox>,
}

impl OcTracker {
    /// A tracker that has seen nothing.
    pub fn new(parameters: OcParameters) -> Self {
        Self {
            parameters,
            tracks: Vec::new(),
            started: 0,
            frames: 0,
            assigner: Assigner::default(),
            reported: Vec::new(),
        }
    }

    /// Step 1.
    fn predict(&mut self) {
        self.tracks.retain_mut(|track| {
            let unseen = track.common.unseen;
            if unseen == 1 {
                track.before_gap = Some(track.common.filter.clone());
            }
            if unseen > 0 {
                track.hit_streak = 0;
            }
            track.age += 1;
            track.common.predict()
        });
    }

    /// Steps 2 and 3 for some detections and tracks, and step 4 for the pairs; `overlap` and what counts beside it are of a track and
    /// a detection. Gives the detections and the tracks that are left.
    fn pair(
        &mut self,
        detections: &[ScoredBox],
        (seen, tracks): (Vec<usize>, Vec<usize>),
        overlap: impl Fn(&Track, &ScoredBox) -> f64,
        bonus: impl Fn(&Track, &ScoredBox) -> f64,
    ) -> (Vec<usize>, Vec<usize>) {
        // More than all good pairs together, so that classes are mixed only where nothing else is left.
        let never = 4.0 * (seen.len().min(tracks.len()) as f64 + 1.0);
        let overlaps = Grid::from_fn(seen.len(), tracks.len(), |row, column| {
            let (one, track) = (&detections[seen[row]], &self.tracks[tracks[column]]);
            if one.class == track.common.class { overlap(track, one) } else { -1.0 }
        });
        let costs = Grid::from_fn(seen.len(), tracks.len(), |row, column| match overlaps.at(row, column) {
            overlap if overlap < 0.0 => never,
            overlap => -(overlap + bonus(&self.tracks[tracks[column]], &detections[seen[row]])),
        });
        let (mut seen_left, mut tracks_left) = (vec![true; seen.len()], vec![true; tracks.len()]);
        for &(row, column) in self.assigner.solve(&costs) {
            if overlaps.at(row, column) >= self.parameters.min_overlap {
                (seen_left[row], tracks_left[column]) = (false, false);
                let place = seen[row];
                self.tracks[tracks[column]].update(place, &detections[place].area, self.parameters.look_back);
            }
        }
        let left = |all: Vec<usize>, is_left: Vec<bool>| {
            all.into_iter().zip(is_left).filter_map(|(one, left)| left.then_some(one)).collect()
        };
        (left(seen, seen_left), left(tracks, tracks_left))
    }

    /// Step 5, its beginning.
    fn start(&mut self, detection: usize, seen: &ScoredBox) -> Result<(), FilterError> {
        self.started += 1;
        self.tracks.push(Track {
            common: BoxTrack::new(
                self.started,
                detection,
                (&seen.area, seen.class),
                &self.parameters.filter,
            )?,
            before_gap: None,
            age: 0,
            last_seen: seen.area,
            sights: VecDeque::new(),
            direction: None,
            hit_streak: 0,
        });
        Ok(())
    }

    /// Step 5, its end.
    fn report(&mut self) {
        let OcParameters { min_hits, max_age, .. } = self.parameters;
        let is_first = self.frames <= min_hits;
        let due = (self.tracks.iter())
            .filter(|track| track.common.unseen == 0 && (track.hit_streak >= min_hits || is_first));
        self.reported.clear();
        self.reported.extend(due.map(|track| track.common.report(track.last_seen)));
        self.tracks.retain(|track| track.common.unseen <= max_age);
    }
}

impl BoxTracker for OcTracker {
    /// Steps 1 to 5.
    fn track(&mut self, detections: &[ScoredBox]) -> Result<&[ReportedBox], FilterError> {
        self.frames += 1;
        self.predict();
        let OcParameters { high, momentum, look_back, .. } = self.parameters;
        let sure = (0..detections.len()).filter(|&place| detections[place].confidence >= high).collect();
        let everyone = (0..self.tracks.len()).collect();
        let left = self.pair(
            detections,
            (sure, everyone),
            |track, seen| seen.area.overlap(&track.common.predicted),
            |track, seen| momentum * seen.confidence * track.agreement(&seen.area, look_back),
        );
        let last_seen = |track: &Track, seen: &ScoredBox| seen.area.overlap(&track.last_seen);
        let (left, _) = self.pair(detections, left, last_seen, |_, _| 0.0);
        for place in left {
            self.start(place, &detections[place])?;
        }
        self.report();
        Ok(&self.reported)
    }

    fn move_camera(&mut self, motion: &CameraMotion) {
        for track in &mut self.tracks {
            box_model::move_camera(&mut track.common.filter, motion);
            if let Some(filter) = &mut track.before_gap {
                box_model::move_camera(filter, motion);
            }
            track.last_seen = motion.of_box(&track.last_seen);
            track.sights.iter_mut().for_each(|(_, seen)| *seen = motion.of_box(seen));
            track.direction = track.direction.map(|direction| motion.of_direction(direction));
        }
    }
}

impl Track {
    /// Step 4.
    fn update(&mut self, detection: usize, seen: &Rect, look_back: u32) {
        if let Some(from) = self.reference(look_back) {
            self.direction = Some(direction(&from, seen));
        }
        if let Some(filter) = self.before_gap.take() {
            self.common.filter = filter;
            self.re_update(seen);
        }
        self.common.update(detection, seen);
        self.hit_streak += 1;
        self.last_seen = *seen;
        self.sights.push_back((self.age, *seen));
        while self.sights.front().is_some_and(|(age, _)| age + look_back < self.age) {
            self.sights.pop_front();
        }
    }

    /// Leads the filter, as it was predicted for the gap's first frame, from the last sight to this one.
    fn re_update(&mut self, seen: &Rect) {
        let (from, to) = (self.last_seen.centre(), seen.centre());
        let (first, last) = (self.last_seen, *seen);
        let unseen = self.common.unseen;
        for step in 1..=unseen {
            let share = f64::from(step) / f64::from(unseen);
            let between = |a: f64, b: f64| a + share * (b - a);
            let (w, h) = (between(first.w, last.w), between(first.h, last.h));
            let (x, y) = (between(from.0, to.0), between(from.1, to.1));
            let _ =
                self.common.filter.update(&box_model::measured(&Rect::new(x - w / 2.0, y - h / 2.0, w, h)));
            if step < unseen {
                let _ = self.common.filter.predict();
            }
        }
    }

    /// The sight that a direction is measured from: `look_back` frames ago, or else the next later one; at least the last.
    fn reference(&self, look_back: u32) -> Option<Rect> {
        let recent = self.sights.iter().find(|(age, _)| age + look_back >= self.age);
        recent.or(self.sights.back()).map(|(_, seen)| *seen)
    }

    /// How well the way to a box agrees with the track's, from -1/2 to 1/2; 0 while that is not known.
    fn agreement(&self, seen: &Rect, look_back: u32) -> f64 {
        let (Some(own), Some(from)) = (self.direction, self.reference(look_back)) else { return 0.0 };
        let there = direction(&from, seen);
        let cosine = (own.0 * there.0 + own.1 * there.1).clamp(-1.0, 1.0);
        (PI / 2.0 - cosine.acos()) / PI
    }
}

/// From one box's centre to another's, of unit length; of none where they coincide.
fn direction(from: &Rect, to: &Rect) -> (f64, f64) {
    let ((x, y), (to_x, to_y)) = (from.centre(), to.centre());
    let length = (to_x - x).hypot(to_y - y) + 1e-6;
    ((to_x - x) / length, (to_y - y) / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        motion::{FilterKind, FilterOptions, StateFilter},
        sort::{BoxNoise, box_model::BoxModel},
    };

    fn at(x: f64) -> ScoredBox {
        ScoredBox { area: Rect::new(x, 50.0, 20.0, 40.0), confidence: 0.9, class: None }
    }

    fn identities(tracker: &mut OcTracker, seen: &[ScoredBox]) -> Vec<u64> {
        tracker.track(seen).unwrap().iter().map(|one| one.identity).collect()
    }

    #[test]
    fn one_who_stops_while_hidden_is_found_where_he_was_last_seen() {
        let run = |momentum_only: bool| {
            let mut tracker = OcTracker::new(OcParameters::default());
            for frame in 0..10 {
                tracker.track(&[at(8.0 * f64::from(frame))]).unwrap();
            }
            (0..6).for_each(|_| assert!(tracker.track(&[]).unwrap().is_empty()));
            // Predicted 56 pixels on, beyond any overlap; he stands where he stood.
            let back = if momentum_only { 72.0 + 25.0 } else { 72.0 };
            (0..4).map(|_| identities(&mut tracker, &[at(back)])).collect::<Vec<_>>()
        };
        assert_eq!(run(false), [vec![], vec![], vec![1], vec![1]]);
        // Overlapping neither: another one.
        assert_eq!(run(true)[3], [2]);
    }

    #[test]
    fn a_re_update_forgets_the_way_that_was_made_up() {
        let mut tracker = OcTracker::new(OcParameters::default());
        for frame in 0..10 {
            tracker.track(&[at(8.0 * f64::from(frame))]).unwrap();
        }
        (0..5).for_each(|_| assert!(tracker.track(&[]).unwrap().is_empty()));
        tracker.track(&[at(72.0)]).unwrap();
        // As if he had been seen standing there in each frame of the gap; the last time counts twice.
        let (model, belief) = BoxModel::starting(&at(0.0).area, BoxNoise::Reference).unwrap();
        let mut led = StateFilter::new(FilterKind::Kalman, model, belief, FilterOptions::default()).unwrap();
        for frame in 1..16 {
            led.predict().unwrap();
            led.update(&box_model::measured(&at(f64::from(8 * frame.min(9))).area)).unwrap();
        }
        let moving = led.clone();
        led.update(&box_model::measured(&at(72.0).area)).unwrap();
        assert_ne!(moving.belief(), led.belief());
        assert!((tracker.tracks[0].common.filter.belief().mean - led.belief().mean).norm() < 1e-9);
        assert!(led.belief().mean[4] < 4.0, "of 8 pixels a frame");
    }

    #[test]
    fn of_two_who_meet_each_goes_on_his_way() {
        // Both detections overlap both predictions by as much; the directions decide.
        let track = |direction| Track { direction: Some(direction), ..tracks_one() };
        let (right, left) = (track((1.0, 0.0)), track((-1.0, 0.0)));
        assert!((right.agreement(&at(30.0).area, 3) - 0.5).abs() < 1e-3);
        assert!((left.agreement(&at(30.0).area, 3) + 0.5).abs() < 1e-3);
        let above = Rect::new(0.0, 10.0, 20.0, 40.0);
        assert!(right.agreement(&above, 3).abs() < 1e-6);
    }

    /// A track that was seen at 0 twice.
    fn tracks_one() -> Track {
        let mut tracker = OcTracker::new(OcParameters::default());
        (0..2).for_each(|_| assert_eq!(identities(&mut tracker, &[at(0.0)]), [1]));
        tracker.tracks.remove(0)
    }

    #[test]
    fn a_direction_is_measured_over_three_frames_or_what_there_is() {
        let mut track = tracks_one();
        for (age, x) in [(2, 5.0), (3, 9.0), (4, 20.0), (5, 21.0)] {
            track.age = age;
            track.update(0, &at(x).area, 3);
        }
        track.age = 6;
        // Ages 3 to 5 are within reach, and 2 was still kept.
        assert_eq!(track.reference(3).unwrap().x, 9.0);
        assert_eq!(track.reference(1).unwrap().x, 21.0);
        track.age = 30;
        assert_eq!(track.reference(3).unwrap().x, 21.0);
    }

    #[test]
    fn unsure_boxes_are_not_looked_at_and_classes_are_not_mixed() {
        let mut tracker = OcTracker::new(OcParameters { min_hits: 0, ..OcParameters::default() });
        let of = |confidence, class| ScoredBox { confidence, class: Some(class), ..at(0.0) };
        assert!(identities(&mut tracker, &[of(0.5, 1)]).is_empty());
        assert_eq!(identities(&mut tracker, &[of(0.9, 1)]), [1]);
        assert_eq!(identities(&mut tracker, &[of(0.9, 2)]), [2]);
        let both = tracker.track(&[of(0.9, 2), of(0.9, 1)]).unwrap();
        let found: Vec<_> = both.iter().map(|one| (one.identity, one.class, one.detection)).collect();
        assert_eq!(found, [(1, Some(1), 1), (2, Some(2), 0)]);
    }
}
