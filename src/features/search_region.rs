//! Where features are computed: a region of cells of a frame, and a box in it.

use crate::geometry::Rect;

/// A region of a frame in whole pixels. It may reach beyond the frame, where edge pixels are repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SearchRegion {
    /// Left edge in frame pixels.
    pub x: i64,
    /// Top edge in frame pixels.
    pub y: i64,
    /// Width in cells, >= 1.
    pub width: usize,
    /// Height in cells, >= 1.
    pub height: usize,
    /// Frame pixels along a cell's side, >= 1.
    pub step: usize,
}

impl SearchRegion {
    /// No cells at all.
    pub(super) const NOTHING: Self = Self { x: 0, y: 0, width: 0, height: 0, step: 1 };

    /// The smallest region of cells of `step` pixels that holds `box_in_frame` with a cell to spare on every side.
    pub fn around(box_in_frame: Rect, step: usize) -> Self {
        let step_px = step as f64;
        let (x, y) = (box_in_frame.x.floor() - step_px, box_in_frame.y.floor() - step_px);
        let cells = |from: f64, to: f64| ((to - from) / step_px).ceil().max(1.0) as usize + 1;
        Self {
            x: x as i64,
            y: y as i64,
            width: cells(x, box_in_frame.right()),
            height: cells(y, box_in_frame.bottom()),
            step,
        }
    }

    /// The box of the frame that the cells cover.
    pub fn to_rect(&self) -> Rect {
        let side = |cells: usize| (cells * self.step) as f64;
        Rect::new(self.x as f64, self.y as f64, side(self.width), side(self.height))
    }
}

/// A box in cells of a [`RegionIntegrals`](super::region::RegionIntegrals), from its top left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxInRegion {
    /// Left edge, cells.
    pub x: f32,
    /// Top edge, cells.
    pub y: f32,
    /// Width, cells.
    pub w: f32,
    /// Height, cells.
    pub h: f32,
}
