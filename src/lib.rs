//! InfoPart: a single-object visual tracker that follows the part of a target that changes least.
#![deny(missing_docs)]

pub mod bayes;
pub mod boosting;
pub mod features;
pub mod frame;
pub mod geometry;
pub mod metrics;
pub mod output;
pub mod run;
pub mod sequence;
pub mod tracker;
