//! Integral images of a search region.
//!
//! Steps, each frame:
//! 1. cut the region's cells out of the frame (`cells.rs`),
//! 2. one integral image a colour channel (exact, u32),
//! 3. gradient of luminance by central differences; its magnitude, split between the two nearest of 8 unsigned
//!    orientation bins (`gradient.rs`), goes into 8 interleaved integral images (exact, u32).
//!
//! The cost depends on the region alone, never on the frame.

use multiversion::multiversion;

use crate::{frame::FrameView, geometry::Rect, parallel::join};

use super::{
    cells::Cells,
    gradient::{BINS, GradientRows},
};

pub use super::{
    cells::CHANNELS,
    search_region::{BoxInRegion, SearchRegion},
};

/// Integral images of a search region: colour channels and orientation bins. Reused from frame to frame.
#[derive(Debug, Clone, Default)]
pub struct RegionIntegrals {
    cells: Cells,
    colour: [Vec<u32>; CHANNELS],
    orientation: Vec<[u32; BINS]>,
    rows: GradientRows,
}

impl RegionIntegrals {
    /// Colour channels: 1 for a grey frame, else 3.
    pub fn channels(&self) -> usize {
        self.cells.channels()
    }

    /// The region that was computed last.
    pub fn region(&self) -> SearchRegion {
        self.cells.region()
    }

    /// Computes the integral images of `region` (steps 1 to 3). Allocates only when the region outgrows all before it.
    pub fn compute(&mut self, frame: &FrameView<'_>, region: SearchRegion) {
        self.cells.cut(frame, region);
        let Self { cells, colour, orientation, rows } = self;
        join(|| integrate_colour(cells, colour), || integrate_orientation(cells, orientation, rows));
    }

    /// A box of the frame in this region's cells.
    pub fn to_region(&self, box_in_frame: Rect) -> BoxInRegion {
        let per_pixel = 1.0 / self.region().step as f64;
        BoxInRegion {
            x: ((box_in_frame.x - self.region().x as f64) * per_pixel) as f32,
            y: ((box_in_frame.y - self.region().y as f64) * per_pixel) as f32,
            w: (box_in_frame.w * per_pixel) as f32,
            h: (box_in_frame.h * per_pixel) as f32,
        }
    }

    /// The mean of each colour channel over a box of this region, its borders at the nearest cells; a grey frame has its level in
    /// all of them. 0 where the box lies outside.
    pub fn mean_colour(&self, hypothesis: &BoxInRegion) -> [f32; CHANNELS] {
        let (left, right) = (self.column(hypothesis.x), self.column(hypothesis.x + hypothesis.w));
        let (top, bottom) = (self.row(hypothesis.y), self.row(hypothesis.y + hypothesis.h));
        let per_area = 1.0 / ((right - left) * (bottom - top)).max(1) as f32;
        let (above, below) = (top * self.stride(), bottom * self.stride());
        std::array::from_fn(|channel| {
            let integral = self.colour(channel);
            let (a, b) = (integral[above + left], integral[above + right]);
            let (c, d) = (integral[below + left], integral[below + right]);
            // Wrapping: the difference is exact though a partial one may pass below zero.
            d.wrapping_sub(c).wrapping_sub(b).wrapping_add(a) as f32 * per_area
        })
    }

    /// The grid column nearest to `x` cells, inside the region.
    pub(crate) fn column(&self, x: f32) -> usize {
        nearest_line(x, self.region().width)
    }

    /// The grid row nearest to `y` cells, inside the region.
    pub(crate) fn row(&self, y: f32) -> usize {
        nearest_line(y, self.region().height)
    }

    /// Integral image of a colour channel: entry (row r, column c) at `r * stride + c` sums the cells above and left.
    pub(crate) fn colour(&self, channel: usize) -> &[u32] {
        &self.colour[channel.min(self.channels() - 1)]
    }

    /// Integral image of the orientation bins, laid out like [`colour`](Self::colour).
    pub(crate) fn orientation(&self) -> &[[u32; BINS]] {
        &self.orientation
    }

    /// Entries in a row of an integral image.
    pub(crate) fn stride(&self) -> usize {
        self.region().width + 1
    }
}

/// Step 2.
fn integrate_colour(cells: &Cells, integrals: &mut [Vec<u32>]) {
    let SearchRegion { width, height, .. } = cells.region();
    let stride = width + 1;
    for (plane, integral) in cells.planes().iter().zip(integrals) {
        integral.resize(stride * (height + 1), 0);
        integral[..stride].fill(0);
        for (row, cells) in plane.chunks_exact(width).enumerate() {
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
fn integrate_orientation(cells: &Cells, integral: &mut Vec<[u32; BINS]>, rows: &mut GradientRows) {
    let SearchRegion { width, height, .. } = cells.region();
    let stride = width + 1;
    integral.resize(stride * (height + 1), [0; BINS]);
    integral[..stride].fill([0; BINS]);
    rows.for_each(cells, 0..height, |row, gradients| {
        let (above, below) = integral[row * stride..].split_at_mut(stride);
        add_row(gradients, above, &mut below[..stride]);
    });
}

/// The integral image's row below `above`, by its row of gradients. Compiled for processors with and without AVX2.
#[multiversion(targets("x86_64+avx2"))]
fn add_row(gradients: &GradientRows, above: &[[u32; BINS]], below: &mut [[u32; BINS]]) {
    let mut sums = [0; BINS];
    below[0] = sums;
    for ((out, up), gradient) in below[1..].iter_mut().zip(&above[1..]).zip(gradients.of(0..above.len() - 1))
    {
        gradient.add_to(&mut sums);
        for ((out, up), sum) in out.iter_mut().zip(up).zip(&sums) {
            *out = up + sum;
        }
    }
}

fn nearest_line(at: f32, lines: usize) -> usize {
    ((at + 0.5).max(0.0) as usize).min(lines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        features::reference,
        frame::{Frame, PixelFormat},
    };

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
    fn a_region_around_a_box_holds_it_with_a_cell_to_spare() {
        for step in [1, 2, 3] {
            let target = Rect::new(-3.4, 10.6, 20.1, 7.7);
            let region = SearchRegion::around(target, step);
            let covered = region.to_rect();
            assert!(covered.x + step as f64 <= target.x && covered.y + step as f64 <= target.y);
            assert!(covered.right() >= target.right() && covered.bottom() >= target.bottom());
            assert!(covered.right() < target.right() + 2.0 * step as f64);
        }
    }
}
