//! Features of a box in a frame, evaluated on integral images of the search region. Knows no tracker.

pub mod blocks;
mod cells;
pub mod colour_histogram;
/// Which pixels around a box are likely its own, by their colours.
pub mod foreground;
mod gradient;
pub mod haar;
pub mod hog;
pub mod region;
mod search_region;

#[cfg(test)]
pub(crate) mod reference;
