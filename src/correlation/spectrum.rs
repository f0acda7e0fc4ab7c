//! The Fourier transform of real square images. A spectrum has the half of the columns that the rest follows from, one
//! column after another, so that both passes read memory in order.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex, num_complex::Complex32};
use rustfft::{Fft, FftPlanner};

/// Transforms images of one side.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "save", serde(from = "usize", into = "usize"))]
pub struct Fourier {
    side: usize,
    rows_forward: Arc<dyn RealToComplex<f32>>,
    rows_inverse: Arc<dyn ComplexToReal<f32>>,
    columns_forward: Arc<dyn Fft<f32>>,
    columns_inverse: Arc<dyn Fft<f32>>,
}

/// What one transform at a time works on.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Scratch {
    row: Vec<f32>,
    half_row: Vec<Complex32>,
    columns: Vec<Complex32>,
    inner: Vec<Complex32>,
}

impl From<usize> for Fourier {
    fn from(side: usize) -> Self {
        Self::new(side)
    }
}

impl From<Fourier> for usize {
    fn from(fourier: Fourier) -> Self {
        fourier.side
    }
}

impl Fourier {
    /// Plans for `side` x `side` pixels; `side` must be even.
    pub fn new(side: usize) -> Self {
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        Self {
            side,
            rows_forward: real.plan_fft_forward(side),
            rows_inverse: real.plan_fft_inverse(side),
            columns_forward: complex.plan_fft_forward(side),
            columns_inverse: complex.plan_fft_inverse(side),
        }
    }

    /// Pixels along a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Numbers in a spectrum.
    pub fn spectrum_length(&self) -> usize {
        self.side * self.columns()
    }

    /// Scratch for one thread.
    pub fn scratch(&self) -> Scratch {
        let inner = [
            self.rows_forward.get_scratch_len(),
            self.rows_inverse.get_scratch_len(),
            self.columns_forward.get_inplace_scratch_len(),
            self.columns_inverse.get_inplace_scratch_len(),
        ];
        Scratch {
            row: vec![0.0; self.side],
            half_row: vec![Complex32::default(); self.columns()],
            columns: vec![Complex32::default(); self.spectrum_length()],
            inner: vec![Complex32::default(); inner.into_iter().max().unwrap_or(0)],
        }
    }

    fn columns(&self) -> usize {
        self.side / 2 + 1
    }

    /// The spectrum of an image.
    pub fn forward(&self, image: &[f32], spectrum: &mut [Complex32], scratch: &mut Scratch) {
        let Scratch { row, half_row, inner, .. } = scratch;
        for (y, pixels) in image.chunks_exact(self.side).enumerate() {
            row.copy_from_slice(pixels);
            // The lengths are those of the plan, so this cannot fail.
            let _ = self.rows_forward.process_with_scratch(row, half_row, inner);
            for (x, value) in half_row.iter().enumerate() {
                spectrum[x * self.side + y] = *value;
            }
        }
        self.columns_forward.process_with_scratch(spectrum, inner);
    }

    /// The image of a spectrum, divided by the number of pixels so that it undoes [`forward`](Self::forward).
    pub fn inverse(&self, spectrum: &[Complex32], image: &mut [f32], scratch: &mut Scratch) {
        let Scratch { half_row, columns, inner, .. } = scratch;
        columns.copy_from_slice(spectrum);
        self.columns_inverse.process_with_scratch(columns, inner);
        let scale = 1.0 / (self.side * self.side) as f32;
        for (y, pixels) in image.chunks_exact_mut(self.side).enumerate() {
            for (x, value) in half_row.iter_mut().enumerate() {
                *value = columns[x * self.side + y] * scale;
            }
            // Rounding leaves a trace where a real image's spectrum has none.
            half_row[0].im = 0.0;
            half_row[self.side / 2].im = 0.0;
            let _ = self.rows_inverse.process_with_scratch(half_row, pixels, inner);
        }
    }
}

/// The spectra of several planes of one side, one after another.
#[derive(Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct PlaneSpectra {
    fourier: Fourier,
    scratch: Scratch,
    values: Vec<Complex32>,
}

impl PlaneSpectra {
    /// Of `count` empty planes of `side` x `side` cells, `side` being even.
    pub fn new(side: usize, count: usize) -> Self {
        let fourier = Fourier::new(side);
        let values = vec![Complex32::default(); count * fourier.spectrum_length()];
        Self { scratch: fourier.scratch(), values, fourier }
    }

    /// Transforms planes, given one after another.
    pub fn compute(&mut self, planes: &[f32]) {
        let Self { fourier, scratch, values } = self;
        let (area, length) = (fourier.side * fourier.side, fourier.spectrum_length());
        for (plane, spectrum) in planes.chunks_exact(area).zip(values.chunks_exact_mut(length)) {
            fourier.forward(plane, spectrum, scratch);
        }
    }

    /// The spectrum of each plane.
    pub fn each(&self) -> impl Iterator<Item = &[Complex32]> {
        self.values.chunks_exact(self.fourier.spectrum_length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_plane_has_the_spectrum_of_its_own() {
        let (side, count) = (4, 3);
        let planes: Vec<f32> = (0..count * side * side).map(|i| ((i * i) % 13) as f32).collect();
        let mut spectra = PlaneSpectra::new(side, count);
        spectra.compute(&planes);
        let fourier = Fourier::new(side);
        let mut scratch = fourier.scratch();
        let mut alone = vec![Complex32::default(); fourier.spectrum_length()];
        assert_eq!(spectra.each().count(), count);
        for (plane, spectrum) in planes.chunks_exact(side * side).zip(spectra.each()) {
            fourier.forward(plane, &mut alone, &mut scratch);
            assert_eq!(spectrum, alone);
        }
    }

    #[test]
    fn a_spectrum_equals_the_naive_sum_and_goes_back_to_its_image() {
        let side = 6;
        let image: Vec<f32> = (0..side * side).map(|i| ((i * i) % 11) as f32 - 4.0).collect();
        let fourier = Fourier::new(side);
        let mut scratch = fourier.scratch();
        let mut spectrum = vec![Complex32::default(); fourier.spectrum_length()];
        fourier.forward(&image, &mut spectrum, &mut scratch);
        for u in 0..=side / 2 {
            for v in 0..side {
                let naive: Complex32 = (0..side * side)
                    .map(|i| {
                        let phase =
                            -std::f32::consts::TAU * (u * (i % side) + v * (i / side)) as f32 / side as f32;
                        Complex32::from_polar(image[i], phase)
                    })
                    .sum();
                assert!((spectrum[u * side + v] - naive).norm() < 1e-3, "{u} {v}");
            }
        }
        let mut back = vec![0.0; side * side];
        fourier.inverse(&spectrum, &mut back, &mut scratch);
        assert!(image.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-4));
    }
}
