//! Pixels as they come in: a borrowed view that copies nothing, and an owned frame.

use std::time::Duration;

use thiserror::Error;

/// How a pixel's bytes are laid out. Every sample is 8 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PixelFormat {
    /// One byte: luminance.
    Gray,
    /// Red, green, blue.
    Rgb,
    /// Blue, green, red (OpenCV's order).
    Bgr,
    /// Red, green, blue, alpha; alpha is ignored.
    Rgba,
    /// Blue, green, red, alpha; alpha is ignored.
    Bgra,
}

impl PixelFormat {
    /// Bytes a pixel takes.
    pub const fn bytes_per_pixel(self) -> usize {
        match self {
            Self::Gray => 1,
            Self::Rgb | Self::Bgr => 3,
            Self::Rgba | Self::Bgra => 4,
        }
    }

    /// Byte offsets of red, green and blue inside a pixel (all 0 for grey).
    pub const fn rgb_offsets(self) -> [usize; 3] {
        match self {
            Self::Gray => [0, 0, 0],
            Self::Rgb | Self::Rgba => [0, 1, 2],
            Self::Bgr | Self::Bgra => [2, 1, 0],
        }
    }
}

/// A buffer that does not hold the frame it is said to hold.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FrameError {
    /// Width or height is zero.
    #[error("a frame of {width}x{height} has no pixel; give a width and height of at least 1")]
    Empty {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
    },
    /// The stride is shorter than a row.
    #[error(
        "a row stride of {stride} bytes is shorter than a row ({row} bytes); pass the distance between row starts"
    )]
    ShortStride {
        /// Stride in bytes.
        stride: usize,
        /// Bytes that one row of pixels needs.
        row: usize,
    },
    /// The buffer ends before the last row does.
    #[error("the buffer has {len} bytes but the frame needs {needed}")]
    ShortBuffer {
        /// Bytes given.
        len: usize,
        /// Bytes needed.
        needed: usize,
    },
}

/// A frame that borrows its pixels, so that camera, numpy and OpenCV buffers enter without a copy.
#[derive(Debug, Clone, Copy)]
pub struct FrameView<'a> {
    data: &'a [u8],
    width: usize,
    height: usize,
    stride: usize,
    format: PixelFormat,
}

impl<'a> FrameView<'a> {
    /// Views `data` as `height` rows of `width` pixels whose starts are `stride` bytes apart.
    ///
    /// # Errors
    /// [`FrameError`] if the size is zero, the stride shorter than a row, or the buffer too short.
    pub fn new(
        data: &'a [u8],
        width: usize,
        height: usize,
        stride: usize,
        format: PixelFormat,
    ) -> Result<Self, FrameError> {
        if width == 0 || height == 0 {
            return Err(FrameError::Empty { width, height });
        }
        let row = width.saturating_mul(format.bytes_per_pixel());
        if stride < row {
            return Err(FrameError::ShortStride { stride, row });
        }
        let needed = stride.saturating_mul(height - 1).saturating_add(row);
        if data.len() < needed {
            return Err(FrameError::ShortBuffer { len: data.len(), needed });
        }
        Ok(Self { data, width, height, stride, format })
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Layout of a pixel.
    pub fn format(&self) -> PixelFormat {
        self.format
    }

    /// The bytes of row `y` (0-based), without padding.
    ///
    /// # Panics
    /// If `y` is not below the height.
    pub fn row(&self, y: usize) -> &'a [u8] {
        let start = y * self.stride;
        &self.data[start..start + self.width * self.format.bytes_per_pixel()]
    }
}

/// A frame that owns its pixels; rows are contiguous.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    data: Vec<u8>,
    width: usize,
    height: usize,
    format: PixelFormat,
}

impl Frame {
    /// Takes `data` as `height` contiguous rows of `width` pixels.
    ///
    /// # Errors
    /// [`FrameError`] if the size is zero or the buffer too short.
    pub fn new(data: Vec<u8>, width: usize, height: usize, format: PixelFormat) -> Result<Self, FrameError> {
        FrameView::new(&data, width, height, width.saturating_mul(format.bytes_per_pixel()), format)?;
        Ok(Self { data, width, height, format })
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The frame's pixels, borrowed.
    pub fn view(&self) -> FrameView<'_> {
        let stride = self.width * self.format.bytes_per_pixel();
        FrameView { data: &self.data, width: self.width, height: self.height, stride, format: self.format }
    }
}

/// Where a frame stands in its video. Both parts are optional: a live camera may know neither.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct FrameStamp {
    /// Index of the frame in its sequence (0-based).
    pub index: Option<u64>,
    /// Presentation time since the sequence's start.
    pub time: Option<Duration>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_honours_stride_and_layout() {
        let data = [1, 2, 3, 9, 4, 5, 6, 9];
        let view = FrameView::new(&data, 1, 2, 4, PixelFormat::Bgr).unwrap();
        assert_eq!(view.row(1), &[4, 5, 6]);
        assert_eq!(view.row(1)[view.format().rgb_offsets()[0]], 6);
    }

    #[test]
    fn the_last_row_needs_no_padding_but_must_be_whole() {
        assert!(FrameView::new(&[0; 7], 1, 2, 4, PixelFormat::Rgb).is_ok());
        let short = FrameView::new(&[0; 6], 1, 2, 4, PixelFormat::Rgb).unwrap_err();
        assert_eq!(short, FrameError::ShortBuffer { len: 6, needed: 7 });
    }

    #[test]
    fn impossible_sizes_are_errors_not_overflows() {
        assert!(matches!(FrameView::new(&[], 0, 5, 0, PixelFormat::Gray), Err(FrameError::Empty { .. })));
        let huge = FrameView::new(&[0; 8], usize::MAX, usize::MAX, usize::MAX, PixelFormat::Rgba);
        assert!(matches!(huge, Err(FrameError::ShortBuffer { .. })));
        assert!(matches!(
            FrameView::new(&[0; 8], 4, 1, 3, PixelFormat::Gray),
            Err(FrameError::ShortStride { stride: 3, row: 4 })
        ));
    }
}
