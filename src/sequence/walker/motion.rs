//! How the person, the camera and the light move.

use std::f64::consts::{PI, TAU};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Absence, Occluder, WalkerOptions, figure::ASPECT};
use crate::geometry::Rect;

/// The walk takes this many frames from side to side; shorter sequences stop on the way.
const FRAMES_OF_A_WALK: usize = 150;

/// Height of the standing person at the start, of a frame 240 pixels high.
const HEIGHT: f64 = 84.0;

/// Where the ground meets the horizon and how far below it the person first stands, in the same measure.
const HORIZON: f64 = 62.0;
const BELOW_HORIZON: f64 = 106.0;

/// Two steps, in body heights.
const STRIDE: f64 = 0.72;

/// How much faster than the street the occluder moves, being nearer.
const PARALLAX: f64 = 1.25;

/// When the person is behind the occluder, as a share of the walk.
const OCCLUDED_AT: f64 = 0.56;

/// How many frames the person's box is wholly behind a tree.
const OCCLUDED_FRAMES: f64 = 7.0;

/// How many frames the person's box is wholly behind a wall.
const WALLED_FRAMES: f64 = 60.0;

/// The frame from which on the person is about to go away.
const LEAVES_AT: usize = 60;

/// How far somebody in a hurry walks in a frame, in widths of the frame.
const HURRY: f64 = 0.0125;

/// How much lower or higher somebody comes back at most, of a frame 240 pixels high.
const OTHER_WAY: f64 = 20.0;

/// How far behind somebody who overtakes starts, and how much farther that one walks in a frame, in widths of the frame; and how
/// much higher that one stands, of a frame 240 pixels high.
const OVERTAKES: (f64, f64, f64) = (0.25, 0.004, 5.0);

/// Width of a young tree by the width of the person's box.
const YOUNG_TREE: f64 = 0.3;

/// One frame's state of the world. Lengths in pixels of the frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    /// Where the camera's window lies in the scene.
    pub(super) camera: (f64, f64),
    /// Where the person stands in the frame.
    pub(super) foot: (f64, f64),
    /// The person's height.
    pub(super) height: f64,
    /// Angle in the cycle of two steps, radians.
    pub(super) phase: f64,
    /// Brightness: 1 is full light.
    pub(super) gain: f64,
    /// Left and right edge of the occluder.
    pub(super) occluder: Option<(f64, f64)>,
    /// Whether the person is not in the picture.
    pub(super) is_away: bool,
    /// Where somebody who overtakes stands in the frame.
    pub(super) companion: (f64, f64),
}

impl Moment {
    /// The box of the standing person.
    pub(super) fn box_in_frame(&self) -> Rect {
        let width = ASPECT * self.height;
        Rect::new(self.foot.0 - width / 2.0, self.foot.1 - self.height, width, self.height)
    }
}

/// What the camera may move to the right and what it may shake, pixels.
pub(super) fn camera_reach(options: &WalkerOptions) -> (f64, f64) {
    let unit = unit(options);
    (0.3 * options.width as f64 + 12.0 * unit, 8.0 * unit)
}

/// Pixels of a length that is 1 in a frame 240 pixels high.
pub(super) fn unit(options: &WalkerOptions) -> f64 {
    options.height as f64 / 240.0
}

/// Every frame's state.
pub(super) fn moments(options: &WalkerOptions) -> Vec<Moment> {
    let last = options.frames.max(FRAMES_OF_A_WALK) - 1;
    let occluder_width = occluder_width(options, last);
    let mut phase = 0.6;
    let mut walked = None;
    let plot = Plot::new(options);
    (0..options.frames)
        .map(|index| {
            let t = index as f64 / last as f64;
            let (height, camera) = (height(options, t), camera(options, t));
            let (foot, is_away) = plot.at(options, index, foot(options, t), ASPECT * height);
            let street = foot.0 + camera.0;
            phase += TAU * (street - walked.unwrap_or(street)) / (STRIDE * height);
            walked = Some(street);
            let occluder = (options.occluder != Occluder::None).then(|| {
                let centre = occluder_centre(options, t);
                (centre - occluder_width / 2.0, centre + occluder_width / 2.0)
            });
            let (behind, ahead, higher) = OVERTAKES;
            let overtaken = (ahead * index as f64 - behind) * options.width as f64;
            let companion =
                (self::foot(options, t).0 + overtaken, self::foot(options, t).1 - higher * unit(options));
            let gain = 0.825 + 0.175 * (TAU * t).cos();
            Moment { camera, foot, height, phase, gain, occluder, is_away, companion }
        })
        .collect()
}

/// When and how the person goes away and comes back.
struct Plot {
    absence: Absence,
    /// Frames away.
    away: usize,
    /// How much lower the person comes back, pixels.
    lower: f64,
}

impl Plot {
    fn new(options: &WalkerOptions) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(options.seed ^ 0xA5A5);
        let away = match options.absence {
            Absence::Never => 0,
            Absence::Leaves => rng.random_range(40..=100),
            Absence::Cut => rng.random_range(30..=60),
        };
        let lower = rng.random_range(-OTHER_WAY..=OTHER_WAY) * unit(options);
        Self { absence: options.absence, away, lower }
    }

    /// Where the person of that width stands who would walk at `foot`, and whether away.
    fn at(&self, options: &WalkerOptions, index: usize, foot: (f64, f64), width: f64) -> ((f64, f64), bool) {
        let Some(since) = index.checked_sub(LEAVES_AT) else { return (foot, false) };
        match self.absence {
            Absence::Never => (foot, false),
            Absence::Cut => (foot, since < self.away),
            Absence::Leaves => {
                let hurry = HURRY * options.width as f64;
                let last = options.frames.max(FRAMES_OF_A_WALK) - 1;
                let from = self::foot(options, LEAVES_AT as f64 / last as f64).0;
                let out = ((options.width as f64 + width - from) / hurry).ceil() as usize;
                match since.checked_sub(out + self.away) {
                    None => ((from + hurry * since as f64, foot.1), since >= out),
                    Some(back) => ((hurry * back as f64 - width, foot.1 + self.lower), false),
                }
            }
        }
    }
}

fn growth(t: f64) -> f64 {
    1.0 + 0.35 * t * t * (3.0 - 2.0 * t)
}

fn height(options: &WalkerOptions, t: f64) -> f64 {
    unit(options) * HEIGHT * growth(t)
}

fn foot(options: &WalkerOptions, t: f64) -> (f64, f64) {
    let across = t + 0.05 * (TAU * t).sin();
    (options.width as f64 * (0.15 + 0.67 * across), unit(options) * (HORIZON + BELOW_HORIZON * growth(t)))
}

fn camera(options: &WalkerOptions, t: f64) -> (f64, f64) {
    let unit = unit(options);
    let pan = 0.3 * options.width as f64 * t
        + unit * (4.0 + 3.0 * (3.4 * PI * t).sin() + 0.5 * (23.0 * TAU * t).sin());
    (pan, unit * (4.0 + 1.8 * (2.3 * TAU * t).sin() + 0.5 * (17.0 * TAU * t + 1.0).sin()))
}

fn occluder_centre(options: &WalkerOptions, t: f64) -> f64 {
    let moved = camera(options, t).0 - camera(options, OCCLUDED_AT).0;
    foot(options, OCCLUDED_AT).0 - PARALLAX * moved
}

fn occluder_width(options: &WalkerOptions, last: usize) -> f64 {
    let person = ASPECT * height(options, OCCLUDED_AT);
    if options.occluder == Occluder::YoungTree {
        return YOUNG_TREE * person;
    }
    let hidden = if options.occluder == Occluder::Wall { WALLED_FRAMES } else { OCCLUDED_FRAMES };
    let half = hidden / 2.0 / last as f64;
    let (before, after) = (OCCLUDED_AT - half, OCCLUDED_AT + half);
    let passed = |t| foot(options, t).0 - occluder_centre(options, t);
    person + passed(after) - passed(before)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(occluder: Occluder) -> Vec<Moment> {
        moments(&WalkerOptions { occluder, ..WalkerOptions::default() })
    }

    #[test]
    fn size_and_light_change_as_promised() {
        let moments = all(Occluder::None);
        let (first, last) = (moments[0], moments[149]);
        assert!((first.height - 84.0).abs() < 1e-9 && (last.height / first.height - 1.35).abs() < 1e-9);
        let darkest = moments.iter().map(|moment| moment.gain).fold(1.0, f64::min);
        assert!((darkest - 0.65).abs() < 1e-3 && first.gain == 1.0 && (last.gain - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_person_stays_in_the_frame_and_walks_without_jumps() {
        let moments = all(Occluder::None);
        for pair in moments.windows(2) {
            let (before, after) = (pair[0].box_in_frame(), pair[1].box_in_frame());
            assert!(after.x > 0.0 && after.y > 0.0 && after.right() < 320.0 && after.bottom() < 240.0);
            assert!(after.centre_distance(&before) < 3.0 && pair[1].phase > pair[0].phase);
        }
        let steps = (moments[149].phase - moments[0].phase) / PI;
        assert!((6.0..12.0).contains(&steps), "{steps} steps");
    }

    #[test]
    fn a_tree_hides_the_box_for_a_few_frames() {
        let hidden = all(Occluder::Tree).into_iter().filter(|moment| {
            let (left, right) = moment.occluder.unwrap();
            let box_in_frame = moment.box_in_frame();
            left <= box_in_frame.x && box_in_frame.right() <= right
        });
        assert!((6..=8).contains(&hidden.count()));
        let young = all(Occluder::YoungTree);
        let crossed = young.into_iter().filter(|moment| {
            let (left, right) = moment.occluder.unwrap();
            let box_in_frame = moment.box_in_frame();
            assert!(right - left < 0.45 * box_in_frame.w * 84.0 * 1.35 / moment.height);
            box_in_frame.x <= left && right <= box_in_frame.right()
        });
        assert!((5..=20).contains(&crossed.count()));
        assert!(all(Occluder::None).iter().all(|moment| moment.occluder.is_none()));
    }

    #[test]
    fn a_short_sequence_walks_no_faster() {
        let short =
            moments(&WalkerOptions { frames: 10, occluder: Occluder::Tree, ..WalkerOptions::default() });
        assert_eq!(short.len(), 10);
        assert_eq!(short[9].box_in_frame(), all(Occluder::Tree)[9].box_in_frame());
    }
}
