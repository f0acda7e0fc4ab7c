//! Axis-aligned boxes.

use serde::{Deserialize, Serialize};

/// A box in a frame, in pixels. `x` and `y` are its left and top edges in continuous coordinates whose
/// origin is the frame's top left corner: pixel (i, j) covers [i, i + 1) x [j, j + 1).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rect {
    /// Left edge, pixels.
    pub x: f64,
    /// Top edge, pixels.
    pub y: f64,
    /// Width, pixels.
    pub w: f64,
    /// Height, pixels.
    pub h: f64,
}

impl Rect {
    /// The box with left edge `x`, top edge `y`, width `w` and height `h`, all in pixels.
    pub const fn new(x: f64, y: f64, w: f64, h: f64) -> Self {
        Self { x, y, w, h }
    }

    /// Whether all four numbers are finite and both sides positive.
    pub fn is_proper(&self) -> bool {
        [self.x, self.y, self.w, self.h].iter().all(|v| v.is_finite()) && self.w > 0.0 && self.h > 0.0
    }

    /// Right edge, pixels.
    pub fn right(&self) -> f64 {
        self.x + self.w
    }

    /// Bottom edge, pixels.
    pub fn bottom(&self) -> f64 {
        self.y + self.h
    }

    /// Area in square pixels.
    pub fn area(&self) -> f64 {
        self.w * self.h
    }

    /// Centre (x, y), pixels.
    pub fn centre(&self) -> (f64, f64) {
        (self.x + self.w / 2.0, self.y + self.h / 2.0)
    }

    /// Area that two boxes share, in square pixels.
    pub fn intersection_area(&self, other: &Self) -> f64 {
        let w = self.right().min(other.right()) - self.x.max(other.x);
        let h = self.bottom().min(other.bottom()) - self.y.max(other.y);
        if w > 0.0 && h > 0.0 { w * h } else { 0.0 }
    }

    /// Overlap (intersection over union) in [0, 1]; 0 if either box is improper.
    pub fn overlap(&self, other: &Self) -> f64 {
        if !self.is_proper() || !other.is_proper() {
            return 0.0;
        }
        let shared = self.intersection_area(other);
        shared / (self.area() + other.area() - shared)
    }

    /// Euclidean distance between the centres, pixels; NaN if a coordinate is NaN.
    pub fn centre_distance(&self, other: &Self) -> f64 {
        let (ax, ay) = self.centre();
        let (bx, by) = other.centre();
        (ax - bx).hypot(ay - by)
    }

    /// The part of the box inside a `width` x `height` frame, or `None` if nothing of it is.
    pub fn clipped_to(&self, width: usize, height: usize) -> Option<Self> {
        let (x, y) = (self.x.max(0.0), self.y.max(0.0));
        let w = self.right().min(width as f64) - x;
        let h = self.bottom().min(height as f64) - y;
        (w > 0.0 && h > 0.0).then_some(Self { x, y, w, h })
    }

    /// The smallest box that holds both.
    pub fn union(&self, other: &Self) -> Self {
        let (x, y) = (self.x.min(other.x), self.y.min(other.y));
        Self::new(x, y, self.right().max(other.right()) - x, self.bottom().max(other.bottom()) - y)
    }

    /// The box moved by (`dx`, `dy`) pixels.
    pub fn translated(&self, dx: f64, dy: f64) -> Self {
        Self { x: self.x + dx, y: self.y + dy, ..*self }
    }

    /// The box about the same centre whose width and height are these times its own.
    pub fn scaled_about_centre(&self, (across, down): (f64, f64)) -> Self {
        let (x, y) = self.centre();
        let (w, h) = (across * self.w, down * self.h);
        Self::new(x - w / 2.0, y - h / 2.0, w, h)
    }
}

/// Which number the first pixel has in a file's boxes. Inside the program it is always 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Origin {
    /// The first pixel is 0 (OpenCV, COCO).
    Zero,
    /// The first pixel is 1 (MATLAB, and so OTB).
    One,
}

impl Origin {
    /// A file's box, whose first pixel has this number, in the frame's coordinates.
    pub fn to_frame(self, in_file: Rect) -> Rect {
        in_file.translated(-self.offset(), -self.offset())
    }

    /// A box of the frame as a file with this origin writes it.
    pub fn from_frame(self, in_frame: Rect) -> Rect {
        in_frame.translated(self.offset(), self.offset())
    }

    fn offset(self) -> f64 {
        match self {
            Self::Zero => 0.0,
            Self::One => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlap_of_half_shifted_squares_is_a_seventh() {
        let a = Rect::new(0.0, 0.0, 10.0, 10.0);
        let b = a.translated(5.0, 5.0);
        assert!((a.overlap(&b) - 25.0 / 175.0).abs() < 1e-15);
        assert_eq!(a.overlap(&a), 1.0);
        assert_eq!(a.overlap(&a.translated(10.0, 0.0)), 0.0);
    }

    #[test]
    fn improper_boxes_overlap_nothing() {
        let a = Rect::new(0.0, 0.0, 10.0, 10.0);
        for bad in [Rect::new(0.0, 0.0, 0.0, 10.0), Rect::new(f64::NAN, 0.0, 1.0, 1.0)] {
            assert_eq!(a.overlap(&bad), 0.0);
            assert_eq!(bad.overlap(&bad), 0.0);
        }
    }

    #[test]
    fn centre_distance_is_euclidean() {
        let a = Rect::new(0.0, 0.0, 10.0, 10.0);
        assert_eq!(a.centre_distance(&Rect::new(2.0, 3.0, 12.0, 12.0)), 5.0);
    }

    #[test]
    fn clipping_keeps_only_what_is_inside() {
        let inside = Rect::new(-2.0, 3.0, 5.0, 100.0).clipped_to(20, 10);
        assert_eq!(inside, Some(Rect::new(0.0, 3.0, 3.0, 7.0)));
        assert_eq!(Rect::new(20.0, 0.0, 5.0, 5.0).clipped_to(20, 10), None);
    }

    #[test]
    fn an_otb_box_moves_by_one_pixel_and_back() {
        let in_file = Rect::new(205.0, 151.0, 17.0, 50.0);
        let in_frame = Origin::One.to_frame(in_file);
        assert_eq!(in_frame, Rect::new(204.0, 150.0, 17.0, 50.0));
        assert_eq!(Origin::One.from_frame(in_frame), in_file);
    }
}
