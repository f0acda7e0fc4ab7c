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
    averager: Averager,
    majority: Majority,
    mask: CellMask,
}

impl Foreground {
    pub(super) fn new(parameters: &CheckedObjectParameters) -> Self {
        Self {
            model: BackgroundModel::new(parameters.background()),
            parameters: parameters.clone(),
            averager: Averager::default(),
            majority: Majority::default(),
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
        if columns == 0 || rows == 0 {
            return Err(BackgroundError::TooLarge { width: frame.width(), height: frame.height() });
        }
        let averaged = self.averager.average(frame, side, columns, rows);
        // The buffer was made for this size.
        let Ok(view) = FrameView::new(averaged, columns, rows, 3 * columns, PixelFormat::Rgb) else {
            return Err(BackgroundError::TooLarge { width: columns, height: rows });
        };
        let raw = self.model.apply_guided(view, guide)?;
        self.mask.side = side;
        let foreground = self.majority.clean(raw, &mut self.mask.cells);
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

/// Step 1, in buffers that stay.
#[derive(Debug, Default)]
struct Averager {
    /// The sums of a row of cells, down each column of a channel.
    sums: Vec<u32>,
    /// Red, green and blue of each cell, row by row.
    averaged: Vec<u8>,
}

impl Averager {
    /// The cells' means. Pixels beyond the last whole cell are left out.
    fn average(&mut self, frame: FrameView<'_>, side: usize, columns: usize, rows: usize) -> &[u8] {
        let bytes = frame.format().bytes_per_pixel();
        let used = columns * side * bytes;
        self.averaged.resize(3 * columns * rows, 0);
        self.sums.resize(used, 0);
        for (row, cells) in self.averaged.chunks_exact_mut(3 * columns).enumerate() {
            self.sums.fill(0);
            for y in row * side..(row + 1) * side {
                for (sum, value) in self.sums.iter_mut().zip(&frame.row(y)[..used]) {
                    *sum += u32::from(*value);
                }
            }
            let channels = frame.format().rgb_offsets();
            // The usual cases have their sizes known, so that their loops are unrolled.
            match (bytes, side) {
                (3, 1) => sum_across(&self.sums, 3, 1, channels, cells),
                (3, 2) => sum_across(&self.sums, 3, 2, channels, cells),
                (3, 4) => sum_across(&self.sums, 3, 4, channels, cells),
                _ => sum_across(&self.sums, bytes, side, channels, cells),
            }
        }
        &self.averaged
    }
}

/// The means of a row of cells from the sums down their columns.
#[inline(always)]
fn sum_across(sums: &[u32], bytes: usize, side: usize, channels: [usize; 3], cells: &mut [u8]) {
    let area = (side * side) as u32;
    for (cell, sums) in cells.chunks_exact_mut(3).zip(sums.chunks_exact(side * bytes)) {
        for (mean, channel) in cell.iter_mut().zip(channels) {
            let sum: u32 = (0..side).map(|pixel| sums[pixel * bytes + channel]).sum();
            *mean = ((sum + area / 2) / area) as u8;
        }
    }
}

/// Step 3, in buffers that stay.
#[derive(Debug, Default)]
struct Majority {
    /// For each cell of three rows whether it is foreground, with a cell of none at both ends.
    rows: [Vec<u8>; 3],
    /// The same, summed over the three rows.
    down: Vec<u8>,
}

impl Majority {
    /// Gives the raw foreground's cells. Beyond the border is no foreground, and the cells there are fewer.
    fn clean(&mut self, raw: &GrayImage, cleaned: &mut GrayImage) -> usize {
        let (width, height) = (raw.width() as usize, raw.height() as usize);
        if cleaned.dimensions() != raw.dimensions() {
            *cleaned = GrayImage::new(raw.width(), raw.height());
        }
        for row in self.rows.iter_mut().chain([&mut self.down]) {
            row.clear();
            row.resize(width + 2, 0);
        }
        let ([above, here, below], down) = (&mut self.rows, &mut self.down);
        let mut rows = raw.chunks_exact(width);
        mark(rows.next(), here);
        let mut total = 0;
        for (y, out) in cleaned.chunks_exact_mut(width).enumerate() {
            mark(rows.next(), below);
            total += here.iter().map(|&cell| usize::from(cell)).sum::<usize>();
            for (sum, ((above, here), below)) in down.iter_mut().zip(above.iter().zip(&*here).zip(&*below)) {
                *sum = above + here + below;
            }
            let is_foreground = |around: &[u8], needed: u8| match around[0] + around[1] + around[2] >= needed
            {
                true => FOREGROUND,
                false => 0,
            };
            let needed = if y == 0 || y + 1 == height { NEEDED_AT_BORDER } else { NEEDED };
            for (cell, around) in out.iter_mut().zip(down.windows(3)) {
                *cell = is_foreground(around, needed);
            }
            for x in [0, width - 1] {
                out[x] = is_foreground(&down[x..], NEEDED_AT_BORDER);
            }
            std::mem::swap(above, here);
            std::mem::swap(here, below);
        }
        total
    }
}

/// Cells of foreground around a cell, itself among them, that make it foreground; at the border.
const NEEDED: u8 = 5;
const NEEDED_AT_BORDER: u8 = 3;

/// Marks the cells of a row of the raw mask; of none beyond the last.
fn mark(raw: Option<&[u8]>, marks: &mut [u8]) {
    let inner = marks.len() - 1;
    match raw {
        Some(raw) => {
            for (mark, &cell) in marks[1..inner].iter_mut().zip(raw) {
                *mark = u8::from(cell == FOREGROUND);
            }
        }
        None => marks.fill(0),
    }
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
        let mut averager = Averager::default();
        assert_eq!(averager.average(frame, 2, 2, 2), [15, 15, 15, 40, 40, 40, 15, 15, 15, 40, 40, 40]);
    }

    proptest! {
        #[test]
        fn means_are_those_of_summing_each_cell_by_itself(
            bytes in prop::collection::vec(any::<u8>(), 4 * 17 * 13), side in 1usize..=5, which in 0usize..5
        ) {
            use PixelFormat::*;
            let format = [Gray, Rgb, Bgr, Rgba, Bgra][which];
            let deep = format.bytes_per_pixel();
            let frame = FrameView::new(&bytes[..deep * 17 * 13], 17, 13, deep * 17, format).unwrap();
            let (columns, rows) = (17 / side, 13 / side);
            let mut averager = Averager::default();
            let averaged = averager.average(frame, side, columns, rows);
            prop_assert_eq!(averaged.len(), 3 * columns * rows);
            for (place, &mean) in averaged.iter().enumerate() {
                let (cell, channel) = (place / 3, format.rgb_offsets()[place % 3]);
                let (left, top) = (cell % columns * side, cell / columns * side);
                let pixels = (top..top + side).flat_map(|y| (left..left + side).map(move |x| (x, y)));
                let sum: usize = pixels.map(|(x, y)| usize::from(frame.row(y)[x * deep + channel])).sum();
                prop_assert_eq!(usize::from(mean), (sum + side * side / 2) / (side * side));
            }
        }

        #[test]
        fn a_cell_is_what_most_around_it_are(cells in prop::collection::vec(any::<bool>(), 9 * 7)) {
            let raw = GrayImage::from_fn(9, 7, |x, y| Luma([255 * u8::from(cells[(y * 9 + x) as usize])]));
            let mut cleaned = GrayImage::default();
            let total = Majority::default().clean(&raw, &mut cleaned);
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
