//! The cells of a search region, cut out of a frame.
//!
//! Edge pixels are repeated outside the frame. A cell is the mean of its `step` x `step` pixels, or of 4 x 4 of them evenly
//! spaced where there are more, so that the cost follows the cells and not the pixels.

use std::ops::Range;

use crate::frame::{FrameView, PixelFormat};

use super::search_region::SearchRegion;

/// Colour channels that features may read.
pub const CHANNELS: usize = 3;

/// Pixels along a cell's side that are averaged at most.
const MOST_SAMPLES: usize = 4;

/// Cells of a region, a plane a colour channel. Reused from frame to frame.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    region: SearchRegion,
    channels: usize,
    planes: [Vec<u8>; CHANNELS],
    /// Sums of the samples of a row of cells.
    sums: Vec<u16>,
}

impl Default for Cells {
    fn default() -> Self {
        Self { region: SearchRegion::NOTHING, channels: 1, planes: Default::default(), sums: Vec::new() }
    }
}

impl Cells {
    /// The region that was cut last.
    pub fn region(&self) -> SearchRegion {
        self.region
    }

    /// Colour channels: 1 for a grey frame, else 3.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// The planes: rows one after another, `channels` planes.
    pub fn planes(&self) -> &[Vec<u8>] {
        &self.planes[..self.channels]
    }

    /// Cuts `region` out of a frame.
    pub fn cut(&mut self, frame: &FrameView<'_>, region: SearchRegion) {
        self.region = region;
        self.channels = if frame.format() == PixelFormat::Gray { 1 } else { CHANNELS };
        for plane in &mut self.planes[..self.channels] {
            plane.resize(region.width * region.height, 0);
        }
        match region.step {
            1 => self.cut_pixels(frame),
            2 => self.cut_averages::<2>(frame),
            3 => self.cut_averages::<3>(frame),
            _ => self.cut_averages::<MOST_SAMPLES>(frame),
        }
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
                let cells = &mut self.planes[channel][row * width..][..width];
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

    /// Cells of `step` pixels, `SAMPLES` of which are read along each side.
    fn cut_averages<const SAMPLES: usize>(&mut self, frame: &FrameView<'_>) {
        let SearchRegion { y, width, step, .. } = self.region;
        let columns = Columns::<SAMPLES>::of(frame, self.region);
        let last_y = frame.height() as i64 - 1;
        let count = (SAMPLES * SAMPLES) as u16;
        let Self { planes, sums, channels, .. } = self;
        sums.resize(width, 0);
        for (plane, offset) in planes.iter_mut().zip(frame.format().rgb_offsets()).take(*channels) {
            for (row, cells) in plane.chunks_exact_mut(width).enumerate() {
                sums.fill(0);
                for dy in columns.samples {
                    let y = (y + (row * step + dy) as i64).clamp(0, last_y) as usize;
                    columns.add(frame.row(y), offset, sums);
                }
                for (cell, sum) in cells.iter_mut().zip(sums.iter()) {
                    *cell = ((sum + count / 2) / count) as u8;
                }
            }
        }
    }
}

/// Where the samples of a row of cells lie in a row of the frame.
struct Columns<const SAMPLES: usize> {
    region: SearchRegion,
    /// Bytes of a pixel.
    size: usize,
    /// The frame's last column.
    last_x: i64,
    /// Pixels from a cell's left edge to each sample; the same hold from its top.
    samples: [usize; SAMPLES],
    /// Cells that lie in the frame; the others repeat its edge.
    inside: Range<usize>,
}

impl<const SAMPLES: usize> Columns<SAMPLES> {
    fn of(frame: &FrameView<'_>, region: SearchRegion) -> Self {
        let SearchRegion { x, width, step, .. } = region;
        let last_x = frame.width() as i64 - 1;
        let cells_to = |pixels: i64| (pixels.max(0) as usize / step).min(width);
        let from = cells_to(step as i64 - 1 - x);
        Self {
            region,
            size: frame.format().bytes_per_pixel(),
            last_x,
            samples: std::array::from_fn(|i| (2 * i + 1) * step / (2 * SAMPLES)),
            inside: from..cells_to(last_x + 1 - x).max(from),
        }
    }

    /// Adds what the samples of a row of the frame have at `offset` of a pixel to the cells' sums.
    fn add(&self, pixels: &[u8], offset: usize, sums: &mut [u16]) {
        let Self { region: SearchRegion { x, step, .. }, size, inside, .. } = self;
        for column in (0..inside.start).chain(inside.end..sums.len()) {
            for dx in self.samples {
                let at = (x + (column * step + dx) as i64).clamp(0, self.last_x) as usize;
                sums[column] += u16::from(pixels[at * size + offset]);
            }
        }
        if inside.is_empty() {
            return;
        }
        let first = (x + (inside.start * step) as i64) as usize * size;
        let cells = pixels[first..][..inside.len() * step * size].chunks_exact(step * size);
        for (sum, cell) in sums[inside.clone()].iter_mut().zip(cells) {
            *sum += self.samples.iter().map(|dx| u16::from(cell[dx * size + offset])).sum::<u16>();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{features::reference, frame::Frame};
    use proptest::prelude::*;

    #[test]
    fn a_cell_of_two_by_two_pixels_is_their_rounded_mean() {
        let frame = Frame::new(vec![1, 2, 3, 4, 10, 20, 30, 43], 4, 2, PixelFormat::Gray).unwrap();
        let mut cells = Cells::default();
        cells.cut(&frame.view(), SearchRegion { x: 0, y: 0, width: 2, height: 1, step: 2 });
        assert_eq!(cells.planes(), [[8, 20]]);
    }

    #[test]
    fn a_cell_of_eight_by_eight_pixels_is_the_mean_of_sixteen_of_them() {
        let pixels: Vec<u8> = (0..64).map(|i| (i % 8 + i / 8 * 10) as u8).collect();
        let frame = Frame::new(pixels, 8, 8, PixelFormat::Gray).unwrap();
        let mut cells = Cells::default();
        cells.cut(&frame.view(), SearchRegion { x: 0, y: 0, width: 1, height: 1, step: 8 });
        // Columns and rows 1, 3, 5, 7.
        assert_eq!(cells.planes(), [[4 + 40]]);
    }

    proptest! {
        /// Pixel by pixel, wherever the region lies.
        #[test]
        fn cells_are_the_rounded_means_of_their_samples(
            (x, y) in (-40i64..60, -40i64..60), (width, height) in (1usize..12, 1usize..12), step in 2usize..10,
            format in prop::sample::select(vec![PixelFormat::Gray, PixelFormat::Rgb, PixelFormat::Bgra]),
        ) {
            let frame = reference::textured_frame(31, 23, format);
            let mut cells = Cells::default();
            cells.cut(&frame.view(), SearchRegion { x, y, width, height, step });
            let per_side = step.min(4);
            let sample = |cell: usize, i: usize| (cell * step + (2 * i + 1) * step / (2 * per_side)) as i64;
            for (channel, plane) in cells.planes().iter().enumerate() {
                for (at, found) in plane[..width * height].iter().enumerate() {
                    let (row, column) = (at / width, at % width);
                    let mut sum = 0;
                    for i in 0..per_side * per_side {
                        let (px, py) = (x + sample(column, i % per_side), y + sample(row, i / per_side));
                        sum += u32::from(reference::sample(&frame.view(), px, py)[channel]);
                    }
                    let count = (per_side * per_side) as u32;
                    prop_assert_eq!(u32::from(*found), (sum + count / 2) / count);
                }
            }
        }
    }

    #[test]
    fn beyond_the_frame_its_edge_is_repeated() {
        let frame = Frame::new(vec![1, 2, 3, 4, 5, 6], 3, 2, PixelFormat::Gray).unwrap();
        let mut cells = Cells::default();
        cells.cut(&frame.view(), SearchRegion { x: -1, y: 1, width: 5, height: 2, step: 1 });
        assert_eq!(cells.planes(), [[4, 4, 5, 6, 6, 4, 4, 5, 6, 6]]);
    }
}
