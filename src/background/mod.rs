//! A background model of a static camera's view, and what moves before it.
//!
//! Each pixel's colour is a mixture of a few Gaussians that is learnt online (Stauffer and Grimson 1999, with the update
//! of KaewTraKulPong and Bowden 2001). What the mixture does not explain is foreground; the mask is cleaned by
//! morphology, and its connected regions are blobs.
//!
//! ```
//! use infopart::{
//!     background::{BackgroundModel, BackgroundParameters, CleanUp, MaskCleaner},
//!     frame::{FrameView, PixelFormat},
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut model = BackgroundModel::new(BackgroundParameters::default().check()?);
//! let cleaner = MaskCleaner::new(CleanUp { min_area: 20, closing: 3, ..CleanUp::default() }.check()?);
//! let empty = vec![60; 32 * 24];
//! for _ in 0..10 {
//!     model.apply(FrameView::new(&empty, 32, 24, 32, PixelFormat::Gray)?)?;
//! }
//! // A bright square of 8 x 8 pixels comes in.
//! let square = |x: usize, y: usize| (10..18).contains(&x) && (4..12).contains(&y);
//! let seen: Vec<u8> = (0..32 * 24).map(|i| if square(i % 32, i / 32) { 250 } else { 60 }).collect();
//! let raw = model.apply(FrameView::new(&seen, 32, 24, 32, PixelFormat::Gray)?)?;
//! let blobs = cleaner.blobs(&cleaner.clean(raw));
//! assert_eq!((blobs.len(), blobs[0].area), (1, 64));
//! # Ok(())
//! # }
//! ```

mod blobs;
mod clean_up;
mod model;
mod morphology;
mod parameters;
mod pixel;
mod regions;

pub use blobs::Blob;
pub use clean_up::{CheckedCleanUp, CleanUp, MaskCleaner};
pub use model::BackgroundModel;
pub use parameters::{BackgroundParameters, CheckedBackgroundParameters, ComponentRate};
pub use pixel::{BACKGROUND, FOREGROUND, Learning, SHADOW};
pub use regions::{Run, runs};

use thiserror::Error;

/// A background model or clean-up that cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum BackgroundError {
    /// A parameter is not finite or out of its range.
    #[error("`{key}` is {given} but must be from {low} to {high}")]
    OutOfRange {
        /// The parameter.
        key: &'static str,
        /// The value as given.
        given: f64,
        /// Smallest allowed value.
        low: f64,
        /// Largest allowed value.
        high: f64,
    },
    /// The side of a structuring square is even, so that it has no centre.
    #[error("`{key}` is {given} but must be odd: give {smaller} or {larger}", smaller = given - 1, larger = given + 1)]
    EvenSide {
        /// The parameter.
        key: &'static str,
        /// The value as given, pixels.
        given: usize,
    },
    /// The frame has another size than those that the model has learnt from.
    #[error(
        "the frame is {width}x{height} but the background was learnt at {first_width}x{first_height}: resize it, or start a new model"
    )]
    SizeChanged {
        /// Width of this frame, pixels.
        width: usize,
        /// Height of this frame, pixels.
        height: usize,
        /// Width of the first frame, pixels.
        first_width: usize,
        /// Height of the first frame, pixels.
        first_height: usize,
    },
    /// The frame has more pixels than a mask can have.
    #[error("the frame is {width}x{height}, more than the 2^31 pixels of a mask: resize it")]
    TooLarge {
        /// Width of the frame, pixels.
        width: usize,
        /// Height of the frame, pixels.
        height: usize,
    },
    /// A guide that says nothing of some pixels.
    #[error("the guide has {given} entries but the frame has {pixels} pixels: give one for each, row by row")]
    GuideSize {
        /// Entries of the guide.
        given: usize,
        /// Pixels of the frame.
        pixels: usize,
    },
}

/// Refuses what is not inside [low, high]; NaN is not.
fn check_range(key: &'static str, given: f64, low: f64, high: f64) -> Result<(), BackgroundError> {
    if given >= low && given <= high {
        return Ok(());
    }
    Err(BackgroundError::OutOfRange { key, given, low, high })
}
