//! Looking for a target that was lost, over the whole frame.
//!
//! Steps, in each frame after the estimate:
//! 1. the search begins when the target has been lost for some frames in a row, or not been seen for more or since a cut, and ends
//!    when it is tracked again,
//! 2. where to look: around the suspect, if there is one; else around the place whose colours are most the target's of those that
//!    were not looked at lately, and around the next of a tour of places that covers the frame,
//! 3. (in `infopart/recovery.rs`) of the places there that the cues over the window answer to, the one most like the target by evidence
//!    and identity is the suspect,
//! 4. a suspect that was met so many frames in a row, each time near where it was before, is the target.

use serde::{Deserialize, Serialize};

use super::estimate::Status;
use crate::{
    features::foreground::{ForegroundMap, ForegroundModel},
    frame::FrameView,
    geometry::Rect,
};

/// Where a lost target is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SearchExtent {
    /// Nowhere but where the particles are.
    Off,
    /// At the other places in the window around where it was lost.
    Near,
    /// In the whole frame.
    #[default]
    Frame,
}

impl std::str::FromStr for SearchExtent {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "off" => Ok(Self::Off),
            "near" => Ok(Self::Near),
            "frame" => Ok(Self::Frame),
            _ => Err("give off, near or frame".to_owned()),
        }
    }
}

/// Frames in a row that must be lost before the search begins.
const LOST: u32 = 2;
/// Frames in a row without the target being tracked before the search begins.
const UNSEEN: u32 = 10;
/// Frames in a row in which a suspect must be met.
const MEETINGS: u32 = 3;
/// How far a suspect may move from one frame to the next, in square roots of its area.
const NEAR: f64 = 0.5;
/// Distance between the places of the tour along each axis, in sides of the window.
const TOUR_STEP: f64 = 0.5;
/// Frames for which a place is not looked at again for its colours.
const REST: u64 = 10;

/// A place where the target may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Suspect {
    /// The whole box, frame pixels.
    pub full: Rect,
    /// How sure the frame and identity are of it, in [0, 1].
    pub merit: f64,
}

/// The state of a search.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Search {
    lost: u32,
    unseen: u32,
    /// Width and height of the whole box when it was last tracked, pixels.
    size: (f64, f64),
    frame: u64,
    tour: usize,
    suspect: Option<Rect>,
    meetings: u32,
    /// Centres of the windows looked at for their colours, and when.
    visited: Vec<(f64, f64, u64)>,
    colours: ForegroundMap,
}

impl Search {
    /// A search that has not begun, for a target whose first whole box is that.
    pub fn new(full: &Rect) -> Self {
        Self { size: (full.w, full.h), ..Self::default() }
    }

    /// Takes note of an estimate; true while the target is to be searched (step 1).
    pub fn goes_on(&mut self, full: &Rect, status: Status) -> bool {
        self.frame += 1;
        if status == Status::Tracking {
            self.size = (full.w, full.h);
            (self.lost, self.unseen) = (0, 0);
            self.forget_suspect();
            self.visited.clear();
            return false;
        }
        self.unseen += 1;
        self.lost = if status == Status::Lost { self.lost + 1 } else { 0 };
        self.unseen >= UNSEEN || self.lost >= LOST
    }

    /// The scene was cut: a target that is not tracked then is searched at once.
    pub fn hurry(&mut self) {
        self.unseen = UNSEEN;
    }

    /// Where the suspect was.
    pub fn suspect(&self) -> Option<Rect> {
        self.suspect
    }

    /// The next whole box of a tour through the frame, for windows of that side (step 2).
    pub fn next_of_tour(&mut self, frame: &FrameView<'_>, window: f64) -> Rect {
        let step = TOUR_STEP * window;
        let places = |length: usize| (length as f64 / step).ceil().max(1.0) as usize;
        let (columns, rows) = (places(frame.width()), places(frame.height()));
        let place = self.tour % (columns * rows);
        self.tour = place + 1;
        let middle = |i: usize, count: usize, length: usize| (i as f64 + 0.5) / count as f64 * length as f64;
        let x = middle(place % columns, columns, frame.width());
        let y = middle(place / columns, rows, frame.height());
        self.around(x, y)
    }

    /// The whole box whose colours are most the target's of those not looked at lately, for windows of that side; `None` if none
    /// stands out (step 2).
    pub fn best_by_colour(
        &mut self,
        frame: &FrameView<'_>,
        model: &ForegroundModel,
        window: f64,
    ) -> Option<Rect> {
        let (width, height) = (frame.width() as f64, frame.height() as f64);
        self.colours.compute(model, frame, Rect::new(0.0, 0.0, width, height));
        let now = self.frame;
        self.visited.retain(|(_, _, when)| now - when < REST);
        let (w, h) = self.size;
        let places = |length: f64, side: f64| (2.0 * length / side).ceil().clamp(1.0, 200.0) as usize;
        let (columns, rows) = (places(width, w), places(height, h));
        let mut best: Option<(f32, Rect)> = None;
        for row in 0..rows {
            for column in 0..columns {
                let x = (column as f64 + 0.5) / columns as f64 * width;
                let y = (row as f64 + 0.5) / rows as f64 * height;
                let is_near = |&(a, b, _): &(f64, f64, u64)| (a - x).hypot(b - y) < window / 4.0;
                let full = self.around(x, y);
                let contrast = self.colours.contrast(full);
                if best.is_none_or(|(most, _)| contrast > most) && !self.visited.iter().any(is_near) {
                    best = Some((contrast, full));
                }
            }
        }
        let (contrast, full) = best?;
        if contrast <= 0.0 {
            return None;
        }
        let (x, y) = full.centre();
        self.visited.push((x, y, now));
        Some(full)
    }

    /// Takes note of the best candidate of this frame; true if the search has met it often enough (step 4).
    pub fn meets(&mut self, candidate: Option<Rect>) -> bool {
        let Some(full) = candidate else {
            self.forget_suspect();
            return false;
        };
        let near = |before: Rect| {
            let ((a, b), (x, y)) = (before.centre(), full.centre());
            (a - x).hypot(b - y) < NEAR * full.area().sqrt()
        };
        self.meetings = if self.suspect.is_some_and(near) { self.meetings + 1 } else { 1 };
        self.suspect = Some(full);
        let is_found = self.meetings >= MEETINGS;
        if is_found {
            // From here on it is the target: a search would begin anew.
            self.forget_suspect();
            (self.lost, self.unseen) = (0, 0);
        }
        is_found
    }

    fn forget_suspect(&mut self) {
        (self.suspect, self.meetings) = (None, 0);
    }

    fn around(&self, x: f64, y: f64) -> Rect {
        let (w, h) = self.size;
        Rect::new(x - w / 2.0, y - h / 2.0, w, h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Frame, PixelFormat};

    const FULL: Rect = Rect { x: 40.0, y: 30.0, w: 20.0, h: 40.0 };

    /// The target was never tracked but in the first frame.
    fn search() -> Search {
        Search::new(&FULL)
    }

    #[test]
    fn it_begins_after_two_lost_frames_or_ten_unseen_ones_and_ends_when_the_target_is_tracked() {
        let mut lost = search();
        assert!(!lost.goes_on(&FULL, Status::Lost) && lost.goes_on(&FULL, Status::Lost));
        assert!(!lost.goes_on(&FULL, Status::Tracking) && !lost.goes_on(&FULL, Status::Lost));
        let mut unsure = search();
        let first = (1..).find(|_| unsure.goes_on(&FULL, Status::Uncertain));
        assert_eq!(first, Some(10));
        let mut after_cut = search();
        after_cut.hurry();
        assert!(!after_cut.goes_on(&FULL, Status::Tracking), "it is still there");
        after_cut.hurry();
        assert!(after_cut.goes_on(&FULL, Status::Uncertain));
    }

    #[test]
    fn three_meetings_near_each_other_are_asked_for() {
        let mut search = search();
        let near = FULL.translated(8.0, 0.0);
        assert!(!search.meets(Some(FULL)) && !search.meets(Some(near)));
        assert_eq!(search.suspect(), Some(near));
        assert!(search.meets(Some(near)));
        assert!(search.suspect().is_none() && !search.meets(Some(near)), "a find is told once");
        assert!(!search.meets(Some(FULL.translated(90.0, 0.0))), "somebody else");
        assert!(!search.meets(None) && search.suspect().is_none());
        assert!(!search.meets(Some(FULL)) && !search.meets(Some(FULL)));
    }

    #[test]
    fn the_tour_comes_near_every_place_and_begins_again() {
        let mut search = search();
        let frame = Frame::new(vec![0; 200 * 120], 200, 120, PixelFormat::Gray).unwrap();
        let window = 80.0;
        let tour: Vec<_> = (0..15).map(|_| search.next_of_tour(&frame.view(), window).centre()).collect();
        for (x, y) in (0..200).step_by(7).flat_map(|x| (0..120).step_by(7).map(move |y| (x as f64, y as f64)))
        {
            let near = |&(a, b): &(f64, f64)| (a - x).abs() <= window / 4.0 && (b - y).abs() <= window / 4.0;
            assert!(tour.iter().any(near), "{x} {y}");
        }
        assert_eq!(search.next_of_tour(&frame.view(), window).centre(), tour[0]);
    }

    #[test]
    fn it_looks_where_the_targets_colours_are_and_not_twice_in_a_row() {
        let red = |x: usize, y: usize, left: usize| (left..left + 20).contains(&x) && (30..70).contains(&y);
        let frame = |left: usize| {
            let pixels = (0..240 * 120)
                .flat_map(|i| if red(i % 240, i / 240, left) { [210, 20, 20] } else { [90, 110, 90] })
                .collect();
            Frame::new(pixels, 240, 120, PixelFormat::Rgb).unwrap()
        };
        let mut model = ForegroundModel::new(1.0);
        model.learn(&frame(40).view(), FULL);
        let mut search = search();
        let found = search.best_by_colour(&frame(200).view(), &model, 100.0).unwrap();
        let (x, y) = found.centre();
        assert!((x - 210.0).abs() <= 10.0 && (y - 50.0).abs() <= 20.0, "{x} {y}");
        assert_eq!((found.w, found.h), (FULL.w, FULL.h));
        let again = search.best_by_colour(&frame(200).view(), &model, 100.0);
        assert!(again.is_none_or(|again| again.centre_distance(&found) >= 25.0));
    }
}
