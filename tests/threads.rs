//! Where a tracker works does not show in its boxes, and on the calling thread it starts no other.
//!
//! Everything is in one test: threads are counted in the whole program, so no other test may run beside it.

use std::sync::Arc;

use infopart::{
    frame::Frame,
    geometry::Rect,
    parallel::Threads,
    sequence::{FrameSource, Walker, WalkerOptions},
    tracker::{
        Estimate, InfoPart, Parameters, Tracker,
        colour::{ColourParameters, ColourTracker},
    },
};

fn walk() -> (Vec<Frame>, Rect) {
    let options = WalkerOptions { width: 160, height: 120, frames: 12, ..WalkerOptions::default() };
    let mut walker = Walker::new(options);
    let first = walker.ground_truth()[0].unwrap();
    (std::iter::from_fn(|| walker.next_frame().unwrap()).map(|frame| frame.frame).collect(), first)
}

fn track(mut tracker: impl Tracker, frames: &[Frame], first: Rect) -> Vec<Estimate> {
    tracker.init(frames[0].view(), first).unwrap();
    frames[1..].iter().map(|frame| tracker.update(frame.view()).unwrap()).collect()
}

/// Threads of this program, where the system tells.
fn running() -> Option<usize> {
    std::fs::read_dir("/proc/self/task").ok().map(Iterator::count)
}

#[test]
fn the_boxes_are_the_same_bits_wherever_the_work_is_done() {
    let (frames, first) = walk();
    let infopart = |threads| {
        // Enough of everything that there is something to share.
        let mut parameters = Parameters::default();
        (parameters.particles, parameters.boosting_turns) = (600, 1);
        track(InfoPart::with_threads(parameters.check().unwrap(), threads), &frames, first)
    };
    let colour = |threads| {
        let parameters = ColourParameters::default().check().unwrap();
        track(ColourTracker::with_threads(parameters, threads), &frames, first)
    };
    let before = running();
    let (alone, colour_alone) = (infopart(Threads::Calling), colour(Threads::Calling));
    assert_eq!(running(), before, "a thread was started");
    let pool = Arc::new(rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap());
    for threads in [Threads::Pool(pool), Threads::Ambient] {
        assert_eq!(infopart(threads.clone()), alone, "{threads:?}");
        assert_eq!(colour(threads.clone()), colour_alone, "{threads:?}");
    }
}
