//! InfoPart: a single-object visual tracker that follows the part of a target that changes least.
//!
//! A [`Tracker`](tracker::Tracker) is started on a frame with the target's box and then gives an
//! [`Estimate`](tracker::Estimate) of every later frame. Frames are borrowed, never copied:
//!
//! ```
//! use infopart::{
//!     frame::{FrameView, PixelFormat},
//!     geometry::Rect,
//!     tracker::{InfoPart, Parameters, Tracker},
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Two grey frames of a bright square; it moves by two pixels.
//! let picture = |left: usize| -> Vec<u8> {
//!     let inside = |x: usize, y: usize| (left..left + 16).contains(&x) && (20..36).contains(&y);
//!     (0..64 * 64).map(|i| if inside(i % 64, i / 64) { 220 } else { (i * 7 % 90) as u8 }).collect()
//! };
//! let (first, second) = (picture(24), picture(26));
//!
//! let parameters = Parameters::preset("default")?.check()?;
//! let mut tracker = InfoPart::new(parameters);
//! let view = |pixels| FrameView::new(pixels, 64, 64, 64, PixelFormat::Gray);
//! tracker.init(view(&first)?, Rect::new(24.0, 20.0, 16.0, 16.0))?;
//! let found = tracker.update(view(&second)?)?;
//! assert!(found.box_in_frame.overlap(&Rect::new(26.0, 20.0, 16.0, 16.0)) > 0.5);
//! println!("{:?} {} {:.2}", found.box_in_frame, found.status, found.confidence);
//! # Ok(())
//! # }
//! ```
//!
//! Whole sequences come from `sequence::open`, go through `run::run`, and are watched by observers, with the feature
//! `images`. Without any feature the library is the trackers, the filters and the background model.
#![deny(missing_docs)]

pub mod annotate;
pub mod background;
pub mod bayes;
pub mod boosting;
pub mod correlation;
#[cfg(feature = "cli")]
pub mod experiments;
pub mod features;
pub mod frame;
pub mod geometry;
pub mod metrics;
#[cfg(feature = "images")]
pub mod output;
pub mod parallel;
#[cfg(feature = "cli")]
pub mod program;
#[cfg(feature = "images")]
pub mod run;
#[cfg(feature = "images")]
pub mod sequence;
pub mod tracker;
#[cfg(feature = "images")]
pub mod trax;

/// The version of this package, as `infopart --version` tells it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
