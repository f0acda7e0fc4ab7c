//! A correlation filter that is confined to the target (Galoogahi, Fagg, Lucey 2017) and held to the one before (Li, Tian,
//! Zuo, Zhang, Yang 2018).
//!
//! Over the cells x of a window and its channels c, the filter f minimises
//!   || sum_c f_c * x_c - y ||^2 + mu || f - f_before ||^2,   f = 0 outside the target,
//! y being a Gaussian at the target's centre. "Inside" can leave out cells of the box that are not the target's own
//! (Lukezic, Vojir, Cehovin Zajc, Matas, Kristan 2017).
//!
//! Steps of learning, by the alternating direction method of multipliers with an auxiliary filter g that vanishes outside
//! the target, and scaled multipliers h:
//! 1. f, for each frequency: a linear system of rank one plus a multiple of the identity (Sherman-Morrison),
//! 2. g = f + h inside the target, 0 outside,
//! 3. h += f - g; rho grows; again from 1.
//!
//! The response to cells z is the inverse transform of sum_c conj(g_c) z_c, divided by what the filter answered at the
//! centre of the window it learnt from: 1 means as sure as then.

use realfft::num_complex::Complex32;

use super::{
    response::Response,
    spectrum::{Fourier, PlaneSpectra, Scratch},
    window::Window,
};

/// rho of the first round: how strongly f is held to g.
const RHO: f32 = 1.0;
/// rho of a round / rho of the round before.
const RHO_GROWTH: f32 = 10.0;

/// How a filter is learnt.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct FilterOptions {
    /// Cells along the window's side, even.
    pub side: usize,
    /// Standard deviation of y, as a share of the square root of the target's area.
    pub label_sigma: f64,
    /// mu: how strongly a later filter is held to the one before, >= 0.
    pub temporal: f32,
    /// Rounds of the alternating direction method, >= 1.
    pub rounds: usize,
    /// How much wider and taller than the target the filter may be.
    pub support: f64,
}

/// A filter over windows that a target fills always alike.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct CorrelationFilter {
    options: FilterOptions,
    fourier: Fourier,
    channels: Vec<Channel>,
    /// Spectrum of y.
    label: Vec<Complex32>,
    /// 1 inside the target's box, 0 outside, between at its border.
    in_box: Vec<f32>,
    /// The same, less where cells are not the target's own.
    support: Vec<f32>,
    response: Response,
    learnt: bool,
    /// What the filter answered at the centre of the window it learnt from.
    own_answer: f32,
    /// For each frequency sum_c |x_c|^2.
    energy: Vec<f32>,
    product: Vec<Complex32>,
    image: Vec<f32>,
    scratch: Scratch,
}

/// Spectra of one channel.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Channel {
    f: Vec<Complex32>,
    g: Vec<Complex32>,
    h: Vec<Complex32>,
    /// The filter in use: g of the last learning.
    filter: Vec<Complex32>,
}

impl CorrelationFilter {
    /// A filter over `channels` planes for a target of `width` x `height`, in shares of the window's side.
    pub fn new(options: FilterOptions, channels: usize, width: f64, height: f64) -> Self {
        let side = options.side;
        let fourier = Fourier::new(side);
        let mut scratch = fourier.scratch();
        let zeros = vec![Complex32::default(); fourier.spectrum_length()];
        let channel = Channel { f: zeros.clone(), g: zeros.clone(), h: zeros.clone(), filter: zeros.clone() };
        let sigma = options.label_sigma * (width * height).sqrt() * side as f64;
        let mut label = zeros.clone();
        fourier.forward(&gaussian(side, sigma), &mut label, &mut scratch);
        Self {
            options,
            channels: vec![channel; channels],
            label,
            support: vec![1.0; side * side],
            in_box: support(side, width * options.support, height * options.support),
            response: Response::new(side),
            learnt: false,
            own_answer: 1.0,
            energy: vec![0.0; zeros.len()],
            product: zeros,
            image: vec![0.0; side * side],
            scratch,
            fourier,
        }
    }

    /// The last response.
    pub fn response(&self) -> &Response {
        &self.response
    }

    /// Correlates the filter with a window, given by the spectra of its planes of cells.
    pub fn respond(&mut self, planes: &PlaneSpectra, window: Window) -> &Response {
        self.correlate(planes, window);
        let scale = 1.0 / self.own_answer;
        self.response.values_mut(window).iter_mut().for_each(|value| *value *= scale);
        &self.response
    }

    /// Learns that the target is at the centre of a window, given by the spectra of its planes of cells. `own`, if given, says
    /// how much of each cell the filter may use, in [0, 1], row by row.
    pub fn learn(&mut self, planes: &PlaneSpectra, own: Option<&[f32]>) {
        self.support.copy_from_slice(&self.in_box);
        if let Some(own) = own {
            self.support.iter_mut().zip(own).for_each(|(support, own)| *support *= own);
        }
        self.solve(planes);
        self.correlate(planes, self.response.window());
        self.own_answer = self.response.values()[0].max(1e-6);
    }

    fn correlate(&mut self, planes: &PlaneSpectra, window: Window) {
        self.product.fill(Complex32::default());
        for (Channel { filter, .. }, x) in self.channels.iter().zip(planes.each()) {
            for ((sum, filter), x) in self.product.iter_mut().zip(filter).zip(x) {
                *sum += filter.conj() * x;
            }
        }
        self.fourier.inverse(&self.product, self.response.values_mut(window), &mut self.scratch);
    }

    /// Steps 1 to 3.
    fn solve(&mut self, planes: &PlaneSpectra) {
        let mu = if self.learnt { self.options.temporal } else { 0.0 };
        self.energy.fill(0.0);
        for (Channel { g, h, .. }, x) in self.channels.iter_mut().zip(planes.each()) {
            self.energy.iter_mut().zip(x).for_each(|(energy, x)| *energy += x.norm_sqr());
            g.fill(Complex32::default());
            h.fill(Complex32::default());
        }
        let mut rho = RHO;
        for _ in 0..self.options.rounds {
            self.fit_labels(planes, mu, rho);
            self.confine(planes, mu, rho);
            rho *= RHO_GROWTH;
        }
        for Channel { filter, g, .. } in &mut self.channels {
            filter.copy_from_slice(g);
        }
        self.learnt = true;
    }

    /// Step 1 up to the sum over channels. With q = x conj(y) / T + mu f_before + rho (g - h), T the number of cells,
    ///   f = (q - x (x^H q) / (T (mu + rho) + x^H x)) / (mu + rho):
    /// f holds q, and `product` the fraction.
    fn fit_labels(&mut self, planes: &PlaneSpectra, mu: f32, rho: f32) {
        let area = (self.options.side * self.options.side) as f32;
        self.product.fill(Complex32::default());
        for (Channel { f, g, h, filter }, x) in self.channels.iter_mut().zip(planes.each()) {
            let known = x.iter().zip(&self.label).zip(filter.iter());
            for ((f, ((x, y), before)), (g, h)) in f.iter_mut().zip(known).zip(g.iter().zip(h.iter())) {
                *f = x * y.conj() / area + before * mu + (g - h) * rho;
            }
            for ((sum, x), f) in self.product.iter_mut().zip(x).zip(f.iter()) {
                *sum += x.conj() * f;
            }
        }
        for (sum, energy) in self.product.iter_mut().zip(&self.energy) {
            *sum /= area * (mu + rho) + energy;
        }
    }

    /// The end of step 1, and steps 2 and 3.
    fn confine(&mut self, planes: &PlaneSpectra, mu: f32, rho: f32) {
        let Self { channels, support, fourier, product, image, scratch, .. } = self;
        for (Channel { f, g, h, .. }, x) in channels.iter_mut().zip(planes.each()) {
            for ((f, x), product) in f.iter_mut().zip(x).zip(product.iter()) {
                *f = (*f - x * product) / (mu + rho);
            }
            for ((g, f), h) in g.iter_mut().zip(f.iter()).zip(h.iter()) {
                *g = f + h;
            }
            fourier.inverse(g, image, scratch);
            image.iter_mut().zip(support.iter()).for_each(|(value, support)| *value *= support);
            fourier.forward(image, g, scratch);
            for ((h, f), g) in h.iter_mut().zip(f.iter()).zip(g.iter()) {
                *h += f - g;
            }
        }
    }
}

/// A Gaussian around cell (0, 0), wrapped around the borders.
fn gaussian(side: usize, sigma: f64) -> Vec<f32> {
    let distance = |i: usize| i.min(side - i) as f64;
    (0..side * side)
        .map(|i| {
            let squared = distance(i / side).powi(2) + distance(i % side).powi(2);
            (-0.5 * squared / (sigma * sigma)).exp() as f32
        })
        .collect()
}

/// Cells of a target of `width` x `height` (shares of the side) in the middle of the window. A correlation shifts by
/// the distance between the target in the window and that in the filter, and both are in the middle.
fn support(side: usize, width: f64, height: f64) -> Vec<f32> {
    let inside = |i: usize, share: f64| {
        let from_centre = (i as f64 + 0.5 - side as f64 / 2.0).abs();
        let half = (share * side as f64 / 2.0).max(1.0);
        (half + 0.5 - from_centre).clamp(0.0, 1.0) as f32
    };
    (0..side * side).map(|i| inside(i / side, height) * inside(i % side, width)).collect()
}

#[cfg(test)]
mod tests;
