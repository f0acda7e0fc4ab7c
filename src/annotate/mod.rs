//! A box in every frame of a video from a few key frames.
//!
//! Steps:
//! 1. from each key frame the tracker goes forward and backward to its neighbours ([`Passes`], which remembers them),
//! 2. between two key frames the two passes are fused ([`fuse`]),
//! 3. what is doubtful is listed, the most doubtful first ([`doubtful_places`]): one more key frame there, and only what touches it
//!    is tracked again.
//!
//! ```
//! use infopart::annotate::{Sighting, fuse};
//! use infopart::geometry::Rect;
//!
//! // Two passes that stand still while the object moved by 4 pixels: the drift is spread evenly.
//! let still = |x| Sighting { box_in_frame: Rect::new(x, 0.0, 20.0, 40.0), confidence: 0.9 };
//! let found = fuse(still(0.0).box_in_frame, still(4.0).box_in_frame, &[still(0.0); 2], &[still(4.0); 2]);
//! assert!((found[0].box_in_frame.x - 2.0).abs() < 1e-9);
//! ```

mod doubt;
#[cfg(feature = "images")]
pub mod export;
mod fusion;
#[cfg(feature = "images")]
pub mod import;
#[cfg(feature = "images")]
mod kept_frames;
mod keys;
mod passes;
#[cfg(feature = "images")]
mod project;
mod track;

pub use doubt::{DOUBTFUL, Place, doubtful_places};
pub use fusion::{Fused, fuse};
#[cfg(feature = "images")]
pub use kept_frames::{KeptFrames, VideoInfo};
pub use keys::{Colour, KeyError, Mark, Object};
pub use passes::{Direction, Frames, Leg, OngoingPass, Pass, PassError, Passes, Pathfinder, Sighting};
#[cfg(feature = "images")]
pub use project::{KeyEntry, PROJECT_VERSION, Project, ProjectError, keys_of};
pub use track::{Annotated, Sides, Stretch, annotate, known_track, stretches};
