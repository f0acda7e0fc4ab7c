//! The walker is reproducible, honest about its boxes, and not trivial.

use std::f32::consts::FRAC_PI_2;

use super::*;
use crate::sequence::{OpenOptions, open};

fn walker(frames: usize, seed: u64) -> Walker {
    Walker::new(WalkerOptions { frames, seed, ..WalkerOptions::default() })
}

/// Mean absolute difference per sample between two frames inside a box, each frame's box its own.
fn change(walker: &Walker, first: usize, second: usize, part: impl Fn(Rect) -> Rect) -> f64 {
    let width = walker.options.width;
    let sample = |index: usize| -> Vec<f64> {
        let within = part(walker.moments[index].box_in_frame());
        let (pixels, gain) = (walker.rgb(index), walker.moments[index].gain);
        let places = (0..24 * 24).map(|cell| ((cell % 24) as f64 + 0.5, (cell / 24) as f64 + 0.5));
        places
            .flat_map(|(x, y)| {
                let x = (within.x + within.w * x / 24.0) as usize;
                let y = (within.y + within.h * y / 24.0) as usize;
                let at = 3 * (y * width + x);
                [pixels[at], pixels[at + 1], pixels[at + 2]].map(|value| f64::from(value) / gain)
            })
            .collect()
    };
    let (a, b) = (sample(first), sample(second));
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.len() as f64
}

#[test]
fn the_same_seed_gives_the_same_pixels_and_another_seed_others() {
    let frames = |seed| {
        let mut source = walker(3, seed);
        std::iter::from_fn(move || source.next_frame().unwrap()).map(|frame| frame.frame).collect::<Vec<_>>()
    };
    assert_eq!(frames(5).len(), 3);
    assert_eq!(frames(5), frames(5));
    assert_ne!(frames(5)[0], frames(6)[0]);
}

#[test]
fn the_legs_change_more_than_the_upper_part() {
    let walker = walker(150, 3);
    let upper = |full: Rect| Rect::new(full.x + full.w * 0.3, full.y, full.w * 0.4, full.h * 0.625);
    let lower = |full: Rect| Rect::new(full.x, full.y + full.h * 0.625, full.w, full.h * 0.375);
    let mean = |part: &dyn Fn(Rect) -> Rect| {
        (1..30).map(|step| change(&walker, 0, step * 4, part)).sum::<f64>() / 29.0
    };
    let (upper, lower) = (mean(&upper), mean(&lower));
    assert!(lower > 1.3 * upper, "legs change by {lower}, the rest by {upper}");
}

#[test]
fn the_person_stands_in_the_box_and_a_wide_step_fills_it() {
    let walker = walker(150, 2);
    for index in [0, 75, 149] {
        let truth = walker.moments[index].box_in_frame();
        let standing = drawn(&walker, index, 0.0);
        assert!((standing.y - truth.y).abs() < 1.5, "{standing:?} {truth:?}");
        assert!((standing.bottom() - truth.bottom()).abs() < 1.5, "{standing:?} {truth:?}");
        assert!(truth.x < standing.x && standing.right() < truth.right(), "{standing:?} {truth:?}");
        let striding = drawn(&walker, index, 1.0);
        assert!(truth.w < striding.w && striding.overlap(&truth) > 0.65, "{striding:?} {truth:?}");
        assert!((striding.centre().0 - truth.centre().0).abs() < 3.0, "{striding:?} {truth:?}");
    }
}

/// The pixels that the person covers in a frame with the legs at their widest, on black; the shadow is too dark to count.
fn drawn(walker: &Walker, index: usize, swing: f32) -> Rect {
    let moment = walker.moments[index];
    let foot = (moment.foot.0 as f32, moment.foot.1 as f32);
    let mut canvas = Canvas::new(320, 240);
    figure::draw(&mut canvas, &Pose { foot, height: moment.height as f32, phase: FRAC_PI_2, swing }, &WALKER);
    let painted = (0..320 * 240).filter(|&at| canvas.pixels[at].iter().sum::<f32>() > 50.0);
    let (xs, ys): (Vec<_>, Vec<_>) = painted.map(|at| ((at % 320) as f64, (at / 320) as f64)).unzip();
    let least = |values: &[f64]| values.iter().copied().fold(f64::MAX, f64::min);
    let most = |values: &[f64]| values.iter().copied().fold(f64::MIN, f64::max) + 1.0;
    Rect::new(least(&xs), least(&ys), most(&xs) - least(&xs), most(&ys) - least(&ys))
}

#[test]
fn the_written_folder_opens_as_what_was_rendered() {
    let folder = tempfile::tempdir().unwrap();
    walker(4, 9).write_otb_folder(folder.path()).unwrap();
    let walker = walker(3, 9);
    walker.write_otb_folder(folder.path()).unwrap();
    let mut sequence = open(folder.path().to_str().unwrap(), &OpenOptions::default()).unwrap();
    assert_eq!((sequence.source.remaining(), sequence.origin), (Some(3), Origin::One));
    for (read, truth) in sequence.ground_truth.iter().zip(walker.ground_truth()) {
        let (read, truth) = (read.unwrap(), truth.unwrap());
        assert!(read.overlap(&truth) > 1.0 - 1e-9);
    }
    let frame = sequence.source.next_frame().unwrap().unwrap();
    let rendered = walker.rgb(0);
    let rows = (0..240).flat_map(|y| frame.frame.view().row(y));
    let difference: f64 = rows.zip(&rendered).map(|(&a, &b)| f64::from(a.abs_diff(b))).sum();
    assert!(difference / (rendered.len() as f64) < 5.0);
}

#[test]
fn odd_sizes_render_and_no_frames_are_none() {
    for (width, height) in [(0, 0), (64, 64), (641, 97), (100, 500)] {
        let options =
            WalkerOptions { width, height, frames: 2, occluder: Occluder::Tree, ..WalkerOptions::default() };
        let frame = Walker::new(options).next_frame().unwrap().unwrap().frame;
        assert_eq!((frame.width(), frame.height()), (width.max(64), height.max(64)));
    }
    assert!(walker(0, 1).next_frame().unwrap().is_none());
}

#[test]
fn an_unwritable_folder_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let message = walker(1, 1).write_otb_folder(&file).unwrap_err().to_string();
    assert!(message.starts_with(&format!("{}: cannot be written", file.join("img").display())), "{message}");
}

#[test]
fn who_leaves_is_away_for_a_while_and_comes_back_on_the_left() {
    for seed in 1..=5 {
        let options =
            WalkerOptions { frames: 280, seed, absence: Absence::Leaves, ..WalkerOptions::default() };
        let truth = Walker::new(options).ground_truth();
        let away = truth.iter().filter(|target| target.is_none()).count();
        assert!((40..=100).contains(&away), "{away}");
        let leaves = truth.iter().position(Option::is_none).unwrap();
        assert!(truth[leaves - 1].unwrap().right() > 320.0);
        let back = truth[leaves + away].unwrap();
        assert!(back.right() <= 0.5 && truth[leaves + away + 30].unwrap().x > 20.0);
    }
}

#[test]
fn a_cut_shows_another_street_without_the_person() {
    let options = WalkerOptions { frames: 130, absence: Absence::Cut, ..WalkerOptions::default() };
    let (cut, whole) = (Walker::new(options), walker(130, 1));
    let truth = cut.ground_truth();
    let away: Vec<_> = (0..130).filter(|&index| truth[index].is_none()).collect();
    assert!((30..=60).contains(&away.len()) && away[0] == 60);
    let difference = |index: usize| {
        let pairs = cut.rgb(index).into_iter().zip(whole.rgb(index));
        pairs.map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>() / (320.0 * 240.0 * 3.0)
    };
    assert!(difference(59) == 0.0 && difference(away[away.len() - 1] + 1) == 0.0);
    assert!(difference(70) > 3.0, "{}", difference(70));
}

#[test]
fn a_wall_hides_the_person_for_about_sixty_frames() {
    let options = WalkerOptions { frames: 240, occluder: Occluder::Wall, ..WalkerOptions::default() };
    let walled = Walker::new(options);
    let hidden = (0..240).filter(|&index| walled.is_hidden(index)).count();
    assert!((50..=65).contains(&hidden), "{hidden}");
}

#[test]
fn a_companion_overtakes_in_the_clothes_asked_for() {
    let with = |companion| {
        let options = WalkerOptions { frames: 100, companion, ..WalkerOptions::default() };
        Walker::new(options)
    };
    let [nobody, unlike, alike] = [Companion::Nobody, Companion::Unlike, Companion::Alike].map(with);
    let moments = &alike.moments;
    assert!(moments[0].companion.0 < moments[0].foot.0 && moments[99].companion.0 > moments[99].foot.0);
    let frames = [&nobody, &unlike, &alike].map(|walker| walker.rgb(99));
    assert!(frames[0] != frames[1] && frames[1] != frames[2] && frames[0] != frames[2]);
}
