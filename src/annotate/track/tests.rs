use std::{error::Error, ops::ControlFlow};

use super::*;
use crate::{
    annotate::{Colour, Frames},
    frame::{FrameStamp, FrameView, PixelFormat},
    tracker::{BoxWarning, Estimate, Status, TrackError, Tracker},
};

const SIDE: usize = 64;

/// Frames of one byte each way that say which frame they are, so that the tracker below can tell what it is shown.
struct Numbered {
    pixels: Vec<Vec<u8>>,
    shown: Vec<usize>,
}

impl Numbered {
    fn new(count: u8) -> Self {
        Self { pixels: (0..count).map(|index| vec![index; SIDE * SIDE]).collect(), shown: Vec::new() }
    }
}

impl Frames for Numbered {
    fn view(&mut self, index: usize) -> Result<FrameView<'_>, Box<dyn Error + Send + Sync>> {
        self.shown.push(index);
        let pixels = self.pixels.get(index).ok_or("no such frame")?;
        Ok(FrameView::new(pixels, SIDE, SIDE, SIDE, PixelFormat::Gray)?)
    }
}

/// Moves its box by a pixel each frame it is shown, to the right, and is as sure as the frame's number is high.
#[derive(Default)]
struct Drifter {
    estimate: Option<Estimate>,
}

impl Tracker for Drifter {
    fn name(&self) -> &str {
        "drifter"
    }

    fn init(&mut self, _: FrameView<'_>, rect: Rect) -> Result<Vec<BoxWarning>, TrackError> {
        self.estimate = Some(Estimate::new(rect, rect, 1.0, Status::Tracking));
        Ok(Vec::new())
    }

    fn update_at(&mut self, frame: FrameView<'_>, stamp: FrameStamp) -> Result<Estimate, TrackError> {
        let number = frame.row(0)[0];
        assert_eq!(stamp.index, Some(u64::from(number)));
        let before = self.estimate.as_ref().ok_or(TrackError::NotStarted)?.box_in_frame;
        let moved = before.translated(1.0, 0.0);
        let found = Estimate::new(moved, moved, f64::from(number) / 100.0, Status::Tracking);
        self.estimate = Some(found.clone());
        Ok(found)
    }

    fn estimate(&self) -> Option<&Estimate> {
        self.estimate.as_ref()
    }
}

fn at(x: f64) -> Rect {
    Rect::new(x, 10.0, 20.0, 30.0)
}

fn object(keys: &[(usize, Option<f64>)]) -> Object {
    let mark = |x: Option<f64>| x.map_or(Mark::Absent, |x| Mark::Box(at(x)));
    Object {
        name: "a".into(),
        class: "person".into(),
        colour: Colour::of_object(0),
        keys: keys.iter().map(|&(frame, x)| (frame, mark(x))).collect(),
    }
}

/// The left edges of the track, and which frames were shown for it.
fn tracked(
    keys: &[(usize, Option<f64>)],
    count: u8,
    sides: Sides,
    passes: &mut Passes,
) -> (Vec<Option<f64>>, Vec<usize>) {
    let mut frames = Numbered::new(count);
    let mut tracker = || Box::new(Drifter::default()) as Box<dyn Tracker>;
    let mut watch = || ControlFlow::Continue(());
    let mut finder = Pathfinder { frames: &mut frames, tracker: &mut tracker, watch: &mut watch };
    let track = annotate(&object(keys), count.into(), sides, passes, &mut finder).unwrap();
    (track.iter().map(|found| found.map(|found| found.box_in_frame.x)).collect(), frames.shown)
}

#[test]
fn one_key_frame_is_tracked_to_both_ends() {
    let (found, shown) = tracked(&[(2, Some(10.0))], 5, Sides::Both, &mut Passes::default());
    assert_eq!(found, [12.0, 11.0, 10.0, 11.0, 12.0].map(Some));
    assert_eq!(shown, [2, 1, 0, 2, 3, 4]);
    let (found, _) = tracked(&[(2, Some(10.0))], 5, Sides::Forward, &mut Passes::default());
    assert_eq!(found, [None, None, Some(10.0), Some(11.0), Some(12.0)]);
}

#[test]
fn absence_begins_at_its_key_frame_and_ends_at_the_next_box() {
    let keys = [(0, Some(10.0)), (2, None), (4, Some(30.0)), (6, None)];
    let (found, shown) = tracked(&keys, 8, Sides::Both, &mut Passes::default());
    assert_eq!(found, [Some(10.0), Some(11.0), None, None, Some(30.0), Some(31.0), None, None]);
    assert_eq!(shown, [0, 1, 4, 5]);
    let (found, _) = tracked(&[(1, None), (3, Some(5.0))], 5, Sides::Both, &mut Passes::default());
    assert_eq!(found, [None, None, None, Some(5.0), Some(6.0)]);
}

#[test]
fn key_frames_stay_where_they_are_and_their_drift_is_taken_out() {
    let keys = [(0, Some(10.0)), (4, Some(10.0)), (5, Some(40.0))];
    let (found, _) = tracked(&keys, 6, Sides::Both, &mut Passes::default());
    for (found, expected) in found.iter().zip([10.0, 10.0, 10.0, 10.0, 10.0, 40.0]) {
        assert!((found.unwrap() - expected).abs() < 1e-9, "{found:?}");
    }
    let (found, _) = tracked(&keys, 6, Sides::Forward, &mut Passes::default());
    assert_eq!(found, [10.0, 11.0, 12.0, 13.0, 10.0, 40.0].map(Some));
}

#[test]
fn a_new_key_frame_costs_its_own_passes_and_nothing_else() {
    let mut passes = Passes::default();
    let keys = [(0, Some(0.0)), (9, Some(9.0))];
    let (_, shown) = tracked(&keys, 12, Sides::Both, &mut passes);
    assert_eq!(shown.len(), 10 + 10 + 3);
    assert_eq!(tracked(&keys, 12, Sides::Both, &mut passes).1, Vec::<usize>::new());
    let (_, shown) = tracked(&[keys[0], (4, Some(8.0)), keys[1]], 12, Sides::Both, &mut passes);
    assert_eq!(shown, [4, 3, 2, 1, 0, 4, 5, 6, 7, 8, 9]);
    // Taken back, the passes are as they were, and those of the key frame can be forgotten.
    passes.forget_unused();
    assert_eq!(tracked(&keys, 12, Sides::Both, &mut passes).1, Vec::<usize>::new());
    passes.forget_unused();
    assert!(passes.iter().all(|pass| pass.from != 4) && passes.iter().count() == 3, "{passes:?}");
}

#[test]
fn an_interrupted_pass_is_not_known_and_what_went_before_is() {
    let mut passes = Passes::default();
    let mut frames = Numbered::new(10);
    let mut tracker = || Box::new(Drifter::default()) as Box<dyn Tracker>;
    let mut left = 12;
    let mut watch = || {
        left -= 1;
        if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut finder = Pathfinder { frames: &mut frames, tracker: &mut tracker, watch: &mut watch };
    let keys = object(&[(0, Some(0.0)), (9, Some(9.0))]);
    let failure = annotate(&keys, 10, Sides::Both, &mut passes, &mut finder).unwrap_err();
    assert!(matches!(failure, PassError::Interrupted));
    assert_eq!(passes.iter().map(|pass| pass.sightings.len()).collect::<Vec<_>>(), [9]);
}

#[test]
fn a_frame_that_cannot_be_had_is_told() {
    let mut frames = Numbered::new(3);
    let mut tracker = || Box::new(Drifter::default()) as Box<dyn Tracker>;
    let mut watch = || ControlFlow::Continue(());
    let mut finder = Pathfinder { frames: &mut frames, tracker: &mut tracker, watch: &mut watch };
    let failure = annotate(&object(&[(0, Some(0.0))]), 5, Sides::Both, &mut Passes::default(), &mut finder)
        .unwrap_err();
    assert_eq!(failure.to_string(), "no such frame");
}
