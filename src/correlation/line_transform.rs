//! The Fourier transform of lines of complex numbers of one length.

use std::sync::Arc;

use realfft::num_complex::Complex32;
use rustfft::{Fft, FftPlanner};

/// Transforms lines in their places.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "save", serde(from = "usize", into = "usize"))]
pub(super) struct LineTransform {
    length: usize,
    forward: Arc<dyn Fft<f32>>,
    inverse: Arc<dyn Fft<f32>>,
    scratch: Vec<Complex32>,
}

impl LineTransform {
    /// Plans for `length` numbers, at least 1.
    pub fn new(length: usize) -> Self {
        let mut planner = FftPlanner::new();
        let (forward, inverse) = (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
        let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
        Self { length, forward, inverse, scratch: vec![Complex32::default(); scratch] }
    }

    /// The spectrum of a line.
    pub fn forward(&mut self, line: &mut [Complex32]) {
        self.forward.process_with_scratch(line, &mut self.scratch);
    }

    /// The line of a spectrum, times the number of its numbers.
    pub fn inverse(&mut self, spectrum: &mut [Complex32]) {
        self.inverse.process_with_scratch(spectrum, &mut self.scratch);
    }
}

impl From<usize> for LineTransform {
    fn from(length: usize) -> Self {
        Self::new(length)
    }
}

impl From<LineTransform> for usize {
    fn from(transform: LineTransform) -> Self {
        transform.length
    }
}
