//! From a raw mask to one of whole objects.
//!
//! Steps:
//! 1. foreground only: shadows become background,
//! 2. opening by a square removes specks,
//! 3. closing by a larger square joins the parts of an object,
//! 4. holes, background that no path of background links to the border, are filled.

use image::GrayImage;
use serde::{Deserialize, Serialize};

use super::{
    BACKGROUND, BackgroundError, Blob, FOREGROUND, blobs, check_range, morphology::spread, regions::runs,
};

/// How a mask is cleaned. The defaults are those of the well-known MATLAB example of tracking in atrium.mp4.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CleanUp {
    /// Side of the opening's square, pixels: odd, from 1 (no opening) to 255.
    pub opening: usize,
    /// Side of the closing's square, pixels: odd, from 1 (no closing) to 255.
    pub closing: usize,
    /// Whether holes are filled.
    pub fill_holes: bool,
    /// Smallest area of a blob, pixels.
    pub min_area: usize,
}

impl Default for CleanUp {
    fn default() -> Self {
        Self { opening: 3, closing: 15, fill_holes: true, min_area: 400 }
    }
}

impl CleanUp {
    /// Checks every value; only what passes can run.
    ///
    /// # Errors
    /// [`BackgroundError::OutOfRange`] or [`BackgroundError::EvenSide`], naming the key.
    pub fn check(self) -> Result<CheckedCleanUp, BackgroundError> {
        for (key, given) in [("opening", self.opening), ("closing", self.closing)] {
            check_range(key, given as f64, 1.0, 255.0)?;
            if given % 2 == 0 {
                return Err(BackgroundError::EvenSide { key, given });
            }
        }
        Ok(CheckedCleanUp(self))
    }
}

/// A clean-up that has passed [`CleanUp::check`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CheckedCleanUp(CleanUp);

impl std::ops::Deref for CheckedCleanUp {
    type Target = CleanUp;

    fn deref(&self) -> &CleanUp {
        &self.0
    }
}

/// Cleans masks and finds their blobs.
#[derive(Debug, Clone, Default)]
pub struct MaskCleaner {
    clean_up: CheckedCleanUp,
}

impl MaskCleaner {
    /// A cleaner that works so.
    pub fn new(clean_up: CheckedCleanUp) -> Self {
        Self { clean_up }
    }

    /// How it cleans.
    pub fn clean_up(&self) -> &CheckedCleanUp {
        &self.clean_up
    }

    /// Steps 1 to 4: a mask of [`BACKGROUND`] and [`FOREGROUND`]. Beyond the border is neither: it adds nothing to an
    /// object and takes nothing away.
    pub fn clean(&self, raw: &GrayImage) -> GrayImage {
        let mut mask = raw.clone();
        for value in mask.iter_mut() {
            *value = if *value == FOREGROUND { FOREGROUND } else { BACKGROUND };
        }
        // A square of 2 k + 1 pixels is what is within k.
        let (opening, closing) = (self.clean_up.opening / 2, self.clean_up.closing / 2);
        spread(&mut mask, BACKGROUND, opening);
        spread(&mut mask, FOREGROUND, opening);
        spread(&mut mask, FOREGROUND, closing);
        spread(&mut mask, BACKGROUND, closing);
        if self.clean_up.fill_holes {
            fill_holes(&mut mask);
        }
        mask
    }

    /// The 8-connected regions of a cleaned mask that are large enough, in the order of their first pixels, row by row.
    pub fn blobs(&self, cleaned: &GrayImage) -> Vec<Blob> {
        blobs::find(cleaned, self.clean_up.min_area)
    }
}

/// Step 4. Background is 4-connected where objects are 8-connected.
fn fill_holes(mask: &mut GrayImage) {
    let (width, height) = mask.dimensions();
    let runs = runs(mask, BACKGROUND, false);
    let mut touches_border = vec![false; runs.len()];
    for run in &runs {
        let at_border = run.row == 0 || run.row + 1 == height || run.start == 0 || run.end == width;
        touches_border[run.region] |= at_border;
    }
    for run in runs.iter().filter(|run| !touches_border[run.region]) {
        let row = run.row as usize * width as usize;
        (**mask)[row + run.start as usize..row + run.end as usize].fill(FOREGROUND);
    }
}

#[cfg(test)]
mod tests {
    use image::Luma;

    use super::*;
    use crate::background::SHADOW;
    use proptest::prelude::*;

    fn mask(rows: &[&str]) -> GrayImage {
        let value = |letter: u8| match letter {
            b'#' => FOREGROUND,
            b's' => SHADOW,
            _ => BACKGROUND,
        };
        GrayImage::from_fn(rows[0].len() as u32, rows.len() as u32, |x, y| {
            Luma([value(rows[y as usize].as_bytes()[x as usize])])
        })
    }

    fn cleaner(opening: usize, closing: usize, fill_holes: bool) -> MaskCleaner {
        MaskCleaner::new(CleanUp { opening, closing, fill_holes, min_area: 1 }.check().unwrap())
    }

    #[test]
    fn specks_and_shadows_go_gaps_close_and_holes_fill() {
        let rows = |first, object, gap| {
            let mut rows = vec![first, ".............", object, gap, object];
            rows.extend(["............."; 2]);
            mask(&rows)
        };
        let raw = rows("#.........sss", "...###.###...", "...###.###...");
        let opened = rows(".............", "...###.###...", "...###.###...");
        assert_eq!(cleaner(3, 1, false).clean(&raw), opened);
        let closed = rows(".............", "...#######...", "...#######...");
        assert_eq!(cleaner(3, 3, false).clean(&raw), closed);
        let ring = mask(&["####...", "#..####", "##.#..#", "####..#", "...####"]);
        let filled = mask(&["####...", "#######", "#######", "#######", "...####"]);
        assert_eq!(cleaner(1, 1, true).clean(&ring), filled);
        // A hole is closed off by diagonal neighbours too, and open where it reaches the border.
        let diamond = mask(&[".#.", "#.#", ".#."]);
        assert_eq!(cleaner(1, 1, true).clean(&diamond), mask(&[".#.", "###", ".#."]));
        let cup = mask(&["#.#", "#.#", "###"]);
        assert_eq!(cleaner(1, 1, true).clean(&cup), cup);
    }

    #[test]
    fn even_and_huge_sides_are_refused() {
        let even = CleanUp { opening: 4, ..CleanUp::default() }.check().unwrap_err();
        assert_eq!(even.to_string(), "`opening` is 4 but must be odd: give 3 or 5");
        let huge = CleanUp { closing: 301, ..CleanUp::default() }.check().unwrap_err();
        assert!(huge.to_string().contains("`closing` is 301"));
    }

    /// Erosion (`value` = FOREGROUND) or dilation (BACKGROUND) by a square, pixel by pixel.
    fn naive(mask: &GrayImage, reach: i64, all: u8) -> GrayImage {
        GrayImage::from_fn(mask.width(), mask.height(), |x, y| {
            let near = |a: i64, b: i64| (a - reach).max(0)..(a + reach + 1).min(b);
            let mut cells = near(i64::from(y), i64::from(mask.height()))
                .flat_map(|j| near(i64::from(x), i64::from(mask.width())).map(move |i| (i, j)));
            let same = cells.all(|(i, j)| mask.get_pixel(i as u32, j as u32).0[0] == all);
            Luma([if same == (all == FOREGROUND) { FOREGROUND } else { BACKGROUND }])
        })
    }

    proptest! {
        #[test]
        fn morphology_is_that_of_squares(cells in prop::collection::vec(any::<bool>(), 17 * 11), reach in 1usize..4) {
            let raw = GrayImage::from_fn(17, 11, |x, y| Luma([255 * u8::from(cells[(y * 17 + x) as usize])]));
            let side = 2 * reach + 1;
            let k = reach as i64;
            let opened = naive(&naive(&raw, k, FOREGROUND), k, BACKGROUND);
            prop_assert_eq!(cleaner(side, 1, false).clean(&raw), opened);
            let closed = naive(&naive(&raw, k, BACKGROUND), k, FOREGROUND);
            prop_assert_eq!(cleaner(1, side, false).clean(&raw), closed);
        }
    }
}
