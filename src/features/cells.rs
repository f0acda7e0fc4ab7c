//! The cells of a search region, cut out of a frame.
//!
//! Edge pixels are repeated outside the frame. A cell is the mean of its `step` x `step` pixels, or of 4 x 4 of them evenly
//! spaced where there are more, so that the cost follows the cells and not the pixels.

use crate::frame::{FrameView, PixelFormat};

use super::region::SearchRegion;

/// Colour channels that features may read.
pub const CHANNELS: usize = 3;

/// Pixels along a cell's side that are averaged at most.
const SAMPLES_PER_SIDE: usize = 4;

/// Cells of a region, a plane a colour channel. Reused from frame to frame.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    region: SearchRegion,
    channels: usize,
    planes: [Vec<u8>; CHANNELS],
}

impl Default for Cells {
    fn default() -> Self {
        Self { region: SearchRegion::NOTHING, channels: 1, planes: Default::default() }
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
        if region.step == 1 { self.cut_pixels(frame) } else { self.cut_averages(frame) }
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

    fn cut_averages(&mut self, frame: &FrameView<'_>) {
        let SearchRegion { x, y, width, height, step } = self.region;
        let size = frame.format().bytes_per_pixel();
        let offsets = frame.format().rgb_offsets();
        let (last_x, last_y) = (frame.width() as i64 - 1, frame.height() as i64 - 1);
        let per_side = step.min(SAMPLES_PER_SIDE);
        let samples = (per_side * per_side) as u32;
        let sample = |cell: usize, i: usize| (cell * step + (2 * i + 1) * step / (2 * per_side)) as i64;
        for row in 0..height {
            for column in 0..width {
                let mut sums = [0u32; CHANNELS];
                for dy in 0..per_side {
                    let pixels = frame.row((y + sample(row, dy)).clamp(0, last_y) as usize);
                    for dx in 0..per_side {
                        let at = (x + sample(column, dx)).clamp(0, last_x) as usize * size;
                        for (sum, offset) in sums.iter_mut().zip(offsets).take(self.channels) {
                            *sum += u32::from(pixels[at + offset]);
                        }
                    }
                }
                for (cells, sum) in self.planes.iter_mut().zip(sums).take(self.channels) {
                    cells[row * width + column] = ((sum + samples / 2) / samples) as u8;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Frame;

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

    #[test]
    fn beyond_the_frame_its_edge_is_repeated() {
        let frame = Frame::new(vec![1, 2, 3, 4, 5, 6], 3, 2, PixelFormat::Gray).unwrap();
        let mut cells = Cells::default();
        cells.cut(&frame.view(), SearchRegion { x: -1, y: 1, width: 5, height: 2, step: 1 });
        assert_eq!(cells.planes(), [[4, 4, 5, 6, 6, 4, 4, 5, 6, 6]]);
    }
}
