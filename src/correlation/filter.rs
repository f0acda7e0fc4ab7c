//! A correlation filter learnt with spatial and temporal regularisation (Li, Tian, Zuo, Zhang, Yang 2018, STRCF; the
//! constraint to the target of Galoogahi, Fagg, Lucey 2017).
//!
//! The filter f minimises ||sum_c f_c * x_c - y||^2 + sum_c ||w f_c||^2 + mu ||f - f_before||^2 over the window's cells x,
//! y being a Gaussian at the target's centre and w large outside the target.
//!
//! Steps of learning (ADMM, with an auxiliary filter g and scaled multipliers h):
//! 1. f: for each frequency a linear system of rank one plus a multiple of the identity, solved by Sherman-Morrison,
//! 2. g = (w^2 + rho)^-1 rho (f + h), in the window,
//! 3. h += f - g, rho grows; again from 1.
//!
//! The response to other cells z is the inverse transform of sum_c conj(f_c) z_c.

use rayon::prelude::*;
use realfft::num_complex::Complex32;

use super::{
    window::Window,
    response::Response,
    spectrum::{Fourier, Scratch},
};

/// How a filter is learnt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilterOptions {
    /// Cells along the window's side, even.
    pub side: usize,
    /// Standard deviation of y, as a share of the square root of the target's area.
    pub label_sigma: f64,
    /// mu: how strongly a later filter is held to the one before.
    pub temporal: f32,
    /// Rounds of ADMM.
    pub rounds: usize,
    /// rho of the first round.
    pub rho: f32,
    /// rho grows by this.
    pub growth: f32,
    /// How much wider and taller than the target the filter may be.
    pub support: f64,
}


/// A filter over windows of one shape.
pub struct CorrelationFilter {
    options: FilterOptions,
    fourier: Fourier,
    channels: Vec<Channel>,
    /// Spectrum of y.
    label: Vec<Complex32>,
    /// 1 inside the target, 0 outside.
    support: Vec<f32>,
    response: Response,
    learnt: bool,
    /// The response to what was learnt last, before scaling.
    own: f32,
    energy: Vec<f32>,
    product: Vec<Complex32>,
    scratch: Scratch,
}

/// What a channel needs.
#[derive(Clone)]
struct Channel {
    x: Vec<Complex32>,
    f: Vec<Complex32>,
    before: Vec<Complex32>,
    g: Vec<Complex32>,
    h: Vec<Complex32>,
    image: Vec<f32>,
    scratch: Scratch,
}

impl CorrelationFilter {
    /// A filter for a target of `width` x `height`, in shares of the window's side.
    pub fn new(options: FilterOptions, channels: usize, width: f64, height: f64) -> Self {
        let side = options.side;
        let fourier = Fourier::new(side);
        let length = fourier.spectrum_length();
        let mut scratch = fourier.scratch();
        let zeros = vec![Complex32::default(); length];
        let channel = Channel {
            x: zeros.clone(),
            f: zeros.clone(),
            before: zeros.clone(),
            g: zeros.clone(),
            h: zeros.clone(),
            image: vec![0.0; side * side],
            scratch: fourier.scratch(),
        };
        let sigma = options.label_sigma * (width * height).sqrt() * side as f64;
        let mut label = zeros.clone();
        fourier.forward(&gaussian(side, sigma), &mut label, &mut scratch);
        Self {
            options,
            channels: vec![channel; channels],
            label,
            support: support(side, width * options.support, height * options.support),
            response: Response::new(side),
            learnt: false,
            own: 1.0,
            energy: vec![0.0; length],
            product: zeros,
            scratch,
            fourier,
        }
    }

    /// The last response.
    pub fn response(&self) -> &Response {
        &self.response
    }

    /// Correlates a window of the frame with the filter.
    pub fn respond(&mut self, planes: &[f32], window: Window) -> &Response {
        self.transform(planes);
        self.correlate(window);
        let scale = 1.0 / self.own;
        self.response.values_mut(window).iter_mut().for_each(|value| *value *= scale);
        &self.response
    }

    fn correlate(&mut self, window: Window) {
        self.product.fill(Complex32::default());
        for channel in &self.channels {
            for ((sum, f), x) in self.product.iter_mut().zip(&channel.before).zip(&channel.x) {
                *sum += f.conj() * x;
            }
        }
        self.fourier.inverse(&self.product, self.response.values_mut(window), &mut self.scratch);
    }

    /// Learns that the target is at the centre of a window of the frame.
    pub fn learn(&mut self, planes: &[f32]) {
        self.transform(planes);
        self.solve();
        self.correlate(self.response.window());
        self.own = self.response.values()[0].max(1e-6);
    }

    fn transform(&mut self, planes: &[f32]) {
        let (fourier, area) = (&self.fourier, self.options.side * self.options.side);
        self.channels.par_iter_mut().zip(planes.par_chunks(area)).with_min_len(8).for_each(
            |(channel, plane)| fourier.forward(plane, &mut channel.x, &mut channel.scratch),
        );
    }

    /// Steps 1 to 3.
    fn solve(&mut self) {
        let area = (self.options.side * self.options.side) as f32;
        let mu = if self.learnt { self.options.temporal } else { 0.0 };
        self.energy.fill(0.0);
        for channel in &mut self.channels {
            for (energy, x) in self.energy.iter_mut().zip(&channel.x) {
                *energy += x.norm_sqr();
            }
            channel.g.fill(Complex32::default());
            channel.h.fill(Complex32::default());
        }
        let mut rho = self.options.rho;
        for round in 0..self.options.rounds {
            let ridge = area * (mu + rho);
            // q = x conj(y) / T + mu before + rho (g - h); f = (q - x (x^H q) / (T (mu + rho) + x^H x)) / (mu + rho).
            self.product.fill(Complex32::default());
            for channel in &mut self.channels {
                let Channel { x, f, before, g, h, .. } = channel;
                for (k, sum) in self.product.iter_mut().enumerate() {
                    let q = x[k] * self.label[k].conj() / area + before[k] * mu + (g[k] - h[k]) * rho;
                    f[k] = q;
                    *sum += x[k].conj() * q;
                }
            }
            for (sum, energy) in self.product.iter_mut().zip(&self.energy) {
                *sum /= ridge + energy;
            }
            let last = round + 1 == self.options.rounds;
            let (product, support, fourier) = (&self.product, &self.support, &self.fourier);
            self.channels.par_iter_mut().with_min_len(8).for_each(|channel| {
                let Channel { x, f, g, h, image, scratch, .. } = channel;
                for (k, f) in f.iter_mut().enumerate() {
                    *f = (*f - x[k] * product[k]) / (mu + rho);
                    g[k] = *f + h[k];
                }
                fourier.inverse(g, image, scratch);
                image.iter_mut().zip(support).for_each(|(value, support)| *value *= support);
                fourier.forward(image, g, scratch);
                if !last {
                    for ((h, f), g) in h.iter_mut().zip(f.iter()).zip(g.iter()) {
                        *h += f - g;
                    }
                }
            });
            rho = rho * self.options.growth;
        }
        for channel in &mut self.channels {
            channel.before.copy_from_slice(&channel.g);
        }
        self.learnt = true;
    }
}

fn gaussian(side: usize, sigma: f64) -> Vec<f32> {
    let distance = |i: usize| i.min(side - i) as f64;
    (0..side * side)
        .map(|i| {
            let squared = distance(i / side).powi(2) + distance(i % side).powi(2);
            (-0.5 * squared / (sigma * sigma)).exp() as f32
        })
        .collect()
}

/// 1 for the cells of a target of `width` x `height` (shares of the side) at the window's centre, which is where
/// the middle of the window is and not shift 0: the filter is correlated, so its own centre is the window's.
fn support(side: usize, width: f64, height: f64) -> Vec<f32> {
    let inside = |i: usize, share: f64| {
        let from_centre = (i as f64 + 0.5 - side as f64 / 2.0).abs();
        let half = (share * side as f64 / 2.0).max(1.0);
        (half + 0.5 - from_centre).clamp(0.0, 1.0) as f32
    };
    (0..side * side).map(|i| inside(i / side, height) * inside(i % side, width)).collect()
}
