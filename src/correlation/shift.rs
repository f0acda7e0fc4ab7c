//! How far the whole picture moved from one frame to another, as under a camera that turns (phase correlation, Kuglin and Hines 1975).
//!
//! Steps:
//! 1. a frame's outline: the spectrum of `SIDE` x `SIDE` cells of mean luminance, without their mean, tapered towards the border,
//! 2. the cross power of two outlines, each frequency scaled to 1, transformed back: its peak lies at the shift,
//! 3. between the cells, a parabola.

use realfft::num_complex::Complex32;

use crate::frame::FrameView;

use super::spectrum::{Fourier, Scratch};

/// Cells along a side of the picture.
const SIDE: usize = 64;
/// Pixels that are looked at along a cell's side, at most.
const SAMPLES: usize = 3;

/// A frame's outline; nothing at first.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Outline(Vec<Complex32>);

impl Outline {
    /// The sum of the squares of the cells that it came from.
    fn energy(&self) -> f64 {
        // The columns but the first and the last stand for two each.
        let column = |(i, values): (usize, &[Complex32])| {
            let sum: f32 = values.iter().map(|value| value.norm_sqr()).sum();
            f64::from(sum) * if i == 0 || i == SIDE / 2 { 1.0 } else { 2.0 }
        };
        self.0.chunks_exact(SIDE).enumerate().map(column).sum::<f64>() / (SIDE * SIDE) as f64
    }
}

/// Finds shifts. Reused from frame to frame.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ShiftFinder {
    fourier: Fourier,
    scratch: Scratch,
    taper: Vec<f32>,
    image: Vec<f32>,
    product: Vec<Complex32>,
}

impl Default for ShiftFinder {
    fn default() -> Self {
        let fourier = Fourier::new(SIDE);
        let hann = |i: usize| {
            let phase = std::f32::consts::TAU * (i as f32 + 0.5) / SIDE as f32;
            0.5 * (1.0 - phase.cos())
        };
        Self {
            scratch: fourier.scratch(),
            taper: (0..SIDE).map(hann).collect(),
            image: vec![0.0; SIDE * SIDE],
            product: vec![Complex32::default(); fourier.spectrum_length()],
            fourier,
        }
    }
}

impl ShiftFinder {
    /// Puts a frame's outline into `outline` (step 1).
    pub fn outline(&mut self, frame: &FrameView<'_>, outline: &mut Outline) {
        let places = |length: usize| {
            let samples = SAMPLES.min(length.div_ceil(SIDE));
            let count = SIDE * samples;
            (samples, move |i: usize| (2 * i + 1) * length / (2 * count))
        };
        let ((across, x), (down, y)) = (places(frame.width()), places(frame.height()));
        let (bytes, offsets) = (frame.format().bytes_per_pixel(), frame.format().rgb_offsets());
        for (row, cells) in self.image.chunks_exact_mut(SIDE).enumerate() {
            cells.fill(0.0);
            for line in 0..down {
                let pixels = frame.row(y(row * down + line));
                for (column, cell) in cells.iter_mut().enumerate() {
                    let levels = (0..across).map(|i| {
                        let pixel = &pixels[x(column * across + i) * bytes..];
                        offsets.iter().map(|&offset| u32::from(pixel[offset])).sum::<u32>()
                    });
                    *cell += levels.sum::<u32>() as f32;
                }
            }
        }
        let mean = self.image.iter().sum::<f32>() / self.image.len() as f32;
        for (row, cells) in self.image.chunks_exact_mut(SIDE).enumerate() {
            for (cell, taper) in cells.iter_mut().zip(&self.taper) {
                *cell = (*cell - mean) * taper * self.taper[row];
            }
        }
        outline.0.resize(self.fourier.spectrum_length(), Complex32::default());
        self.fourier.forward(&self.image, &mut outline.0, &mut self.scratch);
    }

    /// How much two frames show the same, wherever it moved: the highest correlation of their luminance over all shifts, 1 for the same
    /// frame; 0 where one is all of one colour.
    pub fn similarity(&mut self, from: &Outline, to: &Outline) -> f64 {
        for (product, (from, to)) in self.product.iter_mut().zip(from.0.iter().zip(&to.0)) {
            *product = from.conj() * to;
        }
        self.fourier.inverse(&self.product, &mut self.image, &mut self.scratch);
        let highest = self.image.iter().copied().fold(0.0, f32::max);
        let energy = (from.energy() * to.energy()).sqrt();
        if energy > 0.0 { f64::from(highest) / energy } else { 0.0 }
    }

    /// The shift from one frame to another in shares of the picture's width and height, in [-1/2, 1/2] (steps 2 and 3).
    pub fn between(&mut self, from: &Outline, to: &Outline) -> (f64, f64) {
        for (product, (from, to)) in self.product.iter_mut().zip(from.0.iter().zip(&to.0)) {
            let cross = from.conj() * to;
            *product = cross / cross.norm().max(1e-9);
        }
        self.fourier.inverse(&self.product, &mut self.image, &mut self.scratch);
        self.peak()
    }

    /// Where the image is highest, negative shifts at the end (step 3).
    fn peak(&self) -> (f64, f64) {
        let higher = |best: usize, i: usize| if self.image[i] > self.image[best] { i } else { best };
        let best = (0..self.image.len()).fold(0, higher);
        let (column, row) = (best % SIDE, best / SIDE);
        let at = |column: usize, row: usize| self.image[row % SIDE * SIDE + column % SIDE];
        let here = at(column, row);
        let between = |before: f32, after: f32| {
            let curvature = before - 2.0 * here + after;
            if curvature < 0.0 { f64::from(0.5 * (before - after) / curvature).clamp(-0.5, 0.5) } else { 0.0 }
        };
        let across = between(at(column + SIDE - 1, row), at(column + 1, row));
        let down = between(at(column, row + SIDE - 1), at(column, row + 1));
        let signed = |i: usize| if i >= SIDE / 2 { i as f64 - SIDE as f64 } else { i as f64 };
        ((signed(column) + across) / SIDE as f64, (signed(row) + down) / SIDE as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Frame, PixelFormat};

    /// Blobs of light, moved by (dx, dy).
    fn frame(dx: f64, dy: f64, format: PixelFormat) -> Frame {
        let blob = |x: f64, y: f64, (a, b): (f64, f64)| (-((x - a).powi(2) + (y - b).powi(2)) / 300.0).exp();
        let level = |x: usize, y: usize| {
            let (x, y) = (x as f64 - dx, y as f64 - dy);
            let centres =
                [(60.0, 50.0), (130.0, 90.0), (200.0, 60.0), (240.0, 130.0), (90.0, 140.0), (170.0, 30.0)];
            let sum: f64 = centres.iter().zip(1..).map(|(&at, k)| blob(x, y, at) * 20.0 * f64::from(k)).sum();
            (sum + 20.0) as u8
        };
        let bytes = format.bytes_per_pixel();
        let pixels = (0..320 * 180 * bytes).map(|i| level(i / bytes % 320, i / bytes / 320)).collect();
        Frame::new(pixels, 320, 180, format).unwrap()
    }

    fn outlines(finder: &mut ShiftFinder, frames: [&Frame; 2]) -> [Outline; 2] {
        frames.map(|frame| {
            let mut outline = Outline::default();
            finder.outline(&frame.view(), &mut outline);
            outline
        })
    }

    #[test]
    fn the_shift_of_the_whole_picture_is_found_to_a_part_of_a_cell() {
        let mut finder = ShiftFinder::default();
        for (dx, dy) in [(0.0, 0.0), (12.0, -7.0), (-31.0, 16.0), (3.0, 2.0)] {
            let frames = [&frame(0.0, 0.0, PixelFormat::Rgb), &frame(dx, dy, PixelFormat::Rgb)];
            let [from, to] = outlines(&mut finder, frames);
            let (across, down) = finder.between(&from, &to);
            // Cells of 5 x 2.8 pixels.
            assert!(
                (across * 320.0 - dx).abs() < 2.5 && (down * 180.0 - dy).abs() < 1.5,
                "{dx} {dy}: {across} {down}"
            );
        }
    }

    #[test]
    fn a_picture_is_similar_to_itself_and_moved_and_not_to_another_or_to_none() {
        let mut finder = ShiftFinder::default();
        let first = frame(0.0, 0.0, PixelFormat::Gray);
        let moved = frame(8.0, 4.0, PixelFormat::Gray);
        let pixels =
            (0..320 * 180).map(|i| if (i / 320 / 9 + i % 320 / 16) % 2 == 0 { 30 } else { 220 }).collect();
        let other = Frame::new(pixels, 320, 180, PixelFormat::Gray).unwrap();
        let flat = Frame::new(vec![9; 320 * 180], 320, 180, PixelFormat::Gray).unwrap();
        let mut similarity = |to: &Frame| {
            let [from, to] = outlines(&mut finder, [&first, to]);
            finder.similarity(&from, &to)
        };
        assert!((similarity(&first) - 1.0).abs() < 1e-4);
        assert!(similarity(&moved) > 0.85);
        assert!(similarity(&other) < 0.5);
        assert_eq!(similarity(&flat), 0.0);
    }

    #[test]
    fn tiny_frames_have_outlines_too() {
        let mut finder = ShiftFinder::default();
        let dot = Frame::new(vec![50], 1, 1, PixelFormat::Gray).unwrap();
        let [from, to] = outlines(&mut finder, [&dot, &dot]);
        assert_eq!(finder.similarity(&from, &to), 0.0);
        let (across, down) = finder.between(&from, &to);
        assert!(across.is_finite() && down.is_finite());
    }
}
