//! The model of a whole view: a mixture a pixel.

use image::GrayImage;

use super::{
    BACKGROUND, BackgroundError, CheckedBackgroundParameters,
    pixel::{Gaussian, Learning, Update},
};
use crate::{
    frame::FrameView,
    parallel::{ChunksMut, for_each},
};

/// Rows that a thread takes.
const ROWS_AT_A_TIME: usize = 4;
/// Pixels that a mask may have.
const MOST_PIXELS: usize = 1 << 31;

/// A mixture of Gaussians for every pixel. Rows are updated in parallel where the caller's threads are (see [`Threads`](crate::parallel::Threads)); the
/// masks do not depend on their number.
///
/// A pixel's weights and its Gaussians are contiguous, apart from each other: where the first component explains the
/// pixel, as it mostly does, no other Gaussian is touched.
#[derive(Debug, Clone)]
pub struct BackgroundModel {
    parameters: CheckedBackgroundParameters,
    frames: u64,
    /// `components` of each pixel, row by row.
    weights: Vec<f32>,
    gaussians: Vec<Gaussian>,
    mask: GrayImage,
}

impl BackgroundModel {
    /// A model that knows nothing yet; the first frame gives its size.
    pub fn new(parameters: CheckedBackgroundParameters) -> Self {
        let mask = GrayImage::new(0, 0);
        Self { parameters, frames: 0, weights: Vec::new(), gaussians: Vec::new(), mask }
    }

    /// Learns from the next frame and gives its mask, of the frame's size: [`BACKGROUND`],
    /// [`FOREGROUND`](super::FOREGROUND) or, if asked for, [`SHADOW`](super::SHADOW) for each pixel. In the first frame
    /// everything is background.
    ///
    /// # Errors
    /// [`BackgroundError::SizeChanged`] or [`BackgroundError::TooLarge`]; the model then stays as it was.
    pub fn apply(&mut self, frame: FrameView<'_>) -> Result<&GrayImage, BackgroundError> {
        self.apply_guided(frame, &[])
    }

    /// The same where something is known of the pixels: `guide` says for each of them, row by row, how it is learnt from.
    /// An empty guide has every pixel learnt.
    ///
    /// # Errors
    /// As [`apply`](Self::apply), and [`BackgroundError::GuideSize`] if the guide has another number of pixels than the frame.
    pub fn apply_guided(
        &mut self,
        frame: FrameView<'_>,
        guide: &[Learning],
    ) -> Result<&GrayImage, BackgroundError> {
        self.fit_size(&frame)?;
        let (k, width) = (self.parameters.components, frame.width());
        let (pixels, given) = (width * frame.height(), guide.len());
        if given != 0 && given != pixels {
            return Err(BackgroundError::GuideSize { given, pixels });
        }
        self.frames += 1;
        let update = Update::new(&self.parameters, self.frames);
        let (weights, gaussians) = (&mut self.weights, &mut self.gaussians);
        let rows = (
            (ChunksMut(weights, k * width), ChunksMut(gaussians, k * width)),
            ChunksMut(&mut self.mask, width),
        );
        for_each(rows, ROWS_AT_A_TIME, |y, ((weights, gaussians), mask)| {
            let guide = guide.get(y * width..(y + 1) * width).unwrap_or_default();
            apply_row(&update, frame, y, guide, weights, gaussians, mask);
        });
        Ok(&self.mask)
    }

    /// The mask of the last frame; without pixels before the first.
    pub fn mask(&self) -> &GrayImage {
        &self.mask
    }

    /// Frames learnt from so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The parameters it runs with.
    pub fn parameters(&self) -> &CheckedBackgroundParameters {
        &self.parameters
    }

    fn fit_size(&mut self, frame: &FrameView<'_>) -> Result<(), BackgroundError> {
        let (width, height) = (frame.width(), frame.height());
        if self.frames > 0 {
            let (first_width, first_height) = (self.mask.width() as usize, self.mask.height() as usize);
            if (width, height) == (first_width, first_height) {
                return Ok(());
            }
            return Err(BackgroundError::SizeChanged { width, height, first_width, first_height });
        }
        let pixels = width.checked_mul(height).filter(|pixels| *pixels < MOST_PIXELS);
        let pixels = pixels.ok_or(BackgroundError::TooLarge { width, height })?;
        let side = |pixels| u32::try_from(pixels).map_err(|_| BackgroundError::TooLarge { width, height });
        self.mask = GrayImage::from_pixel(side(width)?, side(height)?, image::Luma([BACKGROUND]));
        self.weights = vec![0.0; pixels * self.parameters.components];
        self.gaussians = vec![Gaussian::default(); pixels * self.parameters.components];
        Ok(())
    }
}

fn apply_row(
    update: &Update,
    frame: FrameView<'_>,
    y: usize,
    guide: &[Learning],
    weights: &mut [f32],
    gaussians: &mut [Gaussian],
    mask: &mut [u8],
) {
    // The usual numbers of components are known where the loops over them are compiled, which unrolls them.
    match weights.len() / mask.len() {
        3 => apply_row_of(3, update, frame, y, guide, weights, gaussians, mask),
        5 => apply_row_of(5, update, frame, y, guide, weights, gaussians, mask),
        k => apply_row_of(k, update, frame, y, guide, weights, gaussians, mask),
    }
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "what its caller has, and one constant")]
fn apply_row_of(
    k: usize,
    update: &Update,
    frame: FrameView<'_>,
    y: usize,
    guide: &[Learning],
    weights: &mut [f32],
    gaussians: &mut [Gaussian],
    mask: &mut [u8],
) {
    let [red, green, blue] = frame.format().rgb_offsets();
    let pixels = frame.row(y).chunks_exact(frame.format().bytes_per_pixel());
    let mixtures = weights.chunks_exact_mut(k).zip(gaussians.chunks_exact_mut(k));
    for (x, ((pixel, (weights, gaussians)), out)) in pixels.zip(mixtures).zip(mask).enumerate() {
        let colour = [red, green, blue].map(|channel| f32::from(pixel[channel]));
        let learning = guide.get(x).copied().unwrap_or_default();
        *out = update.apply(colour, learning, weights, gaussians);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        background::{BackgroundParameters, FOREGROUND},
        frame::{Frame, PixelFormat},
    };

    /// A flickering texture, over which a square of 6 pixels moves from frame 60 on.
    fn frame(number: usize, format: PixelFormat) -> Frame {
        let (width, height, bytes) = (31, 17, format.bytes_per_pixel());
        let mut data = Vec::new();
        for i in 0..width * height {
            let (x, y) = (i % width, i / width);
            let moving = number >= 60 && (number - 56..number - 50).contains(&x) && (5..11).contains(&y);
            let noise = (i * 31 + number * 17) % 7;
            data.extend(std::iter::repeat_n(if moving { 240 } else { (40 + x * 3 + noise) as u8 }, bytes));
        }
        Frame::new(data, width, height, format).unwrap()
    }

    fn masks(format: PixelFormat, threads: usize) -> Vec<GrayImage> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut model = BackgroundModel::new(BackgroundParameters::default().check().unwrap());
        pool.install(|| (0..70).map(|i| model.apply(frame(i, format).view()).unwrap().clone()).collect())
    }

    #[test]
    fn what_moves_is_foreground_and_nothing_else_is() {
        let masks = masks(PixelFormat::Rgb, 1);
        assert!(masks[..60].iter().all(|mask| mask.iter().all(|value| *value == BACKGROUND)));
        for (x, y, value) in masks[68].enumerate_pixels() {
            let moving = (12..18).contains(&x) && (5..11).contains(&y);
            assert_eq!(value.0[0], if moving { FOREGROUND } else { BACKGROUND }, "{x},{y}");
        }
    }

    #[test]
    fn neither_threads_nor_the_layout_of_a_grey_picture_change_a_mask() {
        let one = masks(PixelFormat::Rgb, 1);
        assert_eq!(one, masks(PixelFormat::Rgb, 4));
        assert_eq!(one, masks(PixelFormat::Gray, 2));
        assert_eq!(one, masks(PixelFormat::Bgra, 2));
    }

    #[test]
    fn what_is_held_stays_foreground_and_what_is_replaced_is_background_at_once() {
        let parameters = BackgroundParameters { history: 30, ..BackgroundParameters::default() };
        let mut model = BackgroundModel::new(parameters.check().unwrap());
        let grey = |level: u8| Frame::new(vec![level; 3], 3, 1, PixelFormat::Gray).unwrap();
        for _ in 0..40 {
            model.apply(grey(60).view()).unwrap();
        }
        let guide = [Learning::Usual, Learning::Hold, Learning::Replace];
        let first = model.apply_guided(grey(220).view(), &guide).unwrap();
        assert_eq!(**first, [FOREGROUND, FOREGROUND, BACKGROUND]);
        for _ in 0..60 {
            model
                .apply_guided(grey(220).view(), &[Learning::Usual, Learning::Hold, Learning::Usual])
                .unwrap();
        }
        // Learnt as usual it is background by now; held it is not, and what is behind it is still known.
        assert_eq!(**model.mask(), [BACKGROUND, FOREGROUND, BACKGROUND]);
        assert_eq!((**model.apply_guided(grey(60).view(), &guide).unwrap())[1], BACKGROUND);
        let short = model.apply_guided(grey(60).view(), &guide[..2]).map(|_| ());
        assert_eq!(short, Err(BackgroundError::GuideSize { given: 2, pixels: 3 }));
    }

    #[test]
    fn another_size_is_refused_and_changes_nothing() {
        let mut model = BackgroundModel::new(BackgroundParameters::default().check().unwrap());
        model.apply(frame(0, PixelFormat::Gray).view()).unwrap();
        let other = [0; 12];
        let refused = model.apply(FrameView::new(&other, 4, 3, 4, PixelFormat::Gray).unwrap()).map(|_| ());
        let expected =
            BackgroundError::SizeChanged { width: 4, height: 3, first_width: 31, first_height: 17 };
        assert_eq!(refused, Err(expected));
        assert_eq!((model.frames(), model.mask().width()), (1, 31));
    }
}
