//! Histogram of oriented gradients (Dalal, Triggs 2005) of a box, from orientation integral images.
//!
//! Steps:
//! 1. cut the box into 4 x 4 cells, borders at the nearest region cell,
//! 2. in each, the mean gradient magnitude of each of 8 unsigned orientation bins,
//! 3. the 128 numbers as one block: L2 norm 1, clipped at 0.2, L2 norm 1 again.
//!
//! Evaluated scaled at a hypothesis instead of on a resized crop: on the tests' texture, at 0.8 to 2 times the first size,
//! the two differ by a squared distance of 0.04 to 0.15, of 2 at most.

use super::region::{BoxInRegion, RegionIntegrals};

pub use super::gradient::BINS;

/// Cells along each side of the box.
pub const CELLS: usize = 4;
/// Numbers in a descriptor.
pub const LENGTH: usize = CELLS * CELLS * BINS;
/// Largest share that one number may take after the first normalisation.
const CLIP: f32 = 0.2;

/// A descriptor of norm 1, or all zero where there is no gradient at all.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "save", serde(try_from = "Vec<f32>", into = "Vec<f32>"))]
pub struct Hog(pub [f32; LENGTH]);

#[cfg(feature = "save")]
impl From<Hog> for Vec<f32> {
    fn from(hog: Hog) -> Self {
        hog.0.to_vec()
    }
}

#[cfg(feature = "save")]
impl TryFrom<Vec<f32>> for Hog {
    type Error = String;

    fn try_from(numbers: Vec<f32>) -> Result<Self, String> {
        let wrong = |numbers: Vec<f32>| format!("a HOG of {} numbers instead of {LENGTH}", numbers.len());
        numbers.try_into().map(Self).map_err(wrong)
    }
}

impl Hog {
    /// The descriptor of a hypothesis. What lies outside the region of `integrals` is cut off.
    pub fn of(integrals: &RegionIntegrals, hypothesis: &BoxInRegion) -> Self {
        let columns: [usize; CELLS + 1] =
            std::array::from_fn(|i| integrals.column(hypothesis.x + hypothesis.w * i as f32 / CELLS as f32));
        let rows: [usize; CELLS + 1] =
            std::array::from_fn(|i| integrals.row(hypothesis.y + hypothesis.h * i as f32 / CELLS as f32));
        let (integral, stride) = (integrals.orientation(), integrals.stride());
        let mut values = [0.0; LENGTH];
        for (cell_row, out) in values.chunks_exact_mut(CELLS * BINS).enumerate() {
            let (top, bottom) = (rows[cell_row], rows[cell_row + 1]);
            let (above, below) = (&integral[top * stride..], &integral[bottom * stride..]);
            for (cell, out) in out.chunks_exact_mut(BINS).enumerate() {
                let (left, right) = (columns[cell], columns[cell + 1]);
                let per_area = 1.0 / ((right - left) * (bottom - top)).max(1) as f32;
                let (a, b, c, d) = (&above[left], &above[right], &below[left], &below[right]);
                for (bin, out) in out.iter_mut().enumerate() {
                    // Wrapping: the differences are exact though a partial one may pass below zero.
                    let sum = d[bin].wrapping_sub(c[bin]).wrapping_sub(b[bin]).wrapping_add(a[bin]);
                    *out = sum as i32 as f32 * per_area;
                }
            }
        }
        normalise_clip_normalise(&mut values);
        Self(values)
    }

    /// Squared Euclidean distance, in [0, 2].
    pub fn squared_distance(&self, other: &Self) -> f32 {
        let mut lanes = [0.0; 8];
        for (a, b) in self.0.chunks_exact(8).zip(other.0.chunks_exact(8)) {
            for i in 0..8 {
                let d = a[i] - b[i];
                lanes[i] += d * d;
            }
        }
        lanes.iter().sum()
    }

    /// Moves the descriptor towards `other` by `rate` in [0, 1] and brings its norm back to 1.
    pub fn age_towards(&mut self, other: &Self, rate: f32) {
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            *mine += rate * (theirs - *mine);
        }
        normalise(&mut self.0);
    }
}

fn normalise_clip_normalise(values: &mut [f32; LENGTH]) {
    normalise(values);
    values.iter_mut().for_each(|v| *v = v.min(CLIP));
    normalise(values);
}

fn normalise(values: &mut [f32; LENGTH]) {
    let mut lanes = [0.0f32; 8];
    for chunk in values.chunks_exact(8) {
        for i in 0..8 {
            lanes[i] += chunk[i] * chunk[i];
        }
    }
    let norm = lanes.iter().sum::<f32>().sqrt();
    if norm > 0.0 {
        let inverse = 1.0 / norm;
        values.iter_mut().for_each(|v| *v *= inverse);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        features::{reference, region::SearchRegion},
        frame::{Frame, PixelFormat},
        geometry::Rect,
    };

    fn describe(frame: &Frame, target: Rect) -> Hog {
        let mut integrals = RegionIntegrals::default();
        integrals.compute(&frame.view(), SearchRegion::around(target, 1));
        Hog::of(&integrals, &integrals.to_region(target))
    }

    #[test]
    fn it_equals_the_naive_descriptor_on_the_pixel_grid() {
        let frame = reference::textured_frame(80, 70, PixelFormat::Rgb);
        let target = Rect::new(11.0, 9.0, 32.0, 40.0);
        let fast = describe(&frame, target);
        let naive = reference::hog(&frame.view(), target);
        for (fast, naive) in fast.0.iter().zip(naive) {
            assert!((f64::from(*fast) - naive).abs() < 2e-3, "{fast} {naive}");
        }
    }

    #[test]
    fn a_vertical_edge_fills_the_bins_of_horizontal_gradients_alone() {
        let pixels: Vec<u8> = (0..16 * 16).map(|i| if i % 16 < 8 { 10 } else { 200 }).collect();
        let frame = Frame::new(pixels, 16, 16, PixelFormat::Gray).unwrap();
        let hog = describe(&frame, Rect::new(0.0, 0.0, 16.0, 16.0));
        for cell in hog.0.chunks_exact(BINS) {
            // Orientation 0 lies on the border of the first and last bin.
            assert!(cell[1..BINS - 1].iter().all(|v| *v == 0.0));
        }
        assert!(hog.0[BINS] > 0.0 && hog.0[2 * BINS - 1] > 0.0);
    }

    #[test]
    fn the_norm_is_one_and_a_flat_image_has_none() {
        let frame = reference::textured_frame(40, 40, PixelFormat::Gray);
        let hog = describe(&frame, Rect::new(3.0, 4.0, 20.0, 30.0));
        assert!((hog.0.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1e-5);
        let flat = Frame::new(vec![7; 900], 30, 30, PixelFormat::Gray).unwrap();
        assert_eq!(describe(&flat, Rect::new(3.0, 4.0, 20.0, 20.0)).0, [0.0; LENGTH]);
    }

    #[test]
    fn twice_the_contrast_does_not_change_it() {
        let pixels = |gain: u8| (0..900u32).map(|i| gain * ((i * i % 97 + i % 30) as u8)).collect();
        let of = |gain| {
            describe(
                &Frame::new(pixels(gain), 30, 30, PixelFormat::Gray).unwrap(),
                Rect::new(2.0, 3.0, 24.0, 24.0),
            )
        };
        assert!(of(1).squared_distance(&of(2)) < 1e-3);
    }

    /// Bounds the difference that the module states.
    #[test]
    fn scaled_evaluation_is_near_cropping_and_resizing() {
        let frame = reference::textured_frame(120, 120, PixelFormat::Gray);
        for scale in [0.8, 1.0, 1.3, 2.0] {
            let hypothesis = Rect::new(20.0, 17.0, 24.0 * scale, 32.0 * scale);
            let resized = reference::crop_and_resize(&frame.view(), hypothesis, 24, 32);
            let scaled = describe(&frame, hypothesis);
            let cropped = describe(&resized, Rect::new(0.0, 0.0, 24.0, 32.0));
            let d = scaled.squared_distance(&cropped);
            assert!(d < 0.16, "scale {scale}: squared distance {d}");
        }
    }

    #[test]
    fn ageing_goes_all_the_way_at_rate_one_and_nowhere_at_zero() {
        let frame = reference::textured_frame(80, 80, PixelFormat::Gray);
        let first = describe(&frame, Rect::new(0.0, 0.0, 30.0, 30.0));
        let other = describe(&frame, Rect::new(40.0, 30.0, 30.0, 30.0));
        let aged = |rate| {
            let mut hog = first;
            hog.age_towards(&other, rate);
            hog
        };
        assert!(aged(1.0).squared_distance(&other) < 1e-10);
        assert!(aged(0.0).squared_distance(&first) < 1e-10);
        assert!(aged(0.3).squared_distance(&first) < aged(0.6).squared_distance(&first));
    }
}
