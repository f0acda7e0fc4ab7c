//! Where a correlation filter looks.

use crate::geometry::Rect;

/// A square of a frame: its centre and side in frame pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Window {
    /// Centre, frame pixels from the left edge.
    pub x: f64,
    /// Centre, frame pixels from the top edge.
    pub y: f64,
    /// Side, frame pixels, > 0.
    pub side: f64,
}

impl Window {
    /// The window around a target whose side is `scale` times the square root of the target's area.
    pub fn around(target: &Rect, scale: f64) -> Self {
        let (x, y) = target.centre();
        Self { x, y, side: scale * target.area().sqrt() }
    }

    /// The window as a box.
    pub fn to_rect(self) -> Rect {
        Rect::new(self.x - self.side / 2.0, self.y - self.side / 2.0, self.side, self.side)
    }
}
