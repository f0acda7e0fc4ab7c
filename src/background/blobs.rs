//! Connected regions of a mask.

use image::GrayImage;
use serde::{Deserialize, Serialize};

use super::{FOREGROUND, regions::runs};
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
    let runs = runs(mask, FOREGROUND, true);
    let mut sums = vec![NOTHING; runs.len()];
    for run in &runs {
        let sum = &mut sums[run.region];
        let (start, end, length) = (u64::from(run.start), u64::from(run.end), run.end - run.start);
        (sum.left, sum.right) = (sum.left.min(run.start), sum.right.max(run.end - 1));
        (sum.top, sum.bottom) = (sum.top.min(run.row), sum.bottom.max(run.row));
        sum.x += (start + end - 1) * (end - start) / 2;
        sum.y += u64::from(run.row) * u64::from(length);
        sum.area += length as usize;
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
    use image::Luma;

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
