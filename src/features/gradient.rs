//! Gradients of the cells of a region, row by row: the magnitude of each, split between the two nearest of 8 unsigned
//! orientation bins, in whole numbers so that sums are exact.

use std::ops::Range;

use multiversion::multiversion;

use super::cells::Cells;

/// Unsigned orientations that gradients are told apart by.
pub const BINS: usize = 8;

/// A gradient's magnitude, split between two neighbouring bins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gradient {
    /// What the lower of the two nearest bins gets.
    lower: u32,
    /// What the upper one gets.
    upper: u32,
    /// The upper bin, in 0..=BINS; the lower one is that before it, around the circle.
    bin: u32,
}

impl Gradient {
    /// Adds the magnitude to the two bins.
    #[inline(always)]
    pub fn add_to(self, sums: &mut [u32; BINS]) {
        let Self { lower, upper, bin } = self;
        let (lower_mask, upper_mask) = (&BIN_MASKS[bin as usize % BINS], &BIN_MASKS[bin as usize % BINS + 1]);
        for b in 0..BINS {
            sums[b] += (lower & lower_mask[b]) + (upper & upper_mask[b]);
        }
    }
}

/// The gradients of one row at a time: scratch that is reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub(super) struct GradientRows {
    luminance: [Vec<f32>; 3],
    lower: Vec<u32>,
    upper: Vec<u32>,
    bin: Vec<u32>,
}

impl GradientRows {
    /// Hands the gradients of each of `rows` of the cells to `take`, in order.
    pub fn for_each(&mut self, cells: &Cells, rows: Range<usize>, mut take: impl FnMut(usize, &Self)) {
        let (width, last) = (cells.region().width, cells.region().height - 1);
        self.resize(width);
        self.load_luminance(cells, rows.start.saturating_sub(1), 1);
        self.load_luminance(cells, rows.start, 2);
        for row in rows {
            self.luminance.rotate_left(1);
            self.load_luminance(cells, (row + 1).min(last), 2);
            self.differentiate();
            take(row, self);
        }
    }

    /// The gradients of some columns of the row.
    #[inline(always)]
    pub fn of(&self, columns: Range<usize>) -> impl Iterator<Item = Gradient> {
        let shares =
            self.lower[columns.clone()].iter().zip(&self.upper[columns.clone()]).zip(&self.bin[columns]);
        shares.map(|((&lower, &upper), &bin)| Gradient { lower, upper, bin })
    }

    fn resize(&mut self, width: usize) {
        self.luminance.iter_mut().for_each(|row| row.resize(width, 0.0));
        for row in [&mut self.lower, &mut self.upper, &mut self.bin] {
            row.resize(width, 0);
        }
    }

    fn load_luminance(&mut self, cells: &Cells, row: usize, slot: usize) {
        let width = cells.region().width;
        let at = row * width..(row + 1) * width;
        let out = &mut self.luminance[slot];
        match cells.planes() {
            [red, green, blue] => {
                let cells = red[at.clone()].iter().zip(&green[at.clone()]).zip(&blue[at]);
                for (out, ((&r, &g), &b)) in out.iter_mut().zip(cells) {
                    *out = f32::from(u16::from(r) + 2 * u16::from(g) + u16::from(b));
                }
            }
            [grey, ..] => {
                for (out, &grey) in out.iter_mut().zip(&grey[at]) {
                    *out = 4.0 * f32::from(grey);
                }
            }
            [] => {}
        }
    }

    /// The gradients of the middle row, split between the two nearest bins.
    fn differentiate(&mut self) {
        let Self { luminance, lower, upper, bin } = self;
        differentiate(luminance, [lower, upper, bin]);
    }
}

/// Compiled for processors with and without AVX2, of which the one at hand is asked; the results are the same bits.
#[multiversion(targets("x86_64+avx2"))]
fn differentiate([above, middle, below]: &[Vec<f32>; 3], [lower, upper, bin]: [&mut [u32]; 3]) {
    let width = middle.len();
    let mut put = |at: usize, dx: f32, dy: f32| (lower[at], upper[at], bin[at]) = split_gradient(dx, dy);
    put(0, middle[1.min(width - 1)] - middle[0], below[0] - above[0]);
    put(width - 1, middle[width - 1] - middle[width.saturating_sub(2)], below[width - 1] - above[width - 1]);
    if width < 3 {
        return;
    }
    // Slices of one known length, so that the loop works on several pixels at a time.
    let inside = width - 2;
    let (before, after) = (&middle[..inside], &middle[2..][..inside]);
    let (above, below) = (&above[1..][..inside], &below[1..][..inside]);
    let (lower, upper, bin) = (&mut lower[1..][..inside], &mut upper[1..][..inside], &mut bin[1..][..inside]);
    for i in 0..inside {
        (lower[i], upper[i], bin[i]) = split_gradient(after[i] - before[i], below[i] - above[i]);
    }
}

/// Mask i leaves bin i - 1, around the circle: whole bins are added at once, without a branch or an index.
const BIN_MASKS: [[u32; BINS]; BINS + 1] = {
    let mut masks = [[0; BINS]; BINS + 1];
    let mut i = 0;
    while i <= BINS {
        masks[i][(i + BINS - 1) % BINS] = u32::MAX;
        i += 1;
    }
    masks
};

/// What the lower and the upper of the two nearest bins get of a gradient's magnitude, and the upper bin.
#[inline(always)]
fn split_gradient(dx: f32, dy: f32) -> (u32, u32, u32) {
    let magnitude = (dx * dx + dy * dy).sqrt();
    // Half a bin is added, so that the whole part is the upper bin and the rest its share.
    let position = orientation(dx, dy) * BINS as f32 + 0.5;
    let bin = nearest_integer(position - 0.5);
    let total = nearest_integer(magnitude);
    let upper = nearest_integer(magnitude * (position - bin as f32)).min(total);
    (total - upper, upper, bin)
}

/// `value`, in [0, 2^22], rounded; ties go to the even neighbour. A cast saturates, which is slow on several at a time.
#[inline(always)]
fn nearest_integer(value: f32) -> u32 {
    const SHIFT: f32 = 8_388_608.0;
    (value + SHIFT).to_bits() - SHIFT.to_bits()
}

/// Orientation of a gradient as a share of the half turn, in [0, 1): 0 is horizontal, 0.5 vertical, sign ignored.
/// Within 3e-5 of atan2.
#[inline(always)]
fn orientation(dx: f32, dy: f32) -> f32 {
    let (ax, ay) = (dx.abs(), dy.abs());
    let ratio = ax.min(ay) / ax.max(ay).max(1e-9);
    // Minimax polynomial for atan(ratio) / pi on [0, 1].
    let square = ratio * ratio;
    let eighth =
        ratio * (0.318_059_64 + square * (-0.102_233_14 + square * (0.046_557_333 - square * 0.012_409_725)));
    let quarter = if ay > ax { 0.5 - eighth } else { eighth };
    let half = if (dx < 0.0) != (dy < 0.0) { 1.0 - quarter } else { quarter };
    if half >= 1.0 { 0.0 } else { half }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientation_follows_the_arctangent_and_ignores_sign() {
        for i in 0..720 {
            let angle = f64::from(i) * std::f64::consts::PI / 360.0;
            let found = f64::from(orientation((100.0 * angle.cos()) as f32, (100.0 * angle.sin()) as f32));
            let expected = (angle / std::f64::consts::PI).rem_euclid(1.0);
            let difference = (found - expected).abs();
            assert!(difference.min(1.0 - difference) < 3e-5, "{i}: {found} {expected}");
        }
        assert_eq!(orientation(0.0, 0.0), 0.0);
    }
}
