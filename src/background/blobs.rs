//! Connected regions of a mask.

use image::{GrayImage, Luma};
use imageproc::region_labelling::{Connectivity, connected_components};
use serde::{Deserialize, Serialize};

use super::BACKGROUND;
use crate::geometry::Rect;

/// A connected region of foreground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Blob {
    /// The smallest box that holds it, in frame coordinates.
    pub box_in_frame: Rect,
    /// Mean of its pixels' centres (x, y), frame coordinates, pixels.
    pub centroid: (f64, f64),
    /// Its pixels.
    pub area: usize,
}

/// What is summed up over a region's pixels.
#[derive(Debug, Clone, Copy)]
struct Sums {
    left: u32,
    top: u32,
    right: u32,
    bottom: u32,
    x: u64,
    y: u64,
    area: usize,
}

const NOTHING: Sums = Sums { left: u32::MAX, top: u32::MAX, right: 0, bottom: 0, x: 0, y: 0, area: 0 };

/// The 8-connected regions of at least `min_area` pixels, in the order of their first pixels.
pub(super) fn find(mask: &GrayImage, min_area: usize) -> Vec<Blob> {
    let labels = connected_components(mask, Connectivity::Eight, Luma([BACKGROUND]));
    let most = labels.iter().copied().max().unwrap_or(0) as usize;
    let mut sums = vec![NOTHING; most + 1];
    for (x, y, label) in labels.enumerate_pixels().filter(|(_, _, label)| label.0[0] > 0) {
        let sum = &mut sums[label.0[0] as usize];
        (sum.left, sum.right) = (sum.left.min(x), sum.right.max(x));
        (sum.top, sum.bottom) = (sum.top.min(y), sum.bottom.max(y));
        sum.x += u64::from(x);
        sum.y += u64::from(y);
        sum.area += 1;
    }
    let large = sums.into_iter().filter(|sum| sum.area >= min_area.max(1));
    large.map(Sums::into_blob).collect()
}

impl Sums {
    fn into_blob(self) -> Blob {
        let (left, top) = (f64::from(self.left), f64::from(self.top));
        let area = self.area as f64;
        Blob {
            box_in_frame: Rect::new(
                left,
                top,
                f64::from(self.right) + 1.0 - left,
                f64::from(self.bottom) + 1.0 - top,
            ),
            centroid: (self.x as f64 / area + 0.5, self.y as f64 / area + 0.5),
            area: self.area,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_eight_connected_and_measured_to_the_pixel() {
        let rows = ["##...", ".#...", "..#..", "....#"];
        let mask = GrayImage::from_fn(5, 4, |x, y| {
            Luma([if rows[y as usize].as_bytes()[x as usize] == b'#' { 255 } else { 0 }])
        });
        let blobs = find(&mask, 1);
        assert_eq!(blobs.len(), 2);
        assert_eq!(blobs[0].box_in_frame, Rect::new(0.0, 0.0, 3.0, 3.0));
        assert_eq!((blobs[0].area, blobs[0].centroid), (4, (1.5, 1.25)));
        assert_eq!((blobs[1].area, blobs[1].box_in_frame), (1, Rect::new(4.0, 3.0, 1.0, 1.0)));
        assert_eq!(find(&mask, 2).len(), 1);
        assert_eq!(find(&GrayImage::new(5, 4), 0), []);
    }
}
