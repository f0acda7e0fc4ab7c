//! Cells of a window, read from integral images.
//!
//! Steps:
//! 1. the mean gradient magnitude of each of `side` x `side` cells in 8 unsigned orientations, and its mean colours
//!    (`lattice.rs`),
//! 2. gradients normalised by the energy of the cell's four blocks of 2 x 2 cells and clipped at 0.2: 8 numbers and 4 energies
//!    (Felzenszwalb, Girshick, McAllester, Ramanan 2010),
//! 3. luminance and two colour differences, without the window's mean,
//! 4. how likely each cell is the target's own (handed in), without the window's mean,
//! 5. gradients, colours and the last each scaled to a mean square of their own, and all tapered towards the window's
//!    border.

use crate::features::{
    blocks::{BlockIntegrals, LANES},
    hog::BINS,
};

use super::{lattice::Lattice, window::Window};

const BLOCKS: usize = 4;
/// Numbers a cell has for its gradients.
pub const GRADIENTS: usize = BINS + BLOCKS;
/// Numbers a cell has for its gradients and colours.
const APPEARANCE: usize = GRADIENTS + 3;
/// Numbers a cell has.
pub const CHANNELS: usize = APPEARANCE + 1;
const CLIP: f32 = 0.2;

/// Cells of a window, a plane a channel.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Grid {
    side: usize,
    taper: Vec<f32>,
    lattice: Lattice,
    gradients: Vec<[f32; BINS]>,
    energies: Vec<f32>,
    planes: Vec<f32>,
}

impl Grid {
    /// Scratch and planes for `side` x `side` cells.
    pub fn new(side: usize) -> Self {
        let hann = |i: usize| {
            let phase = std::f32::consts::TAU * (i as f32 + 0.5) / side as f32;
            0.5 * (1.0 - phase.cos())
        };
        Self {
            side,
            taper: (0..side * side).map(|i| hann(i / side) * hann(i % side)).collect(),
            lattice: Lattice::new(side, side),
            gradients: vec![[0.0; BINS]; side * side],
            energies: vec![0.0; side * side],
            planes: vec![0.0; CHANNELS * side * side],
        }
    }

    /// Cells along the window's side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The planes of all channels, one after another, each with its rows one after another.
    pub fn planes(&self) -> &[f32] {
        &self.planes
    }

    /// Describes a window of the frame (steps 1 to 5); `own` is how likely each cell is the target's own, row by row.
    pub fn describe(&mut self, integrals: &BlockIntegrals, window: Window, own: &[f32]) {
        let area = self.side * self.side;
        self.collect(integrals, window);
        self.normalise();
        self.planes[APPEARANCE * area..].copy_from_slice(own);
        for plane in self.planes[GRADIENTS * area..].chunks_exact_mut(area) {
            let mean = plane.iter().sum::<f32>() / area as f32;
            plane.iter_mut().for_each(|value| *value -= mean);
        }
        scale_to(&mut self.planes[..GRADIENTS * area], 1.0);
        scale_to(&mut self.planes[GRADIENTS * area..APPEARANCE * area], 1.0);
        scale_to(&mut self.planes[APPEARANCE * area..], 1.0);
        for plane in self.planes.chunks_exact_mut(area) {
            plane.iter_mut().zip(&self.taper).for_each(|(value, taper)| *value *= taper);
        }
    }

    /// Steps 1 and 3, but for the mean.
    fn collect(&mut self, integrals: &BlockIntegrals, window: Window) {
        let area = self.side * self.side;
        let Self { lattice, gradients, planes, .. } = self;
        lattice.read(integrals, window.to_rect(), |cell, means| {
            gradients[cell].copy_from_slice(&means[..BINS]);
            for (plane, value) in colour_differences(means).into_iter().enumerate() {
                planes[(GRADIENTS + plane) * area + cell] = value;
            }
        });
    }

    /// Step 2.
    fn normalise(&mut self) {
        let (side, area) = (self.side, self.side * self.side);
        for (energy, gradients) in self.energies.iter_mut().zip(&self.gradients) {
            *energy = gradients.iter().map(|g| g * g).sum();
        }
        let energy =
            |row: usize, column: usize| self.energies[row.min(side - 1) * side + column.min(side - 1)];
        for row in 0..side {
            for column in 0..side {
                let cell = row * side + column;
                let rows = [row.saturating_sub(1), row];
                let columns = [column.saturating_sub(1), column];
                let mut factors = [0.0; BLOCKS];
                for (k, factor) in factors.iter_mut().enumerate() {
                    let (r, c) = (rows[k / 2], columns[k % 2]);
                    let sum = energy(r, c) + energy(r + 1, c) + energy(r, c + 1) + energy(r + 1, c + 1);
                    *factor = 1.0 / (sum + 1.0).sqrt();
                }
                let mut energies = [0.0; BLOCKS];
                for (bin, gradient) in self.gradients[cell].iter().enumerate() {
                    let mut sum = 0.0;
                    for (factor, energy) in factors.iter().zip(&mut energies) {
                        let value = (gradient * factor).min(CLIP);
                        sum += value;
                        *energy += value;
                    }
                    self.planes[bin * area + cell] = 0.5 * sum;
                }
                for (block, energy) in energies.into_iter().enumerate() {
                    self.planes[(BINS + block) * area + cell] = 0.2357 * energy;
                }
            }
        }
    }
}

/// Luminance, red against green, and yellow against blue.
pub(super) fn colour_differences(means: &[f32; LANES]) -> [f32; 3] {
    let [r, g, b] = [means[BINS], means[BINS + 1], means[BINS + 2]];
    [0.25 * (r + 2.0 * g + b), r - g, 0.5 * (r + g) - b]
}

fn scale_to(values: &mut [f32], root_mean_square: f32) {
    let mean_square = values.iter().map(|v| v * v).sum::<f32>() / values.len() as f32;
    if mean_square > 0.0 {
        let factor = root_mean_square / mean_square.sqrt();
        values.iter_mut().for_each(|value| *value *= factor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        features::{reference, region::SearchRegion},
        frame::{Frame, PixelFormat},
    };

    const SIDE: usize = 8;

    fn integrals(frame: &Frame) -> BlockIntegrals {
        let mut integrals = BlockIntegrals::default();
        let (width, height) = (frame.view().width(), frame.view().height());
        integrals.compute(&frame.view(), SearchRegion { x: 0, y: 0, width, height, step: 1 }, 1);
        integrals
    }

    #[test]
    fn on_the_pixel_grid_a_cells_gradients_and_colours_are_the_naive_means() {
        let frame = reference::textured_frame(40, 40, PixelFormat::Rgb);
        let mut grid = Grid::new(SIDE);
        let integrals = integrals(&frame);
        grid.collect(&integrals, Window { x: 20.0, y: 18.0, side: 32.0 });
        let naive = reference::gradient_bins(&frame.view(), integrals.region());
        for (cell, found) in grid.gradients.iter().enumerate() {
            let (left, top) = (4 + cell % SIDE * 4, 2 + cell / SIDE * 4);
            for (bin, found) in found.iter().enumerate() {
                let sum: f32 = (0..16).map(|i| naive[top + i / 4][left + i % 4][bin]).sum();
                // Rounding to whole units: at most 1 a pixel.
                assert!((found - sum / 16.0).abs() < 1.0, "{cell} {bin}: {found} {}", sum / 16.0);
            }
            let mean = |channel: usize| {
                let pixel =
                    |i: usize| reference::sample(&frame.view(), (left + i % 4) as i64, (top + i / 4) as i64);
                (0..16).map(|i| f32::from(pixel(i)[channel])).sum::<f32>() / 16.0
            };
            let red_green = grid.planes[(GRADIENTS + 1) * SIDE * SIDE + cell];
            assert!((red_green - (mean(0) - mean(1))).abs() < 1e-3);
        }
    }

    #[test]
    fn the_same_texture_moved_by_less_than_a_cell_moves_between_cells() {
        // A step edge at column 20: the cell that holds it has all of its gradient wherever the cell's border lies.
        let pixels: Vec<u8> = (0..40 * 40).map(|i| if i % 40 < 20 { 20 } else { 220 }).collect();
        let integrals = integrals(&Frame::new(pixels, 40, 40, PixelFormat::Gray).unwrap());
        let mut grid = Grid::new(SIDE);
        let total = |grid: &Grid| grid.gradients[..SIDE].iter().flatten().sum::<f32>();
        grid.collect(&integrals, Window { x: 20.0, y: 20.0, side: 32.0 });
        let whole = total(&grid);
        grid.collect(&integrals, Window { x: 21.3, y: 20.0, side: 32.0 });
        assert!((total(&grid) - whole).abs() < 1e-2 * whole);
    }

    #[test]
    fn what_lies_beyond_the_region_is_nothing() {
        let frame = reference::textured_frame(40, 40, PixelFormat::Rgb);
        let integrals = integrals(&frame);
        let mut grid = Grid::new(SIDE);
        let own = [0.5; SIDE * SIDE];
        grid.describe(&integrals, Window { x: 500.0, y: -300.0, side: 32.0 }, &own);
        assert!(grid.planes().iter().all(|value| *value == 0.0));
        grid.describe(&integrals, Window { x: 35.0, y: 20.0, side: 60.0 }, &own);
        assert!(grid.planes().iter().all(|value| value.is_finite()));
        assert!(grid.planes().iter().any(|value| *value != 0.0));
    }

    #[test]
    fn gradients_colours_and_what_is_its_own_weigh_the_same_and_the_last_is_the_one_handed_in() {
        let frame = reference::textured_frame(40, 40, PixelFormat::Rgb);
        let area = SIDE * SIDE;
        let own: Vec<f32> = (0..area).map(|i| if i == 3 * SIDE + 4 { 0.9 } else { 0.1 }).collect();
        let mut grid = Grid::new(SIDE);
        grid.taper.fill(1.0);
        grid.describe(&integrals(&frame), Window { x: 20.0, y: 20.0, side: 30.0 }, &own);
        let mean_square = |planes: &[f32]| planes.iter().map(|v| v * v).sum::<f32>() / planes.len() as f32;
        let (gradients, rest) = grid.planes().split_at(GRADIENTS * area);
        let (colours, last) = rest.split_at(3 * area);
        for planes in [gradients, colours, last] {
            assert!((mean_square(planes) - 1.0).abs() < 1e-3);
        }
        let best = (0..area).max_by(|a, b| last[*a].total_cmp(&last[*b])).unwrap();
        assert_eq!(best, 3 * SIDE + 4);
        assert!(last.iter().sum::<f32>().abs() < 1e-3);
    }
}
