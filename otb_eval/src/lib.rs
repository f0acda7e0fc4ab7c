//! Runs trackers over the Object Tracking Benchmark (TB-100) and other data sets, and scores them exactly as each toolkit in use would.
#![deny(missing_docs)]

pub mod catalogue;
pub mod check;
pub mod compare;
pub mod convert;
pub mod dataset;
pub mod external;
pub mod figures;
pub mod plots;
pub mod protocol;
pub mod report;
pub mod results;
pub mod runner;
pub mod scoring;
pub mod statistics;
pub mod store;
pub mod submission;
pub mod tables;
pub mod toolkits;
mod words;
