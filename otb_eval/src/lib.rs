//! Runs trackers over the Object Tracking Benchmark and scores them exactly as each toolkit in use would.
#![deny(missing_docs)]

pub mod plots;
pub mod report;
