//! What moves, as cells: squares of pixels, each foreground or not.
//!
//! Steps, each frame:
//! 1. The frame is averaged over cells, so that at most [`MOST_CELLS`] are left: noise falls and so does the cost.
//! 2. The background model tells foreground, shadow and background apart; it learns as the guide says ([`Learning`]).
//! 3. A cell is foreground if most of the 3 x 3 cells around it are: specks go, gaps of a cell close, borders stay. If it was
//!    asked for, the mask is then opened and closed.
//! 4. Outside the regions of interest nothing is foreground.

use image::GrayImage;
use infopart::{
    background::{BackgroundError, BackgroundModel, FOREGROUND, Learning, MaskCleaner},
    frame::{FrameView, PixelFormat},
    geometry::Rect,
};

use super::CheckedObjectParameters;

/// Cells that a frame is cut into, at most.
const MOST_CELLS: usize = 160_000;

/// Which cells are foreground.
#[derive(Debug, Clone, Default)]
pub(super) struct CellMask {
    /// Pixels of a cell's side.
    pub side: usize,
    /// [`FOREGROUND`] or 0 for each cell.
    pub cells: GrayImage,
}

/// Finds what moves.
#[derive(Debug)]
pub(super) struct Foreground {
    model: BackgroundModel,
    parameters: CheckedObjectParameters,
    averaged: Vec<u8>,
    mask: CellMask,
}

impl Foreground {
    pub(super) fn new(parameters: &CheckedObjectParameters) -> Self {
        Self {
            model: BackgroundModel::new(parameters.background()),
            parameters: parameters.clone(),
            averaged: Vec::new(),
            mask: CellMask::default(),
        }
    }

    pub(super) fn mask(&self) -> &CellMask {
        &self.mask
    }

    /// Steps 1 to 4. Gives the share of raw foreground.
    pub(super) fn apply(&mut self, frame: FrameView<'_>, guide: &[Learning]) -> Result<f64, BackgroundError> {
        let side = cell_side(frame.width(), frame.height());
        let (columns, rows) = (frame.width() / side, frame.height() / side);
        average(frame, side, columns, rows, &mut self.averaged);
        // The buffer was made for this size.
        let Ok(view) = FrameView::new(&self.averaged, columns, rows, 3 * columns, PixelFormat::Rgb) else {
            return Err(BackgroundError::TooLarge { width: columns, height: rows });
        };
        let raw = self.model.apply_guided(view, guide)?;
        self.mask.side = side;
        let foreground = majority(raw, &mut self.mask.cells);
        if let Some(clean_up) = self.parameters.clean_up(side) {
            self.mask.cells = MaskCleaner::new(clean_up).clean(&self.mask.cells);
        }
        if !self.parameters.regions_in_frame.is_empty() {
            self.mask.keep(&self.parameters.regions_in_frame);
        }
        Ok(foreground as f64 / (columns * rows).max(1) as f64)
    }
}

/// The smallest side of cells that are few enough.
pub(super) fn cell_side(width: usize, height: usize) -> usize {
    (1..).find(|side| (width / side) * (height / side) <= MOST_CELLS).unwrap_or(1)
}

/// Step 1. Pixels beyond the last whole cell are left out.
fn average(frame: FrameView<'_>, side: usize, columns: usize, rows: usize, averaged: &mut Vec<u8>) {
    let (bytes, offsets) = (frame.format().bytes_per_pixel(), frame.format().rgb_offsets());
    averaged.clear();
    averaged.reserve(3 * columns * rows);
    let mut sums = vec![[0u32; 3]; columns];
    let area = (side * side) as u32;
    for row in 0..rows {
        sums.fill([0; 3]);
        for y in row * side..(row + 1) * side {
            let line = &frame.row(y)[..columns * side * bytes];
            for (sum, cell) in sums.iter_mut().zip(line.chunks_exact(side * bytes)) {
                for pixel in cell.chunks_exact(bytes) {
                    for (sum, offset) in sum.iter_mut().zip(offsets) {
                        *sum += u32::from(pixel[offset]);
                    }
                }
            }
        }
        averaged.extend(sums.iter().flatten().map(|sum| ((sum + area / 2) / area) as u8));
    }
}

/// Step 3; gives the raw foreground's cells. Beyond the border is no foreground, and the cells there are fewer.
fn majority(raw: &GrayImage, cleaned: &mut GrayImage) -> usize {
    let (width, height) = (raw.width() as usize, raw.height() as usize);
    if cleaned.dimensions() != raw.dimensions() {
        *cleaned = GrayImage::new(raw.width(), raw.height());
    }
    let is_foreground = |row: usize, x: usize| u8::from(raw.as_raw()[row * width + x] == FOREGROUND);
    // How many of three cells across, for each row.
    let across = |row: usize, counts: &mut Vec<u8>| {
        counts.clear();
        counts.extend((0..width).map(|x| {
            let left = if x > 0 { is_foreground(row, x - 1) } else { 0 };
            let right = if x + 1 < width { is_foreground(row, x + 1) } else { 0 };
            left + is_foreground(row, x) + right
        }));
    };
    let mut total = 0;
    let (mut above, mut here, mut below) = (vec![0; width], Vec::new(), Vec::new());
    across(0, &mut here);
    for y in 0..height {
        if y + 1 < height {
            across(y + 1, &mut below)
        } else {
            below.clear();
            below.resize(width, 0)
        }
        for x in 0..width {
            total += usize::from(is_foreground(y, x));
            let is_border = x == 0 || y == 0 || x + 1 == width || y + 1 == height;
            let needed = if is_border { 3 } else { 5 };
            (**cleaned)[y * width + x] = if above[x] + here[x] + below[x] >= needed { FOREGROUND } else { 0 };
        }
        std::mem::swap(&mut above, &mut here);
        std::mem::swap(&mut here, &mut below);
    }
    total
}

impl CellMask {
    /// Step 4: a cell is in a region if its centre is.
    fn keep(&mut self, regions_in_frame: &[Rect]) {
        let side = self.side as f64;
        for (x, y, cell) in self.cells.enumerate_pixels_mut() {
            let (x, y) = ((f64::from(x) + 0.5) * side, (f64::from(y) + 0.5) * side);
            let inside = |area: &Rect| x > area.x && x < area.right() && y > area.y && y < area.bottom();
            if !regions_in_frame.iter().any(inside) {
                cell.0[0] = 0;
            }
        }
    }

    /// A box of the frame in cells.
    pub(super) fn to_cells(&self, in_frame: &Rect) -> Rect {
        let side = self.side as f64;
        Rect::new(in_frame.x / side, in_frame.y / side, in_frame.w / side, in_frame.h / side)
    }

    /// A box of cells in the frame.
    pub(super) fn to_frame(&self, in_cells: &Rect) -> Rect {
        let side = self.side as f64;
        Rect::new(in_cells.x * side, in_cells.y * side, in_cells.w * side, in_cells.h * side)
    }
}

#[cfg(test)]
mod tests {
    use image::Luma;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn cells_are_means_of_whole_squares_and_large_pictures_have_larger_ones() {
        assert_eq!([(320, 240), (768, 576), (1920, 1080)].map(|(w, h)| cell_side(w, h)), [1, 2, 4]);
        // 5 x 4 pixels, cells of 2: the fifth column is left out.
        let pixels: Vec<u8> = (0..20).map(|i| [10, 20, 30, 50, 255][i % 5]).collect();
        let frame = FrameView::new(&pixels, 5, 4, 5, PixelFormat::Gray).unwrap();
        let mut averaged = Vec::new();
        average(frame, 2, 2, 2, &mut averaged);
        assert_eq!(averaged, [15, 15, 15, 40, 40, 40, 15, 15, 15, 40, 40, 40]);
    }

    proptest! {
        #[test]
        fn a_cell_is_what_most_around_it_are(cells in prop::collection::vec(any::<bool>(), 9 * 7)) {
            let raw = GrayImage::from_fn(9, 7, |x, y| Luma([255 * u8::from(cells[(y * 9 + x) as usize])]));
            let mut cleaned = GrayImage::default();
            let total = majority(&raw, &mut cleaned);
            prop_assert_eq!(total, cells.iter().filter(|&&cell| cell).count());
            for (x, y, cell) in cleaned.enumerate_pixels() {
                let around = |a: u32, most: u32| a.saturating_sub(1)..(a + 2).min(most);
                let near = around(y, 7).flat_map(|j| around(x, 9).map(move |i| (i, j)));
                let count = near.filter(|&(i, j)| cells[(j * 9 + i) as usize]).count();
                let border = x == 0 || y == 0 || x == 8 || y == 6;
                prop_assert_eq!(cell.0[0] == FOREGROUND, count >= if border { 3 } else { 5 });
            }
        }
    }
}
