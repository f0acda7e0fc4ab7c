//! Correlation filter: where in a window around a target its appearance lies.
//!
//! A window of the frame is described by a grid of cells that are read from integral images ([`grid`]), and correlated with
//! a filter that is learnt in the Fourier domain ([`filter`]). The module knows no tracker; its answer is a
//! [`response::Response`] over the window.

pub mod filter;
pub mod grid;
mod lattice;
mod line_transform;
pub mod response;
pub mod scale;
pub mod shift;
pub mod spectrum;
pub mod window;
