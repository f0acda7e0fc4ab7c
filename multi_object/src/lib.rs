//! Many objects: where a single-object tracker gets its first box from, and how tracks of many objects are judged.
//!
//! [`motchallenge`] reads and writes MOTChallenge text, [`scoring`] judges a result against the ground truth exactly as
//! py-motmetrics or TrackEval would, and [`assignment`] solves the matching that all of this rests on.
#![deny(missing_docs)]

pub mod assignment;
pub mod grid;
pub mod motchallenge;
pub mod scoring;
