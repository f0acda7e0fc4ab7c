//! The street: a wall with windows, a hedge, pavement, and things that look a little like the person.

use std::f32::consts::FRAC_PI_2;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    canvas::{Canvas, Colour, Shape, lit, mixed},
    figure::{Clothes, Pose, WALKER, draw},
};

/// Where the wall meets the pavement, of a frame 240 pixels high.
const KERB: f32 = 122.0;

const MORTAR: Colour = [150.0, 142.0, 134.0];
const BRICK: Colour = [164.0, 122.0, 100.0];
const GLASS: Colour = [70.0, 86.0, 104.0];
const FRAME: Colour = [214.0, 208.0, 196.0];
const LEAF: Colour = [66.0, 100.0, 52.0];
const STONE: Colour = [158.0, 154.0, 146.0];
const BARK: Colour = [92.0, 74.0, 58.0];

/// Paints a street of `width` x `height` pixels; `unit` is 1 for frames 240 pixels high.
pub(super) fn street(width: usize, height: usize, unit: f32, rng: &mut ChaCha8Rng) -> Canvas {
    let mut canvas = Canvas::new(width, height);
    let salt = rng.random();
    paint_ground(&mut canvas, unit, salt);
    paint_windows(&mut canvas, unit, rng);
    paint_hedge(&mut canvas, unit, rng);
    paint_pillars(&mut canvas, unit, rng);
    paint_bystanders(&mut canvas, unit, rng);
    canvas
}

/// Paints a tree trunk between two edges, from top to bottom of the frame.
pub(super) fn trunk(canvas: &mut Canvas, (left, right): (f32, f32), unit: f32, seed: u64) {
    let bottom = canvas.height as f32 + 2.0;
    let shape = Shape::Rectangle { min: (left, -2.0), max: (right, bottom) };
    let salt = seed as u32;
    canvas.fill(&shape, 1.0, |(x, y)| {
        let (along, across) = (y / unit, (x - left) / unit);
        let ridges = noise(across / 3.2 + noise(along / 17.0, across / 9.0, salt), along / 26.0, salt ^ 1);
        let round = 1.0 - 0.45 * (2.0 * (x - left) / (right - left) - 0.8).powi(2);
        lit(BARK, round * (0.55 + 0.8 * ridges))
    });
}

fn paint_ground(canvas: &mut Canvas, unit: f32, salt: u32) {
    let width = canvas.width;
    for (index, pixel) in canvas.pixels.iter_mut().enumerate() {
        let (x, y) = ((index % width) as f32 / unit, (index / width) as f32 / unit);
        let rough = 0.82 + 0.22 * noise(x / 23.0, y / 17.0, salt) + 0.14 * noise(x / 3.0, y / 2.5, salt ^ 7);
        *pixel = lit(if y < KERB { bricks(x, y, salt) } else { slabs(x, y - KERB, salt) }, rough);
    }
}

fn bricks(x: f32, y: f32, salt: u32) -> Colour {
    let course = (y / 7.0).floor();
    let along = x / 15.0 + 0.5 * course.rem_euclid(2.0);
    let in_mortar = (y / 7.0).rem_euclid(1.0) < 0.17 || along.rem_euclid(1.0) < 0.08;
    if in_mortar { MORTAR } else { lit(BRICK, 0.82 + 0.36 * hash(along.floor() as i32, course as i32, salt)) }
}

/// How far the vanishing point of the slabs' joints lies above the kerb.
const VANISHING: f32 = 60.0;

/// Slabs grow towards the viewer, and their joints meet far away.
fn slabs(x: f32, below: f32, salt: u32) -> Colour {
    if below < 4.0 {
        return lit(STONE, if below < 1.2 { 0.6 } else { 1.12 });
    }
    let depth = (below + 12.0).ln() * 5.5;
    let along = 2.4 * (x - 215.0) / (below + VANISHING);
    let in_joint = depth.fract() < 0.09 || along.rem_euclid(1.0) < 0.035;
    let tone = 0.86 + 0.2 * hash(along.floor() as i32, depth.floor() as i32, salt ^ 3);
    lit(STONE, if in_joint { 0.66 } else { tone })
}

fn paint_windows(canvas: &mut Canvas, unit: f32, rng: &mut ChaCha8Rng) {
    let mut x = rng.random_range(6.0..30.0) * unit;
    while x < canvas.width as f32 {
        let (w, top, bottom) = (rng.random_range(24.0..38.0) * unit, 18.0 * unit, 74.0 * unit);
        let tint = rng.random_range(0.8..1.5);
        let frame = Shape::Rectangle { min: (x, top), max: (x + w, bottom) };
        canvas.fill(&frame, 1.0, |_| FRAME);
        for pane in 0..4 {
            let (column, row) = ((pane % 2) as f32, (pane / 2) as f32);
            let (left, up) = (x + w * (0.07 + 0.46 * column), top + (bottom - top) * (0.04 + 0.48 * row));
            let shape =
                Shape::Rectangle { min: (left, up), max: (left + 0.4 * w, up + 0.44 * (bottom - top)) };
            canvas.fill(&shape, 1.0, |(px, py)| {
                lit(GLASS, tint * (0.8 + 0.4 * ((px + py) / (9.0 * unit)).sin().abs()))
            });
        }
        x += w + rng.random_range(26.0..60.0) * unit;
    }
}

fn paint_hedge(canvas: &mut Canvas, unit: f32, rng: &mut ChaCha8Rng) {
    for _ in 0..(canvas.width as f32 / unit * 3.2) as usize {
        let x = rng.random_range(0.0..canvas.width as f32);
        let swell = 5.0 * (x / (31.0 * unit)).sin() + 3.0 * (x / (11.0 * unit)).sin();
        let y = (KERB - rng.random_range(0.0..(18.0 + swell))) * unit;
        let colour =
            mixed(lit(LEAF, rng.random_range(0.55..1.35)), [120.0, 124.0, 60.0], rng.random_range(0.0..0.3));
        let shape = Shape::Ellipse {
            centre: (x, y),
            rx: rng.random_range(1.5..3.6) * unit,
            ry: rng.random_range(1.2..2.6) * unit,
        };
        canvas.fill(&shape, 0.9, |_| colour);
    }
}

/// Striped posts in the person's own colours.
fn paint_pillars(canvas: &mut Canvas, unit: f32, rng: &mut ChaCha8Rng) {
    for place in 0..4 {
        let x = canvas.width as f32 * (0.14 + 0.25 * place as f32) + rng.random_range(-10.0..10.0) * unit;
        let foot = rng.random_range(136.0..150.0) * unit;
        let (tall, half) = (rng.random_range(62.0..78.0) * unit, rng.random_range(4.5..7.0) * unit);
        let knob = Shape::Ellipse { centre: (x, foot - tall), rx: 0.85 * half, ry: 1.05 * half };
        let post = Shape::Capsule { a: (x, foot - tall + 1.8 * half), b: (x, foot), ra: half, rb: half };
        let shadow = Shape::Ellipse { centre: (x - half, foot + 0.5 * half), rx: 2.6 * half, ry: 0.5 * half };
        canvas.fill(&shadow, 0.35, |_| [30.0, 30.0, 36.0]);
        canvas.fill(&knob, 1.0, |_| [196.0, 156.0, 128.0]);
        canvas.fill(&post, 1.0, |(px, py)| {
            let up = (foot - py) / tall;
            let stripe = ((foot - py) / (3.4 * unit)).floor() as i32 % 2 == 0;
            let colour = if up < 0.42 { WALKER.trousers } else { WALKER.shirt[usize::from(stripe)] };
            lit(mixed(colour, STONE, 0.25), 1.0 - 0.3 * ((px - x) / half).powi(2))
        });
    }
}

/// People who stand about, in other clothes.
fn paint_bystanders(canvas: &mut Canvas, unit: f32, rng: &mut ChaCha8Rng) {
    let shirts = [[[46.0, 110.0, 96.0], [200.0, 206.0, 190.0]], [[188.0, 66.0, 52.0], [120.0, 118.0, 128.0]]];
    for (place, shirt) in shirts.into_iter().enumerate() {
        let x = canvas.width as f32 * (0.28 + 0.49 * place as f32) + rng.random_range(-10.0..10.0) * unit;
        let foot = (x, rng.random_range(140.0..152.0) * unit);
        let (height, phase) = (rng.random_range(70.0..80.0) * unit, FRAC_PI_2 + rng.random_range(-0.3..0.3));
        let pose = Pose { foot, height, phase, swing: 0.3 };
        let clothes = Clothes { shirt, trousers: [70.0, 66.0, 78.0], hair: [88.0, 66.0, 44.0] };
        draw(canvas, &pose, &clothes);
    }
}

/// Smooth noise in [0, 1] whose features are about 1 wide.
fn noise(x: f32, y: f32, salt: u32) -> f32 {
    let (x0, y0) = (x.floor(), y.floor());
    let ease = |f: f32| f * f * (3.0 - 2.0 * f);
    let (fx, fy) = (ease(x - x0), ease(y - y0));
    let corner = |dx: i32, dy: i32| hash(x0 as i32 + dx, y0 as i32 + dy, salt);
    let (upper, lower) = (
        corner(0, 0) + fx * (corner(1, 0) - corner(0, 0)),
        corner(0, 1) + fx * (corner(1, 1) - corner(0, 1)),
    );
    upper + fy * (lower - upper)
}

/// A number in [0, 1] that looks random but belongs to its place.
fn hash(x: i32, y: i32, salt: u32) -> f32 {
    let mut bits = (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77) ^ salt;
    for (shift, factor) in [(16, 0x7FEB_352D), (15, 0x846C_A68B)] {
        bits = (bits ^ (bits >> shift)).wrapping_mul(factor);
    }
    (bits ^ (bits >> 16)) as f32 / u32::MAX as f32
}
