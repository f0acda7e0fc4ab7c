//! Where a correlation filter looks.

/// A square of a frame: its centre and side in frame pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Centre, frame pixels from the left edge.
    pub x: f64,
    /// Centre, frame pixels from the top edge.
    pub y: f64,
    /// Side, frame pixels, > 0.
    pub side: f64,
}
