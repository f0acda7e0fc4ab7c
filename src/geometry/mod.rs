//! Boxes in a frame, and how a body is partitioned. Knows nothing of images or trackers.

mod body_plan;
mod rect;

pub use body_plan::{BodyPlan, Region, RegionError};
pub use rect::{Origin, Rect};
