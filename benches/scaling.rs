//! What the cost of an update follows: the frame's size, the particles, the threads, and what is tracked of the body.
//!
//! `cargo bench --bench scaling` prints a table of ratios; with `-- --quick` one round of each instead of fifteen. The
//! frames lie in memory: nothing is decoded. Every kind of run has its turn in every round, and of each update the shortest
//! time over the rounds counts, since other work on the machine only adds.

use std::{sync::Arc, time::Instant};

use infopart::{
    frame::{Frame, PixelFormat},
    geometry::{Rect, Region},
    sequence::{FrameSource, Walker, WalkerOptions},
    tracker::{InfoPart, Parameters, Tracker},
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const FRAMES: usize = 60;
const ROUNDS: usize = 15;
const LARGE: (usize, usize) = (1280, 720);
/// Where the walker's frame lies in the large one.
const OFFSET: (usize, usize) = (480, 240);

/// Frames and the target's box in the first.
struct Scene {
    frames: Vec<Frame>,
    first_box: Rect,
}

/// The walker.
fn small_scene() -> Scene {
    let mut walker = Walker::new(WalkerOptions { frames: FRAMES, ..WalkerOptions::default() });
    let first_box = walker.ground_truth()[0].expect("the walker is in its first frame");
    let frames = std::iter::from_fn(|| walker.next_frame().expect("the walker renders"));
    Scene { frames: frames.map(|frame| frame.frame).collect(), first_box }
}

/// The same within larger frames of noise.
fn large_scene(small: &Scene) -> Scene {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let around: Vec<u8> = (0..LARGE.0 * LARGE.1 * 3).map(|_| rng.random()).collect();
    let paste = |frame: &Frame| {
        let mut pixels = around.clone();
        for y in 0..frame.height() {
            let row = frame.view().row(y);
            pixels[3 * ((OFFSET.1 + y) * LARGE.0 + OFFSET.0)..][..row.len()].copy_from_slice(row);
        }
        Frame::new(pixels, LARGE.0, LARGE.1, PixelFormat::Rgb).expect("as many bytes as pixels")
    };
    Scene {
        frames: small.frames.iter().map(paste).collect(),
        first_box: small.first_box.translated(OFFSET.0 as f64, OFFSET.1 as f64),
    }
}

/// A kind of run.
struct Run<'a> {
    scene: &'a Scene,
    preset: &'static str,
    region: Region,
    particles: Option<usize>,
    threads: usize,
}

impl<'a> Run<'a> {
    fn of(scene: &'a Scene) -> Self {
        Self { scene, preset: "default", region: Region::Part, particles: None, threads: 1 }
    }

    /// Milliseconds of each update.
    fn time(&self) -> Vec<f64> {
        let mut parameters = Parameters::preset(self.preset).expect("a preset of this name");
        parameters.region = self.region;
        parameters.particles = self.particles.unwrap_or(parameters.particles);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .build()
            .expect("threads can be started");
        let mut tracker = InfoPart::with_pool(parameters.check().expect("all are in range"), Arc::new(pool));
        let Scene { frames, first_box } = self.scene;
        tracker.init(frames[0].view(), *first_box).expect("the walker starts inside the frame");
        let update = |frame: &Frame| {
            let start = Instant::now();
            tracker.update(frame.view()).expect("all frames have one size");
            1e3 * start.elapsed().as_secs_f64()
        };
        frames[1..].iter().map(update).collect()
    }
}

/// Milliseconds of an update of each kind of run.
fn measure<const N: usize>(rounds: usize, runs: [Run<'_>; N]) -> [f64; N] {
    let mut shortest = [const { Vec::new() }; N];
    for _ in 0..rounds {
        for (run, shortest) in runs.iter().zip(&mut shortest) {
            let times = run.time();
            shortest.resize(times.len(), f64::INFINITY);
            shortest.iter_mut().zip(times).for_each(|(least, time)| *least = least.min(time));
        }
    }
    shortest.map(|times: Vec<f64>| times.iter().sum::<f64>() / times.len() as f64)
}

fn main() {
    let flags: Vec<String> = std::env::args().collect();
    if !flags.iter().any(|flag| flag == "--bench") {
        return;
    }
    let rounds = if flags.iter().any(|flag| flag == "--quick") { 1 } else { ROUNDS };
    let small = small_scene();
    let large = large_scene(&small);
    println!("| milliseconds an update | | | ratio |\n| --- | ---: | ---: | ---: |");
    let row = |name: &str, [a, b]: [f64; 2]| println!("| {name} | {a:.3} | {b:.3} | {:.2} |", a / b);

    row("frame of 1280 x 720 / its part of 320 x 240", measure(rounds, [Run::of(&large), Run::of(&small)]));
    for preset in ["default", "paper"] {
        let of = |threads| Run { preset, particles: Some(2000), threads, ..Run::of(&small) };
        row(&format!("1 thread / 2, 2000 particles, {preset}"), measure(rounds, [of(1), of(2)]));
    }
    for preset in ["default", "paper"] {
        let of = |region| Run { preset, region, ..Run::of(&small) };
        row(&format!("part / whole body, {preset}"), measure(rounds, [of(Region::Part), of(Region::Whole)]));
    }
    let counts = [250, 500, 1000, 2000, 4000];
    let times = measure(rounds, counts.map(|count| Run { particles: Some(count), ..Run::of(&small) }));
    println!("\n| particles | milliseconds an update | microseconds for each more |\n| ---: | ---: | ---: |");
    println!("| {} | {:.3} | |", counts[0], times[0]);
    for i in 1..counts.len() {
        let each = 1e3 * (times[i] - times[i - 1]) / (counts[i] - counts[i - 1]) as f64;
        println!("| {} | {:.3} | {each:.2} |", counts[i], times[i]);
    }
}
