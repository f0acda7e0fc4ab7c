//! A correlation filter over sizes (Danelljan, Häger, Khan, Felsberg 2014): how large a target is, its centre being known.
//!
//! Steps:
//! 1. the target's box at S sizes about one centre, each `ratio` times the one before, as a lattice of cells: their
//!    oriented gradients, of norm 1, clipped at 0.2, of norm 1 again, and their colour differences, of a norm less; sizes far
//!    from the middle are tapered,
//! 2. learning: running means of these samples, x, and of the spectrum B of their autocorrelation over the sizes,
//! 3. the response to samples z: the spectrum of the correlation of z with x over the sizes, times that of a narrow Gaussian,
//!    over B + lambda; transformed back and divided by what the filter answered to the samples that it learnt last,
//! 4. between the sizes, a cubic.
//!
//! The correlation over the sizes takes the scalar products of all pairs of samples, so that only S numbers are ever
//! transformed.

use std::f64::consts::PI;

use realfft::num_complex::Complex32;

use crate::{
    features::{
        blocks::{BlockIntegrals, LANES},
        hog::BINS,
        region::CHANNELS,
    },
    geometry::Rect,
};

use super::{
    grid::colour_differences, lattice::Lattice, line_transform::LineTransform, response::cubic_weights,
};

/// Numbers a cell has.
const NUMBERS: usize = BINS + CHANNELS;
/// Cells across the target.
const COLUMNS: usize = 4;
/// Largest share that one number may take of the gradients after the first normalisation.
const CLIP: f32 = 0.2;
/// Norm of the colours beside that of the gradients.
const COLOUR_NORM: f32 = 0.7;
/// lambda, as a share of the mean of B.
const REGULARISATION: f32 = 0.01;
/// And at least this, for targets without any texture.
const LEAST_REGULARISATION: f32 = 1e-6;
/// Standard deviation of the response that the filter is to give, in steps of size.
const LABEL_SIGMA: f64 = 1.0;

/// What sizes a filter looks at, and how it learns.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ScaleOptions {
    /// S: sizes, odd, >= 5.
    pub sizes: usize,
    /// A size over the one before, > 1.
    pub ratio: f64,
    /// Share that the latest samples have in the running means, in (0, 1].
    pub rate: f32,
}

/// A filter over sizes.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ScaleFilter {
    options: ScaleOptions,
    /// ln of the ratio of two sizes.
    step: f64,
    lattice: Lattice,
    /// Numbers of a sample.
    length: usize,
    taper: Vec<f32>,
    /// Spectrum of the Gaussian, which is real.
    label: Vec<f32>,
    transform: LineTransform,
    /// The samples of a frame, one size after another.
    samples: Vec<f32>,
    mean: Vec<f32>,
    energy: Vec<f32>,
    spectrum: Vec<Complex32>,
    learnt: bool,
    own_answer: f32,
    /// By shift of size, negative shifts at the end.
    response: Vec<f32>,
    /// Width of the middle size last looked at, frame pixels.
    width: f64,
}

impl ScaleFilter {
    /// A filter for targets of that h / w.
    pub fn new(options: ScaleOptions, aspect: f64) -> Self {
        let sizes = options.sizes;
        let rows = ((COLUMNS as f64 * aspect).round() as usize).clamp(2, 3 * COLUMNS);
        let length = COLUMNS * rows * NUMBERS;
        let mut transform = LineTransform::new(sizes);
        let mut label: Vec<Complex32> = (0..sizes)
            .map(|i| {
                let steps = i.min(sizes - i) as f64 / LABEL_SIGMA;
                Complex32::new((-0.5 * steps * steps).exp() as f32, 0.0)
            })
            .collect();
        transform.forward(&mut label);
        let half = (sizes / 2) as f64;
        Self {
            options,
            step: options.ratio.ln(),
            lattice: Lattice::new(COLUMNS, rows),
            length,
            taper: (0..sizes)
                .map(|i| (0.5 + 0.5 * (PI * (i as f64 - half) / (half + 1.0)).cos()) as f32)
                .collect(),
            label: label.iter().map(|value| value.re).collect(),
            transform,
            samples: vec![0.0; length * sizes],
            mean: vec![0.0; length * sizes],
            energy: vec![0.0; sizes],
            spectrum: vec![Complex32::default(); sizes],
            learnt: false,
            own_answer: 1.0,
            response: vec![0.0; sizes],
            width: 1.0,
        }
    }

    /// Learns that the target has that box.
    pub fn learn(&mut self, integrals: &BlockIntegrals, target: Rect) {
        self.describe(integrals, target);
        let rate = if self.learnt { self.options.rate } else { 1.0 };
        self.learnt = true;
        let Self { samples, mean, .. } = self;
        mean.iter_mut().zip(samples.iter()).for_each(|(mean, sample)| *mean += rate * (sample - *mean));
        correlate(&self.samples, &self.samples, self.length, &mut self.spectrum);
        self.transform.forward(&mut self.spectrum);
        let Self { energy, spectrum, .. } = self;
        energy.iter_mut().zip(spectrum.iter()).for_each(|(mean, new)| *mean += rate * (new.re - *mean));
        self.respond(1.0);
        self.own_answer = self.response[0].max(1e-6);
    }

    /// Looks at the sizes around that of a box, about its centre.
    pub fn look(&mut self, integrals: &BlockIntegrals, target: Rect) {
        self.describe(integrals, target);
        self.width = target.w;
        self.respond(1.0 / self.own_answer);
    }

    /// The response of the last look for a width: about 1 where the target is as learnt. Beyond the sizes inside the
    /// outermost ones it is theirs.
    pub fn at(&self, width: f64) -> f32 {
        let half = (self.options.sizes / 2) as f64;
        let steps = ((width / self.width).ln() / self.step).clamp(1.0 - half, half - 2.0);
        let before = steps.floor();
        let weights = cubic_weights((steps - before) as f32);
        let value = |i: usize| {
            let shift = before as i64 + i as i64 - 1;
            self.response[shift.rem_euclid(self.options.sizes as i64) as usize]
        };
        weights.iter().enumerate().map(|(i, weight)| weight * value(i)).sum()
    }

    /// Step 1.
    fn describe(&mut self, integrals: &BlockIntegrals, target: Rect) {
        let (x, y) = target.centre();
        let half = (self.options.sizes / 2) as i32;
        let sizes = self.samples.chunks_exact_mut(self.length).zip(&self.taper);
        for (number, (sample, taper)) in sizes.enumerate() {
            let scale = self.options.ratio.powi(number as i32 - half);
            let (w, h) = (scale * target.w, scale * target.h);
            let target = Rect::new(x - w / 2.0, y - h / 2.0, w, h);
            describe(&mut self.lattice, integrals, target, sample);
            sample.iter_mut().for_each(|value| *value *= taper);
        }
    }

    /// Step 3.
    fn respond(&mut self, scale: f32) {
        correlate(&self.mean, &self.samples, self.length, &mut self.spectrum);
        self.transform.forward(&mut self.spectrum);
        let sizes = self.options.sizes as f32;
        let lambda = (REGULARISATION * self.energy.iter().sum::<f32>() / sizes).max(LEAST_REGULARISATION);
        for ((value, label), energy) in self.spectrum.iter_mut().zip(&self.label).zip(&self.energy) {
            *value *= label / (energy + lambda);
        }
        self.transform.inverse(&mut self.spectrum);
        for (response, value) in self.response.iter_mut().zip(&self.spectrum) {
            *response = scale * value.re / sizes;
        }
    }
}

/// The lattice over a box as one vector.
fn describe(lattice: &mut Lattice, integrals: &BlockIntegrals, target: Rect, sample: &mut [f32]) {
    let cells = sample.len() / NUMBERS;
    let (gradients, colours) = sample.split_at_mut(cells * BINS);
    lattice.read(integrals, target, |cell, means: &[f32; LANES]| {
        gradients[cell * BINS..][..BINS].copy_from_slice(&means[..BINS]);
        for (plane, value) in colour_differences(means).into_iter().enumerate() {
            colours[plane * cells + cell] = value;
        }
    });
    scale_to(gradients, 1.0);
    gradients.iter_mut().for_each(|value| *value = value.min(CLIP));
    scale_to(gradients, 1.0);
    for plane in colours.chunks_exact_mut(cells) {
        let mean = plane.iter().sum::<f32>() / cells as f32;
        plane.iter_mut().for_each(|value| *value -= mean);
    }
    scale_to(colours, COLOUR_NORM);
}

fn scale_to(values: &mut [f32], norm: f32) {
    let factor = norm / dot(values, values).sqrt().max(1e-6);
    values.iter_mut().for_each(|value| *value *= factor);
}

/// For each shift k the sum over s of <x_s, z_s+k>, around the circle; samples have `length` numbers.
fn correlate(x: &[f32], z: &[f32], length: usize, out: &mut [Complex32]) {
    let sizes = out.len();
    out.fill(Complex32::default());
    for (s, x) in x.chunks_exact(length).enumerate() {
        for (t, z) in z.chunks_exact(length).enumerate() {
            out[(t + sizes - s) % sizes].re += dot(x, z);
        }
    }
}

/// Eight partial sums, so that several products are added at a time.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let (a_rest, b_rest) = (a.chunks_exact(8).remainder(), b.chunks_exact(8).remainder());
    let mut lanes = [0.0; 8];
    for (a, b) in a.chunks_exact(8).zip(b.chunks_exact(8)) {
        for i in 0..8 {
            lanes[i] += a[i] * b[i];
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    lanes.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        features::{reference, region::SearchRegion},
        frame::PixelFormat,
    };

    const OPTIONS: ScaleOptions = ScaleOptions { sizes: 17, ratio: 1.03, rate: 0.025 };

    fn integrals(width: usize, height: usize) -> BlockIntegrals {
        let frame = reference::textured_frame(width, height, PixelFormat::Rgb);
        let mut integrals = BlockIntegrals::default();
        integrals.compute(&frame.view(), SearchRegion { x: 0, y: 0, width, height, step: 1 }, 1);
        integrals
    }

    #[test]
    fn a_target_that_was_learnt_answers_one_at_its_own_size_and_less_at_others() {
        let (integrals, target) = (integrals(120, 160), Rect::new(30.0, 30.0, 40.0, 90.0));
        let mut filter = ScaleFilter::new(OPTIONS, 90.0 / 40.0);
        filter.learn(&integrals, target);
        filter.look(&integrals, target);
        assert!((filter.at(40.0) - 1.0).abs() < 1e-3, "{}", filter.at(40.0));
        for width in [34.0, 36.0, 44.0, 46.0] {
            assert!(filter.at(width) < 0.7, "{width}: {}", filter.at(width));
        }
    }

    #[test]
    fn a_look_from_a_wrong_size_finds_the_right_one() {
        let (integrals, target) = (integrals(120, 160), Rect::new(30.0, 30.0, 40.0, 90.0));
        let mut filter = ScaleFilter::new(OPTIONS, 90.0 / 40.0);
        filter.learn(&integrals, target);
        for steps in [-3, -1, 2, 4] {
            let wrong = OPTIONS.ratio.powi(steps);
            let (w, h) = (wrong * 40.0, wrong * 90.0);
            filter.look(&integrals, Rect::new(50.0 - w / 2.0, 75.0 - h / 2.0, w, h));
            let widths = (0..200).map(|i| 30.0 + 0.1 * f64::from(i));
            let best = widths.max_by(|a, b| filter.at(*a).total_cmp(&filter.at(*b))).unwrap();
            // The taper draws a far peak towards the size it looked from.
            let off = (best / 40.0).ln().abs() / OPTIONS.ratio.ln();
            assert!(off < 0.6 * f64::from(steps.abs()), "{steps}: {best}, {off} steps off");
        }
    }

    #[test]
    fn the_correlation_over_sizes_is_the_naive_one() {
        let (x, z): (Vec<f32>, Vec<f32>) = (0..30).map(|i| (i as f32 - 9.0, (i * i % 7) as f32)).unzip();
        let mut found = vec![Complex32::default(); 3];
        correlate(&x, &z, 10, &mut found);
        for (shift, found) in found.iter().enumerate() {
            let naive: f32 = (0..3)
                .flat_map(|s| (0..10).map(move |k| (s * 10 + k, (s + shift) % 3 * 10 + k)))
                .map(|(i, j)| x[i] * z[j])
                .sum();
            assert!((found.re - naive).abs() < 1e-3 && found.im == 0.0);
        }
    }

    #[test]
    fn nothing_but_flatness_answers_with_a_number() {
        let mut integrals = BlockIntegrals::default();
        let flat = crate::frame::Frame::new(vec![7; 60 * 60], 60, 60, PixelFormat::Gray).unwrap();
        integrals.compute(&flat.view(), SearchRegion { x: 0, y: 0, width: 60, height: 60, step: 1 }, 2);
        let mut filter = ScaleFilter::new(OPTIONS, 2.0);
        filter.learn(&integrals, Rect::new(20.0, 10.0, 15.0, 30.0));
        filter.look(&integrals, Rect::new(500.0, 10.0, 15.0, 30.0));
        assert!(filter.at(15.0).is_finite() && filter.at(1e9).is_finite());
    }
}
