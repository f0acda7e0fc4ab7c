//! Where a box of known size lies in foreground that several objects share.
//!
//! Each cell counts 1 if it is foreground that no other track's box holds, [`EXPLAINED`] if another's does, and [`EMPTY`] if it
//! is not foreground; beyond the border it counts nothing. Of the places near the prediction the best holds the greatest sum, less
//! [`PULL`] for each squared cell of distance. Sums of rectangles come from a table of sums.

use image::GrayImage;
use infopart::{background::FOREGROUND, geometry::Rect};

const EXPLAINED: f64 = 0.25;
const EMPTY: f64 = -0.7;
const PULL: f64 = 2.0;
/// How far from the prediction is looked, in sides of the box.
const WITHIN: f64 = 0.35;

/// The best place of the box `predicted`, and the share of its cells that are foreground.
pub(super) fn fit(mask: &GrayImage, predicted: &Rect, others: &[Rect]) -> (Rect, f64) {
    let (w, h) = ((predicted.w.round() as usize).max(1), (predicted.h.round() as usize).max(1));
    let reach = ((WITHIN * predicted.area().sqrt()).ceil() as usize).max(1);
    let corner = (predicted.x.round() as i64 - reach as i64, predicted.y.round() as i64 - reach as i64);
    let sums = Sums::of(mask, corner, w + 2 * reach, h + 2 * reach, others);
    let off = |place: usize| place as f64 - reach as f64;
    let mut best = (f64::NEG_INFINITY, reach, reach);
    for row in 0..=2 * reach {
        for column in 0..=2 * reach {
            let distance = off(column).powi(2) + off(row).powi(2);
            let score = sums.over(&sums.worth, column, row, w, h) - PULL * distance;
            if score > best.0 {
                best = (score, column, row);
            }
        }
    }
    let (_, column, row) = best;
    let foreground = sums.over(&sums.foreground, column, row, w, h);
    (predicted.translated(off(column), off(row)), foreground / (w * h) as f64)
}

/// Sums over what is above and left of each corner of a window's cells.
struct Sums {
    stride: usize,
    worth: Vec<f64>,
    foreground: Vec<f64>,
}

impl Sums {
    fn of(mask: &GrayImage, (left, top): (i64, i64), columns: usize, rows: usize, others: &[Rect]) -> Self {
        let stride = columns + 1;
        let mut sums = Self {
            stride,
            worth: vec![0.0; stride * (rows + 1)],
            foreground: vec![0.0; stride * (rows + 1)],
        };
        for row in 0..rows {
            let (mut worth, mut foreground) = (0.0, 0.0);
            for column in 0..columns {
                let (x, y) = (left + column as i64, top + row as i64);
                let inside =
                    (0..i64::from(mask.width())).contains(&x) && (0..i64::from(mask.height())).contains(&y);
                if inside {
                    let is_foreground = mask.get_pixel(x as u32, y as u32).0[0] == FOREGROUND;
                    worth += match is_foreground {
                        true if holds(others, x, y) => EXPLAINED,
                        true => 1.0,
                        false => EMPTY,
                    };
                    foreground += f64::from(u8::from(is_foreground));
                }
                let at = (row + 1) * stride + column + 1;
                sums.worth[at] = sums.worth[at - stride] + worth;
                sums.foreground[at] = sums.foreground[at - stride] + foreground;
            }
        }
        sums
    }

    fn over(&self, sums: &[f64], column: usize, row: usize, w: usize, h: usize) -> f64 {
        let at = |column: usize, row: usize| sums[row * self.stride + column];
        at(column + w, row + h) + at(column, row) - at(column + w, row) - at(column, row + h)
    }
}

fn holds(boxes: &[Rect], x: i64, y: i64) -> bool {
    let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
    boxes.iter().any(|area| x > area.x && x < area.right() && y > area.y && y < area.bottom())
}

#[cfg(test)]
mod tests {
    use image::Luma;

    use super::*;

    fn mask(width: std::ops::Range<u32>) -> GrayImage {
        GrayImage::from_fn(60, 40, |x, y| {
            Luma([if width.contains(&x) && (10..30).contains(&y) { FOREGROUND } else { 0 }])
        })
    }

    #[test]
    fn a_box_moves_onto_its_object_and_stays_off_what_another_explains() {
        let predicted = Rect::new(12.0, 11.0, 8.0, 20.0);
        let (found, filled) = fit(&mask(10..18), &predicted, &[]);
        assert_eq!((found, filled), (Rect::new(10.0, 10.0, 8.0, 20.0), 1.0));
        // Two side by side in one region: the other has the right half.
        let other = Rect::new(18.0, 10.0, 8.0, 20.0);
        let (found, filled) = fit(&mask(10..26), &predicted, &[other]);
        assert_eq!((found, filled), (Rect::new(10.0, 10.0, 8.0, 20.0), 1.0));
        let (_, filled) = fit(&mask(40..48), &predicted, &[]);
        assert_eq!(filled, 0.0);
    }

    #[test]
    fn a_box_that_reaches_beyond_the_border_is_fitted_by_what_is_inside() {
        let (found, filled) = fit(&mask(0..4), &Rect::new(-3.0, 10.0, 8.0, 20.0), &[]);
        assert_eq!((found.x, found.y, filled), (-4.0, 10.0, 0.5));
    }
}
