//! The background model on frames of 768 x 576: the mixture of every pixel, the mask's clean-up, its blobs.
//!
//! `cargo bench --bench background -- --quick` gives a first impression.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use infopart::{
    background::{BackgroundModel, BackgroundParameters, CleanUp, MaskCleaner},
    frame::{Frame, PixelFormat},
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const WIDTH: usize = 768;
const HEIGHT: usize = 576;
const FRAMES: usize = 30;

/// A still, noisy street with eight bright boxes that move across it.
fn frames() -> Vec<Frame> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let street: Vec<u8> = (0..WIDTH * HEIGHT * 3).map(|_| rng.random_range(60..180)).collect();
    (0..FRAMES)
        .map(|number| {
            let mut pixels: Vec<u8> = street.iter().map(|&value| value + rng.random_range(0..10)).collect();
            for walker in 0..8 {
                let (left, top) = (40 + 80 * walker + 3 * number, 30 + 55 * walker);
                for row in top..top + 90 {
                    pixels[3 * (row * WIDTH + left)..][..3 * 35].fill(230);
                }
            }
            Frame::new(pixels, WIDTH, HEIGHT, PixelFormat::Rgb).expect("as many bytes as pixels")
        })
        .collect()
}

fn stages(c: &mut Criterion) {
    let frames = frames();
    let mut model =
        BackgroundModel::new(BackgroundParameters::default().check().expect("the defaults are valid"));
    let cleaner = MaskCleaner::new(CleanUp::default().check().expect("the defaults are valid"));
    let mut forth_and_back = (0..FRAMES).chain((0..FRAMES).rev()).cycle();
    c.bench_function("background, mixture of 768 x 576 pixels", |b| {
        b.iter(|| {
            let frame = &frames[forth_and_back.next().expect("it never ends")];
            model.apply(black_box(frame.view())).expect("all frames have one size").len()
        });
    });
    let raw = model.mask().clone();
    c.bench_function("background, clean-up of a mask", |b| b.iter(|| cleaner.clean(black_box(&raw))));
    let cleaned = cleaner.clean(&raw);
    c.bench_function("background, blobs of a mask", |b| b.iter(|| cleaner.blobs(black_box(&cleaned))));
}

criterion_group!(background, stages);
criterion_main!(background);
