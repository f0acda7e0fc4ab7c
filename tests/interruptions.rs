//! Frames that show nothing of the target for a moment: black ones, repeated ones, a flash, another scene. The target is
//! held or found again after them, and nothing else is taken for it.

use infopart::{
    frame::{Frame, PixelFormat},
    geometry::Rect,
    sequence::{Absence, FrameSource, Walker, WalkerOptions},
    tracker::{Estimate, InfoPart, Parameters, Status, Tracker},
};

/// Frames before, during and after the interruption.
const BEFORE: usize = 40;
const AFTER: usize = 60;
/// Frames after it within which the target is tracked again.
const SOON: usize = 15;

struct Scene {
    frames: Vec<Frame>,
    truth: Vec<Rect>,
}

fn walk(seed: u64, frames: usize) -> Scene {
    let mut walker = Walker::new(WalkerOptions { seed, frames, ..WalkerOptions::default() });
    let truth = walker.ground_truth().into_iter().map(|full| full.expect("always in the picture")).collect();
    let mut shown = Vec::new();
    while let Some(source) = walker.next_frame().unwrap() {
        shown.push(source.frame);
    }
    Scene { frames: shown, truth }
}

fn plain(like: &Frame, level: u8) -> Frame {
    let (width, height) = (like.view().width(), like.view().height());
    Frame::new(vec![level; 3 * width * height], width, height, PixelFormat::Rgb).unwrap()
}

/// Tracks a walk whose frames from `BEFORE` on are replaced by `shown`; the estimates of the frames during and after.
fn interrupted(scene: &Scene, shown: &[Frame]) -> (Vec<Estimate>, Vec<Estimate>) {
    let mut tracker = InfoPart::new(Parameters::default().check().unwrap());
    tracker.init(scene.frames[0].view(), scene.truth[0]).unwrap();
    for frame in &scene.frames[1..BEFORE] {
        tracker.update(frame.view()).unwrap();
    }
    let during = shown.iter().map(|frame| tracker.update(frame.view()).unwrap()).collect();
    let rest = &scene.frames[BEFORE + shown.len()..];
    (during, rest.iter().map(|frame| tracker.update(frame.view()).unwrap()).collect())
}

/// The target is tracked soon after an interruption of `length` frames and to the end, and nothing else ever is.
#[track_caller]
fn assert_recovers(scene: &Scene, length: usize, after: &[Estimate]) {
    for (index, (estimate, truth)) in after.iter().zip(&scene.truth[BEFORE + length..]).enumerate() {
        assert_held(index, estimate, truth);
    }
}

/// So many frames after it was away, the target is what is called tracked; soon it is.
#[track_caller]
fn assert_held(frames_after: usize, estimate: &Estimate, truth: &Rect) {
    let overlap = truth.overlap(&estimate.box_in_frame);
    let is_tracked = estimate.status == Status::Tracking;
    let told = format!("{frames_after} frames after: {overlap}, {}", estimate.confidence);
    assert!(overlap > 0.3 || !is_tracked, "{told}");
    assert!(frames_after < SOON || overlap > 0.5, "{told}");
}

fn scenes(length: usize) -> impl Iterator<Item = Scene> {
    (1..=4).map(move |seed| walk(seed, BEFORE + length + AFTER))
}

#[test]
fn black_frames_are_not_the_target_and_are_survived() {
    for scene in scenes(10) {
        let black = vec![plain(&scene.frames[0], 0); 10];
        let (during, after) = interrupted(&scene, &black);
        assert!(during.iter().all(|estimate| estimate.status != Status::Tracking));
        assert_recovers(&scene, black.len(), &after);
    }
}

#[test]
fn a_flash_of_two_frames_is_not_the_target_and_is_survived() {
    for scene in scenes(2) {
        let flash = vec![plain(&scene.frames[0], 255); 2];
        let (during, after) = interrupted(&scene, &flash);
        assert!(during.iter().all(|estimate| estimate.status != Status::Tracking));
        assert_recovers(&scene, flash.len(), &after);
    }
}

#[test]
fn the_target_of_a_frozen_picture_stays_where_it_is_and_is_held_when_the_picture_jumps_on() {
    for scene in scenes(12) {
        let frozen = vec![scene.frames[BEFORE - 1].clone(); 12];
        let (during, after) = interrupted(&scene, &frozen);
        let place = scene.truth[BEFORE - 1];
        assert!(during.iter().all(|estimate| place.overlap(&estimate.box_in_frame) > 0.6));
        assert!(during.iter().all(|estimate| estimate.status == Status::Tracking));
        assert_recovers(&scene, frozen.len(), &after);
    }
}

#[test]
fn after_a_cut_to_another_street_and_back_the_target_is_tracked_again() {
    for seed in 1..=4 {
        let options = WalkerOptions { seed, frames: 150, absence: Absence::Cut, ..WalkerOptions::default() };
        let mut walker = Walker::new(options);
        let truth = walker.ground_truth();
        let back = (1..truth.len()).rfind(|&index| truth[index - 1].is_none()).unwrap();
        let mut tracker = InfoPart::new(Parameters::default().check().unwrap());
        for (index, truth) in truth.iter().enumerate() {
            let source = walker.next_frame().unwrap().unwrap();
            if index == 0 {
                tracker.init(source.frame.view(), truth.unwrap()).unwrap();
                continue;
            }
            let estimate = tracker.update(source.frame.view()).unwrap();
            if index >= back {
                assert_held(index - back, &estimate, &truth.unwrap());
            }
        }
    }
}
