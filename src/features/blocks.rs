//! Integral images of a search region with entries for blocks of cells only: what a coarse grid needs of a wide window.
//!
//! Steps, each frame:
//! 1. cut the cells of a band of rows out of the frame (`cells.rs`), with a row more on either side,
//! 2. along each row of cells, running sums of the gradients' 8 orientations (`gradient.rs`) and of the
//!    colours, read at each block's right edge and added up over the rows of a block,
//! 3. added up over the blocks above.
//!
//! All sums are whole numbers and exact. Bands go through steps 1 and 2 in parallel.

use multiversion::multiversion;

use crate::{
    frame::FrameView,
    parallel::{ChunksMut, for_each},
};

use super::{
    cells::{CHANNELS, Cells},
    gradient::{BINS, GradientRows},
    search_region::SearchRegion,
};

/// Numbers of an entry: the orientations' sums, those of red, green and blue, and one that is always 0.
pub(crate) const LANES: usize = BINS + CHANNELS + 1;

/// Rows of blocks that a thread sums at a time.
const ROWS_PER_BAND: usize = 16;

/// Integral images of blocks of cells. Reused from frame to frame.
#[derive(Debug, Clone)]
pub struct BlockIntegrals {
    region: SearchRegion,
    block: usize,
    sums: Vec<[u32; LANES]>,
    bands: Vec<Band>,
}

/// Scratch of a band of rows.
#[derive(Debug, Clone, Default)]
struct Band {
    cells: Cells,
    gradients: GradientRows,
    /// Running sums along a row of cells, up to and with each.
    running: Vec<[u32; LANES]>,
}

impl Default for BlockIntegrals {
    fn default() -> Self {
        Self { region: SearchRegion::NOTHING, block: 1, sums: Vec::new(), bands: Vec::new() }
    }
}

impl BlockIntegrals {
    /// The region that was computed last.
    pub fn region(&self) -> SearchRegion {
        self.region
    }

    /// Cells along a block's side.
    pub fn block(&self) -> usize {
        self.block
    }

    /// Columns and rows of blocks.
    pub fn size(&self) -> (usize, usize) {
        (self.region.width / self.block, self.region.height / self.block)
    }

    /// Computes the sums of a region, which is widened to whole blocks of `block` x `block` cells, `block` >= 1 (steps 1 to
    /// 3). Allocates only when the region outgrows all before it.
    pub fn compute(&mut self, frame: &FrameView<'_>, region: SearchRegion, block: usize) {
        let whole = |cells: usize| cells.div_ceil(block) * block;
        let region = SearchRegion { width: whole(region.width), height: whole(region.height), ..region };
        (self.region, self.block) = (region, block);
        let (columns, rows) = self.size();
        let stride = columns + 1;
        self.sums.resize(stride * (rows + 1), [0; LANES]);
        self.bands.resize_with(rows.div_ceil(ROWS_PER_BAND), Band::default);
        let (top, sums) = self.sums.split_at_mut(stride);
        top.fill([0; LANES]);
        let bands = (ChunksMut(sums, ROWS_PER_BAND * stride), self.bands.as_mut_slice());
        for_each(bands, 1, |number, (sums, band)| {
            band.sum(frame, (region, block), number * ROWS_PER_BAND, sums);
        });
        self.add_above(stride);
    }

    /// Step 3.
    fn add_above(&mut self, stride: usize) {
        let mut rest = self.sums.as_mut_slice();
        while rest.len() > stride {
            let (above, below) = rest.split_at_mut(stride);
            for (out, up) in below.iter_mut().zip(above.iter()) {
                out.iter_mut().zip(up).for_each(|(out, up)| *out += up);
            }
            rest = below;
        }
    }

    /// The entry of the blocks above row `row` and left of column `column`.
    #[inline]
    pub(crate) fn entry(&self, row: usize, column: usize) -> &[u32; LANES] {
        &self.sums[row * (self.region.width / self.block + 1) + column]
    }
}

impl Band {
    /// Steps 1 and 2 for the rows of blocks from `first` on, whose entries are `sums`.
    fn sum(
        &mut self,
        frame: &FrameView<'_>,
        (region, block): (SearchRegion, usize),
        first: usize,
        sums: &mut [[u32; LANES]],
    ) {
        let width = region.width;
        let stride = width / block + 1;
        let (top, height) = (first * block, sums.len() / stride * block);
        // The gradients of the outer rows need the neighbouring bands' rows.
        let above = usize::from(top > 0);
        let below = usize::from(top + height < region.height);
        let Self { cells, gradients, running } = self;
        cells.cut(
            frame,
            SearchRegion {
                y: region.y + ((top - above) * region.step) as i64,
                height: above + height + below,
                ..region
            },
        );
        let planes = cells.planes();
        let colours: [&[u8]; CHANNELS] =
            std::array::from_fn(|channel| planes[channel.min(planes.len() - 1)].as_slice());
        running.resize(width, [0; LANES]);
        sums.fill([0; LANES]);
        gradients.for_each(cells, above..above + height, |row, gradients| {
            add_up(running, gradients, colours.map(|plane| &plane[row * width..][..width]));
            let line = &mut sums[(row - above) / block * stride + 1..][..stride - 1];
            for (out, edge) in line.iter_mut().zip(running.iter().skip(block - 1).step_by(block)) {
                out.iter_mut().zip(edge).for_each(|(out, sum)| *out += sum);
            }
        });
    }
}

/// Running sums of a row's gradients and colours. Compiled for processors with and without AVX2.
#[multiversion(targets("x86_64+avx2"))]
fn add_up(running: &mut [[u32; LANES]], gradients: &GradientRows, [red, green, blue]: [&[u8]; CHANNELS]) {
    let mut bins = [0; BINS];
    let mut colours = [0u32; LANES - BINS];
    let cells = gradients.of(0..running.len()).zip(red).zip(green).zip(blue);
    for (out, (((gradient, &red), &green), &blue)) in running.iter_mut().zip(cells) {
        gradient.add_to(&mut bins);
        colours[0] += u32::from(red);
        colours[1] += u32::from(green);
        colours[2] += u32::from(blue);
        out[..BINS].copy_from_slice(&bins);
        out[BINS..].copy_from_slice(&colours);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        features::{reference, region::RegionIntegrals},
        frame::PixelFormat,
    };

    #[test]
    fn entries_are_those_of_the_full_integral_images_at_the_blocks_corners() {
        for format in [PixelFormat::Gray, PixelFormat::Rgb] {
            let frame = reference::textured_frame(97, 120, format);
            for (block, step) in [(1, 1), (2, 1), (3, 1), (5, 2)] {
                let region = SearchRegion { x: -7, y: 5, width: 71, height: 90, step };
                let (mut blocks, mut all) = (BlockIntegrals::default(), RegionIntegrals::default());
                blocks.compute(&frame.view(), region, block);
                let (columns, rows) = blocks.size();
                assert!(columns * block >= 71 && rows * block >= 90);
                all.compute(&frame.view(), blocks.region());
                for row in 0..=rows {
                    for column in 0..=columns {
                        let at = row * block * all.stride() + column * block;
                        let entry = blocks.entry(row, column);
                        assert_eq!(entry[..BINS], all.orientation()[at], "{block}: {row}, {column}");
                        for channel in 0..CHANNELS {
                            assert_eq!(entry[BINS + channel], all.colour(channel)[at]);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn what_was_computed_before_leaves_no_trace() {
        let frame = reference::textured_frame(60, 60, PixelFormat::Rgb);
        let small = SearchRegion { x: 3, y: 4, width: 20, height: 22, step: 1 };
        let mut fresh = BlockIntegrals::default();
        fresh.compute(&frame.view(), small, 2);
        let mut used = BlockIntegrals::default();
        used.compute(&frame.view(), SearchRegion { x: 0, y: 0, width: 60, height: 60, step: 1 }, 3);
        used.compute(&frame.view(), small, 2);
        let (columns, rows) = fresh.size();
        for row in 0..=rows {
            for column in 0..=columns {
                assert_eq!(fresh.entry(row, column), used.entry(row, column));
            }
        }
    }
}
