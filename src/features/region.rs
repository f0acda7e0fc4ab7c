//! Integral images of a search region.
//!
//! Steps, each frame:
//! 1. cut the region out of the frame, repeating edge pixels outside it; a cell is the mean of its `step` x `step` pixels, or of
//!    4 x 4 of them evenly spaced where there are more, so that the cost follows the cells and not the pixels,
//! 2. one integral image a colour channel (exact, u32),
//! 3. gradient of luminance by central differences; its magnitude, split between the two nearest of 8 unsigned
//!    orientation bins, goes into 8 interleaved integral images (exact, u32).
//!
//! The cost depends on the region alone, never on the frame.

use std::ops::Range;

use crate::{
    features::hog::BINS,
    frame::{FrameView, PixelFormat},
    geometry::Rect,
};

/// Colour channels that Haar-like features may read.
pub const CHANNELS: usize = 3;

/// Pixels along a cell's side that are averaged at most.
const SAMPLES_PER_SIDE: usize = 4;

/// A region of a frame in whole pixels. It may reach beyond the frame, where edge pixels are repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SearchRegion {
    /// Left edge in frame pixels.
    pub x: i64,
    /// Top edge in frame pixels.
    pub y: i64,
    /// Width in cells, >= 1.
    pub width: usize,
    /// Height in cells, >= 1.
    pub height: usize,
    /// Frame pixels along a cell's side, >= 1.
    pub step: usize,
}

impl SearchRegion {
    /// The smallest region of cells of `step` pixels that holds `box_in_frame` with a cell to spare on every side.
    pub fn around(box_in_frame: Rect, step: usize) -> Self {
        let step_px = step as f64;
        let (x, y) = (box_in_frame.x.floor() - step_px, box_in_frame.y.floor() - step_px);
        let cells = |from: f64, to: f64| ((to - from) / step_px).ceil().max(1.0) as usize + 1;
        Self {
            x: x as i64,
            y: y as i64,
            width: cells(x, box_in_frame.right()),
            height: cells(y, box_in_frame.bottom()),
            step,
        }
    }
}

/// A box in cells of a [`RegionIntegrals`], from its top left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxInRegion {
    /// Left edge, cells.
    pub x: f32,
    /// Top edge, cells.
    pub y: f32,
    /// Width, cells.
    pub w: f32,
    /// Height, cells.
    pub h: f32,
}

/// Integral images of a search region: colour channels and orientation bins. Reused from frame to frame.
#[derive(Debug, Clone)]
pub struct RegionIntegrals {
    region: SearchRegion,
    channels: usize,
    cells: [Vec<u8>; CHANNELS],
    colour: [Vec<u32>; CHANNELS],
    orientation: Vec<[u32; BINS]>,
    rows: GradientRows,
}

/// Scratch of one row of gradients.
#[derive(Debug, Clone, Default)]
struct GradientRows {
    luminance: [Vec<f32>; 3],
    /// What the lower of the two nearest bins gets of each gradient's magnitude.
    lower: Vec<u32>,
    /// What the upper one gets.
    upper: Vec<u32>,
    /// The upper bin, in 0..=BINS; the lower one is that before it, around the circle.
    bin: Vec<u32>,
}

impl Default for RegionIntegrals {
    fn default() -> Self {
        Self {
            region: SearchRegion { x: 0, y: 0, width: 0, height: 0, step: 1 },
            channels: 1,
            cells: Default::default(),
            colour: Default::default(),
            orientation: Vec::new(),
            rows: GradientRows::default(),
        }
    }
}

impl RegionIntegrals {
    /// Colour channels: 1 for a grey frame, else 3.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// The region that was computed last.
    pub fn region(&self) -> SearchRegion {
        self.region
    }

    /// Computes the integral images of `region` (steps 1 to 3). Allocates only when the region outgrows all before it.
    pub fn compute(&mut self, frame: &FrameView<'_>, region: SearchRegion) {
        self.region = region;
        self.channels = if frame.format() == PixelFormat::Gray { 1 } else { CHANNELS };
        self.cut(frame);
        let Self { region, channels, cells, colour, orientation, rows } = self;
        let cells = &cells[..*channels];
        rayon::join(
            || integrate_colour(*region, cells, colour),
            || integrate_orientation(*region, cells, orientation, rows),
        );
    }

    /// A box of the frame in this region's cells.
    pub fn to_region(&self, box_in_frame: Rect) -> BoxInRegion {
        let per_pixel = 1.0 / self.region.step as f64;
        BoxInRegion {
            x: ((box_in_frame.x - self.region.x as f64) * per_pixel) as f32,
            y: ((box_in_frame.y - self.region.y as f64) * per_pixel) as f32,
            w: (box_in_frame.w * per_pixel) as f32,
            h: (box_in_frame.h * per_pixel) as f32,
        }
    }

    /// The grid column nearest to `x` cells, inside the region.
    pub(crate) fn column(&self, x: f32) -> usize {
        nearest_line(x, self.region.width)
    }

    /// The grid row nearest to `y` cells, inside the region.
    pub(crate) fn row(&self, y: f32) -> usize {
        nearest_line(y, self.region.height)
    }

    /// Integral image of a colour channel: entry (row r, column c) at `r * stride + c` sums the cells above and left.
    pub(crate) fn colour(&self, channel: usize) -> &[u32] {
        &self.colour[channel.min(self.channels - 1)]
    }

    /// Integral image of the orientation bins, laid out like [`colour`](Self::colour).
    pub(crate) fn orientation(&self) -> &[[u32; BINS]] {
        &self.orientation
    }

    /// Entries in a row of an integral image.
    pub(crate) fn stride(&self) -> usize {
        self.region.width + 1
    }

    /// Step 1.
    fn cut(&mut self, frame: &FrameView<'_>) {
        let SearchRegion { width, height, .. } = self.region;
        for cells in &mut self.cells[..self.channels] {
            cells.clear();
            cells.resize(width * height, 0);
        }
        if self.region.step == 1 { self.cut_pixels(frame) } else { self.cut_averages(frame) }
    }

    fn cut_pixels(&mut self, frame: &FrameView<'_>) {
        let SearchRegion { x, y, width, height, .. } = self.region;
        let size = frame.format().bytes_per_pixel();
        let (last_x, last_y) = (frame.width() as i64 - 1, frame.height() as i64 - 1);
        // Columns [inside_from, inside_to) of the region lie in the frame; the others repeat its edge.
        let inside_from = (-x).clamp(0, width as i64) as usize;
        let inside_to = (last_x + 1 - x).clamp(inside_from as i64, width as i64) as usize;
        for (channel, offset) in frame.format().rgb_offsets().into_iter().take(self.channels).enumerate() {
            for row in 0..height {
                let pixels = frame.row((y + row as i64).clamp(0, last_y) as usize);
                let cells = &mut self.cells[channel][row * width..][..width];
                cells[..inside_from].fill(pixels[offset]);
                cells[inside_to..].fill(pixels[last_x as usize * size + offset]);
                if inside_from < inside_to {
                    let first = (x + inside_from as i64) as usize * size;
                    let inside = pixels[first..].chunks_exact(size);
                    for (cell, pixel) in cells[inside_from..inside_to].iter_mut().zip(inside) {
                        *cell = pixel[offset];
                    }
                }
            }
        }
    }

    fn cut_averages(&mut self, frame: &FrameView<'_>) {
        let SearchRegion { x, y, width, height, step } = self.region;
        let size = frame.format().bytes_per_pixel();
        let offsets = frame.format().rgb_offsets();
        let (last_x, last_y) = (frame.width() as i64 - 1, frame.height() as i64 - 1);
        let per_side = step.min(SAMPLES_PER_SIDE);
        let samples = (per_side * per_side) as u32;
        let sample = |cell: usize, i: usize| (cell * step + (2 * i + 1) * step / (2 * per_side)) as i64;
        for row in 0..height {
            for column in 0..width {
                let mut sums = [0u32; CHANNELS];
                for dy in 0..per_side {
                    let pixels = frame.row((y + sample(row, dy)).clamp(0, last_y) as usize);
                    for dx in 0..per_side {
                        let at = (x + sample(column, dx)).clamp(0, last_x) as usize * size;
                        for (sum, offset) in sums.iter_mut().zip(offsets).take(self.channels) {
                            *sum += u32::from(pixels[at + offset]);
                        }
                    }
                }
                for (cells, sum) in self.cells.iter_mut().zip(sums).take(self.channels) {
                    cells[row * width + column] = ((sum + samples / 2) / samples) as u8;
                }
            }
        }
    }
}

/// Step 2.
fn integrate_colour(region: SearchRegion, cells: &[Vec<u8>], integrals: &mut [Vec<u32>]) {
    let SearchRegion { width, height, .. } = region;
    let stride = width + 1;
    for (cells, integral) in cells.iter().zip(integrals) {
        integral.resize(stride * (height + 1), 0);
        integral[..stride].fill(0);
        for (row, cells) in cells.chunks_exact(width).enumerate() {
            let (above, below) = integral[row * stride..].split_at_mut(stride);
            let mut sum = 0;
            below[0] = 0;
            for ((out, up), &cell) in below[1..].iter_mut().zip(&above[1..]).zip(cells) {
                sum += u32::from(cell);
                *out = up + sum;
            }
        }
    }
}

/// Step 3.
fn integrate_orientation(
    region: SearchRegion,
    cells: &[Vec<u8>],
    integral: &mut Vec<[u32; BINS]>,
    rows: &mut GradientRows,
) {
    let SearchRegion { width, height, .. } = region;
    let stride = width + 1;
    integral.resize(stride * (height + 1), [0; BINS]);
    integral[..stride].fill([0; BINS]);
    rows.resize(width);
    let row_of = |row: usize| row * width..(row + 1) * width;
    rows.load_luminance(cells, row_of(0), 1);
    rows.load_luminance(cells, row_of(0), 2);
    for row in 0..height {
        rows.luminance.rotate_left(1);
        rows.load_luminance(cells, row_of((row + 1).min(height - 1)), 2);
        rows.differentiate();
        let (above, below) = integral[row * stride..].split_at_mut(stride);
        rows.accumulate(&above[1..], below);
    }
}

impl GradientRows {
    fn resize(&mut self, width: usize) {
        self.luminance.iter_mut().for_each(|row| row.resize(width, 0.0));
        for row in [&mut self.lower, &mut self.upper, &mut self.bin] {
            row.resize(width, 0);
        }
    }

    fn load_luminance(&mut self, cells: &[Vec<u8>], at: Range<usize>, slot: usize) {
        let out = &mut self.luminance[slot];
        match cells {
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
        let Self { luminance: [above, middle, below], lower, upper, bin } = self;
        let width = middle.len();
        let mut put = |at: usize, dx: f32, dy: f32| (lower[at], upper[at], bin[at]) = split_gradient(dx, dy);
        put(0, middle[1.min(width - 1)] - middle[0], below[0] - above[0]);
        put(
            width - 1,
            middle[width - 1] - middle[width.saturating_sub(2)],
            below[width - 1] - above[width - 1],
        );
        if width < 3 {
            return;
        }
        // Slices of one known length, so that the loop works on several pixels at a time.
        let inside = width - 2;
        let (before, after) = (&middle[..inside], &middle[2..][..inside]);
        let (above, below) = (&above[1..][..inside], &below[1..][..inside]);
        let (lower, upper, bin) =
            (&mut lower[1..][..inside], &mut upper[1..][..inside], &mut bin[1..][..inside]);
        for i in 0..inside {
            (lower[i], upper[i], bin[i]) = split_gradient(after[i] - before[i], below[i] - above[i]);
        }
    }

    /// Adds the row's gradients to the integral row `above`; `below` has one leading entry more.
    fn accumulate(&self, above: &[[u32; BINS]], below: &mut [[u32; BINS]]) {
        let mut sums = [0u32; BINS];
        below[0] = sums;
        let gradients = self.lower.iter().zip(&self.upper).zip(&self.bin);
        for ((out, up), ((&lower, &upper), &bin)) in below[1..].iter_mut().zip(above).zip(gradients) {
            let (lower_mask, upper_mask) =
                (&BIN_MASKS[bin as usize % BINS], &BIN_MASKS[bin as usize % BINS + 1]);
            for b in 0..BINS {
                sums[b] += (lower & lower_mask[b]) + (upper & upper_mask[b]);
                out[b] = up[b] + sums[b];
            }
        }
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
#[inline]
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
#[inline]
fn nearest_integer(value: f32) -> u32 {
    const SHIFT: f32 = 8_388_608.0;
    (value + SHIFT).to_bits() - SHIFT.to_bits()
}

/// Orientation of a gradient as a share of the half turn, in [0, 1): 0 is horizontal, 0.5 vertical, sign ignored.
/// Within 3e-5 of atan2.
#[inline]
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

fn nearest_line(at: f32, lines: usize) -> usize {
    ((at + 0.5).max(0.0) as usize).min(lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{features::reference, frame::Frame};

    fn textured(width: usize, height: usize, format: PixelFormat) -> Frame {
        reference::textured_frame(width, height, format)
    }

    #[test]
    fn colour_integrals_equal_naive_sums_even_beyond_the_frame() {
        for format in [PixelFormat::Gray, PixelFormat::Rgb, PixelFormat::Bgra] {
            let frame = textured(13, 9, format);
            for (x, y, width, height) in [(-4, -3, 21, 16), (2, 1, 5, 4), (30, 2, 4, 3), (-9, -9, 3, 3)] {
                let mut integrals = RegionIntegrals::default();
                let region = SearchRegion { x, y, width, height, step: 1 };
                integrals.compute(&frame.view(), region);
                for channel in 0..integrals.channels() {
                    for r in 0..=height {
                        for c in 0..=width {
                            let mut sum = 0;
                            for j in 0..r as i64 {
                                for i in 0..c as i64 {
                                    sum += u32::from(reference::sample(&frame.view(), x + i, y + j)[channel]);
                                }
                            }
                            assert_eq!(integrals.colour(channel)[r * integrals.stride() + c], sum);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_whole_frame_has_the_integral_image_that_imageproc_computes() {
        let frame = textured(23, 17, PixelFormat::Gray);
        let mut integrals = RegionIntegrals::default();
        integrals.compute(&frame.view(), SearchRegion { x: 0, y: 0, width: 23, height: 17, step: 1 });
        let grey =
            image::GrayImage::from_fn(23, 17, |x, y| image::Luma([frame.view().row(y as usize)[x as usize]]));
        let theirs = imageproc::integral_image::integral_image::<_, u32>(&grey);
        assert_eq!(integrals.colour(0), theirs.as_raw().as_slice());
    }

    #[test]
    fn a_cell_of_two_by_two_pixels_is_their_rounded_mean() {
        let frame = Frame::new(vec![1, 2, 3, 4, 10, 20, 30, 43], 4, 2, PixelFormat::Gray).unwrap();
        let mut integrals = RegionIntegrals::default();
        integrals.compute(&frame.view(), SearchRegion { x: 0, y: 0, width: 2, height: 1, step: 2 });
        assert_eq!(integrals.colour(0), &[0, 0, 0, 0, 8, 8 + 20]);
    }

    #[test]
    fn a_cell_of_eight_by_eight_pixels_is_the_mean_of_sixteen_of_them() {
        let pixels: Vec<u8> = (0..64).map(|i| (i % 8 + i / 8 * 10) as u8).collect();
        let frame = Frame::new(pixels, 8, 8, PixelFormat::Gray).unwrap();
        let mut integrals = RegionIntegrals::default();
        integrals.compute(&frame.view(), SearchRegion { x: 0, y: 0, width: 1, height: 1, step: 8 });
        // Columns and rows 1, 3, 5, 7.
        assert_eq!(integrals.colour(0)[3], 4 + 40);
    }

    #[test]
    fn the_orientation_bins_hold_the_whole_gradient_of_each_cell() {
        let frame = textured(20, 17, PixelFormat::Rgb);
        let mut integrals = RegionIntegrals::default();
        let region = SearchRegion { x: -2, y: -2, width: 24, height: 21, step: 1 };
        integrals.compute(&frame.view(), region);
        let naive = reference::gradient_bins(&frame.view(), region);
        let stride = integrals.stride();
        for r in 0..=region.height {
            for c in 0..=region.width {
                let found = integrals.orientation()[r * stride + c];
                let mut expected = [0.0f64; BINS];
                for row in &naive[..r] {
                    for cell in &row[..c] {
                        (0..BINS).for_each(|b| expected[b] += f64::from(cell[b]));
                    }
                }
                for (found, expected) in found.iter().zip(expected) {
                    // Rounding to whole units: at most 1 a cell.
                    assert!((f64::from(*found) - expected).abs() <= 0.01 * expected + (r * c) as f64);
                }
            }
        }
    }

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

    #[test]
    fn a_region_around_a_box_holds_it_with_a_cell_to_spare() {
        for step in [1, 2, 3] {
            let target = Rect::new(-3.4, 10.6, 20.1, 7.7);
            let region = SearchRegion::around(target, step);
            let (right, bottom) = (region.width * step, region.height * step);
            assert!(region.x as f64 + step as f64 <= target.x && region.y as f64 + step as f64 <= target.y);
            assert!((region.x as f64 + right as f64) >= target.right());
            assert!((region.y as f64 + bottom as f64) >= target.bottom());
        }
    }
}
