//! Many objects: where a single-object tracker gets its first box from, and how tracks of many objects are judged.
//!
//! [`tracking`] and [`objects`] follow what moves before a static camera, `drawing` (feature `render`) shows it, and
//! [`comparison`] says how well each filter predicted, with a [`line_plot`].
//! [`sort`] tracks given detections, with the filters of [`motion`] and, if there are frames, the colours of [`appearance`].
//! [`motchallenge`] reads and writes MOTChallenge text, [`scoring`] judges a result against the ground truth exactly as
//! py-motmetrics or TrackEval would, and [`assignment`] solves the matching that all of this rests on.
#![deny(missing_docs)]

pub mod appearance;
pub mod assignment;
pub mod camera_motion;
pub mod comparison;
#[cfg(feature = "render")]
pub mod drawing;
pub mod grid;
pub mod line_plot;
pub mod motchallenge;
pub mod motion;
pub mod objects;
pub mod scoring;
pub mod sort;
pub mod tracking;
