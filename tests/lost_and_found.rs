//! A target that goes out of sight and comes back: is it found again, and is nothing taken for it meanwhile?
//!
//! The table of docs/robustness.md comes from
//! `cargo test --release --test lost_and_found -- --ignored --nocapture`.

use infopart::{
    frame::{Frame, PixelFormat},
    geometry::Rect,
    sequence::{Absence, Companion, FrameSource, Occluder, Walker, WalkerOptions},
    tracker::{Estimate, InfoPart, Parameters, SearchExtent, Status, Tracker},
};

/// A picture of a plain street, with a patterned target in `full` or without it.
fn picture(full: Option<Rect>, number: usize) -> Frame {
    let pixel = |x: usize, y: usize| {
        let noise = ((x * 7919 + y * 104_729 + number * 31) % 13) as u8;
        let ground = [96 + noise + (x / 40) as u8 * 3, 104 + noise, 92 + noise + (y / 30) as u8 * 3];
        let Some(full) = full else { return ground };
        let (u, v) = ((x as f64 - full.x) / full.w, (y as f64 - full.y) / full.h);
        if !(0.0..1.0).contains(&u) || !(0.0..1.0).contains(&v) {
            return ground;
        }
        match ((u * 3.0) as usize, (v * 6.0) as usize) {
            (1, 0) => [220, 180, 150],
            (_, 1..=3) => [190 - noise, 40 + 30 * (v * 6.0) as u8, 50],
            (0 | 2, 4..) => [40, 50, 120 + noise],
            _ => ground,
        }
    };
    let pixels = (0..480 * 270).flat_map(|i| pixel(i % 480, i / 480)).collect();
    Frame::new(pixels, 480, 270, PixelFormat::Rgb).unwrap()
}

/// Where the target is: it stands left, is away in frames 30 to 59, and comes back far off to the right.
fn place(number: usize) -> Option<Rect> {
    match number {
        0..30 => Some(Rect::new(60.0 + number as f64, 150.0, 30.0, 80.0)),
        30..60 => None,
        _ => Some(Rect::new(440.0 - number as f64, 40.0, 30.0, 80.0)),
    }
}

/// The estimates of that scene from the second frame on.
fn follow(search: SearchExtent) -> Vec<Estimate> {
    let mut parameters = Parameters::default();
    parameters.search = search;
    let mut tracker = InfoPart::new(parameters.check().unwrap());
    tracker.init(picture(place(0), 0).view(), place(0).unwrap()).unwrap();
    (1..100).map(|number| tracker.update(picture(place(number), number).view()).unwrap()).collect()
}

#[test]
fn who_comes_back_elsewhere_is_found_by_searching_the_frame_and_not_otherwise() {
    for (search, is_found) in
        [(SearchExtent::Off, false), (SearchExtent::Near, false), (SearchExtent::Frame, true)]
    {
        let estimates = follow(search);
        let overlap = |number: usize| place(number).unwrap().overlap(&estimates[number - 1].box_in_frame);
        assert!(overlap(29) > 0.7, "{search:?}: {}", overlap(29));
        let claimed = (35..60).filter(|&number| estimates[number - 1].status == Status::Tracking).count();
        assert_eq!(claimed, 0, "{search:?} calls the empty street the target");
        assert_eq!((75..100).all(|number| overlap(number) > 0.5), is_found, "{search:?}");
    }
}

/// Frames after the target is wholly visible again within which it should be found.
const SOON: usize = 15;

/// What became of scenes in which the target goes away.
#[derive(Debug, Default)]
struct Outcome {
    scenes: usize,
    /// Scenes in which the target was found soon after it came back.
    found: usize,
    /// Frames without the target, and those of them that were called tracking.
    without: usize,
    claimed: usize,
}

impl Outcome {
    fn add(&mut self, options: &WalkerOptions, search: SearchExtent) {
        let mut walker = Walker::new(options.clone());
        let truth = walker.ground_truth();
        let frame_box = Rect::new(0.0, 0.0, options.width as f64, options.height as f64);
        let is_whole = |full: &Rect| {
            full.x >= 0.0 && full.right() <= frame_box.right() && full.bottom() <= frame_box.bottom()
        };
        let is_away = |index: usize| truth[index].is_none() || walker.is_hidden(index);
        let is_seen = |index: usize| !is_away(index) && truth[index].is_some_and(|full| is_whole(&full));
        let leaves = (0..truth.len()).find(|&index| is_away(index)).unwrap();
        let back = (leaves..truth.len()).find(|&index| is_seen(index)).unwrap();
        let away: Vec<bool> = (0..truth.len()).map(is_away).collect();
        let mut parameters = Parameters::default();
        (parameters.seed, parameters.search) = (options.seed, search);
        let mut tracker = InfoPart::new(parameters.check().unwrap());
        let mut index = 0;
        let mut is_found = false;
        while let Some(source) = walker.next_frame().unwrap() {
            let frame = source.frame.view();
            if index == 0 {
                tracker.init(frame, truth[0].unwrap()).unwrap();
            } else {
                let estimate = tracker.update(frame).unwrap();
                let is_claimed = estimate.status == Status::Tracking;
                let overlaps = truth[index].is_some_and(|full| full.overlap(&estimate.box_in_frame) > 0.5);
                is_found |= (back..back + SOON).contains(&index) && is_claimed && overlaps;
                self.without += usize::from(away[index]);
                self.claimed += usize::from(away[index] && is_claimed);
            }
            index += 1;
        }
        self.scenes += 1;
        self.found += usize::from(is_found);
    }

    fn found_share(&self) -> f64 {
        self.found as f64 / self.scenes as f64
    }

    fn claimed_share(&self) -> f64 {
        self.claimed as f64 / self.without as f64
    }
}

fn leaving(companion: Companion) -> WalkerOptions {
    WalkerOptions { frames: 280, absence: Absence::Leaves, companion, ..WalkerOptions::default() }
}

fn cut() -> WalkerOptions {
    WalkerOptions { frames: 150, absence: Absence::Cut, ..WalkerOptions::default() }
}

fn walled(companion: Companion) -> WalkerOptions {
    WalkerOptions { frames: 240, occluder: Occluder::Wall, companion, ..WalkerOptions::default() }
}

fn outcome(scene: &WalkerOptions, seeds: std::ops::RangeInclusive<u64>, search: SearchExtent) -> Outcome {
    let mut outcome = Outcome::default();
    for seed in seeds {
        outcome.add(&WalkerOptions { seed, ..scene.clone() }, search);
    }
    outcome
}

#[test]
#[ignore = "a hundred seeds of each scene take minutes; the table of docs/robustness.md"]
fn table() {
    let scenes = [
        ("leaves and returns at the other side, alone", leaving(Companion::Nobody)),
        ("the same, overtaken by somebody in other clothes", leaving(Companion::Unlike)),
        ("the same, overtaken by somebody dressed alike", leaving(Companion::Alike)),
        ("behind a wall for 60 frames, alone", walled(Companion::Nobody)),
        ("the same, overtaken by somebody in other clothes", walled(Companion::Unlike)),
        ("the same, overtaken by somebody dressed alike", walled(Companion::Alike)),
        ("cut to another street and back", cut()),
    ];
    let seeds = std::env::var("SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(100);
    println!(
        "| scene | search | found within {SOON} frames | called tracking while away |\n| --- | --- | ---: | ---: |"
    );
    for (name, scene) in scenes {
        for search in [SearchExtent::Off, SearchExtent::Frame] {
            let outcome = outcome(&scene, 1..=seeds, search);
            println!(
                "| {name} | {search:?} | {:.0} % | {:.1} % |",
                100.0 * outcome.found_share(),
                100.0 * outcome.claimed_share()
            );
        }
    }
}
