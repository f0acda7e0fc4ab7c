//! Features of a box in a frame, evaluated on integral images of the search region. Knows no tracker.

pub mod colour_histogram;
pub mod haar;
pub mod hog;
pub mod region;

#[cfg(test)]
pub(crate) mod reference;
