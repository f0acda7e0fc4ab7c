//! A small painter: shapes by their signed distance, so edges are smooth without supersampling.

use std::ops::Range;

/// Red, green, blue in [0, 255].
pub(super) type Colour = [f32; 3];

/// A point, pixels.
pub(super) type Point = (f32, f32);

/// An area with a smooth edge.
#[derive(Debug, Clone, Copy)]
pub(super) enum Shape {
    /// A line from `a` to `b`, of half thickness `ra` at one end and `rb` at the other.
    Capsule { a: Point, b: Point, ra: f32, rb: f32 },
    /// An upright ellipse.
    Ellipse { centre: Point, rx: f32, ry: f32 },
    /// An upright rectangle.
    Rectangle { min: Point, max: Point },
}

impl Shape {
    /// Distance from a point to the edge in pixels, negative inside.
    fn distance(&self, (x, y): Point) -> f32 {
        match *self {
            Self::Capsule { a, b, ra, rb } => {
                let (dx, dy) = (b.0 - a.0, b.1 - a.1);
                let along = ((x - a.0) * dx + (y - a.1) * dy) / (dx * dx + dy * dy).max(1e-6);
                let along = along.clamp(0.0, 1.0);
                (x - a.0 - along * dx).hypot(y - a.1 - along * dy) - (ra + along * (rb - ra))
            }
            Self::Ellipse { centre, rx, ry } => {
                let reach = ((x - centre.0) / rx).hypot((y - centre.1) / ry);
                (reach - 1.0) * rx.min(ry)
            }
            Self::Rectangle { min, max } => (min.0 - x).max(x - max.0).max(min.1 - y).max(y - max.1),
        }
    }

    fn bounds(&self) -> (Point, Point) {
        match *self {
            Self::Capsule { a, b, ra, rb } => {
                let r = ra.max(rb);
                ((a.0.min(b.0) - r, a.1.min(b.1) - r), (a.0.max(b.0) + r, a.1.max(b.1) + r))
            }
            Self::Ellipse { centre, rx, ry } => {
                ((centre.0 - rx, centre.1 - ry), (centre.0 + rx, centre.1 + ry))
            }
            Self::Rectangle { min, max } => (min, max),
        }
    }
}

/// Pixels to paint on.
#[derive(Debug, Clone)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<Colour>,
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![[0.0; 3]; width * height] }
    }

    /// Paints `shape` in the colour that `paint` gives for each point, as opaque as `opacity` in [0, 1] says.
    pub(super) fn fill(&mut self, shape: &Shape, opacity: f32, paint: impl Fn(Point) -> Colour) {
        let (min, max) = shape.bounds();
        for y in pixels_between(min.1, max.1, self.height) {
            for x in pixels_between(min.0, max.0, self.width) {
                let point = (x as f32 + 0.5, y as f32 + 0.5);
                let cover = opacity * (0.5 - shape.distance(point)).clamp(0.0, 1.0);
                if cover > 0.0 {
                    let pixel = &mut self.pixels[y * self.width + x];
                    *pixel = mixed(*pixel, paint(point), cover);
                }
            }
        }
    }

    /// The `width` x `height` window whose top left corner lies at (`left`, `top`), between pixels too.
    pub(super) fn window(&self, (left, top): Point, width: usize, height: usize) -> Self {
        let (x0, fx) = split(left, self.width.saturating_sub(width + 1));
        let (y0, fy) = split(top, self.height.saturating_sub(height + 1));
        let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
        let mut pixels = Vec::with_capacity(width * height);
        for y in y0..y0 + height {
            let upper = &self.pixels[y * self.width + x0..][..width + 1];
            let lower = &self.pixels[(y + 1) * self.width + x0..][..width + 1];
            pixels.extend(upper.windows(2).zip(lower.windows(2)).map(|(up, low)| {
                std::array::from_fn(|c| {
                    weights[0] * up[0][c]
                        + weights[1] * up[1][c]
                        + weights[2] * low[0][c]
                        + weights[3] * low[1][c]
                })
            }));
        }
        Self { width, height, pixels }
    }
}

/// The colour `share` of the way from `a` to `b`.
pub(super) fn mixed(a: Colour, b: Colour, share: f32) -> Colour {
    std::array::from_fn(|c| a[c] + share * (b[c] - a[c]))
}

/// The colour made `gain` times as bright.
pub(super) fn lit(colour: Colour, gain: f32) -> Colour {
    colour.map(|value| value * gain)
}

fn pixels_between(min: f32, max: f32, limit: usize) -> Range<usize> {
    // The float cast saturates, so what lies outside becomes an empty range.
    (min - 1.0).max(0.0) as usize..((max + 2.0).max(0.0) as usize).min(limit)
}

fn split(position: f32, largest: usize) -> (usize, f32) {
    let position = position.clamp(0.0, largest as f32);
    (position.floor() as usize, position.fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_covers_its_area() {
        let mut canvas = Canvas::new(40, 40);
        canvas.fill(&Shape::Ellipse { centre: (20.0, 20.0), rx: 10.0, ry: 10.0 }, 1.0, |_| [1.0; 3]);
        let area: f32 = canvas.pixels.iter().map(|pixel| pixel[0]).sum();
        assert!((area - 100.0 * std::f32::consts::PI).abs() < 2.0, "{area}");
        assert_eq!(canvas.pixels[20 * 40 + 20], [1.0; 3]);
        assert_eq!(canvas.pixels[0], [0.0; 3]);
    }

    #[test]
    fn shapes_outside_paint_nothing() {
        let mut canvas = Canvas::new(8, 8);
        for x in [-50.0, 60.0] {
            canvas.fill(&Shape::Capsule { a: (x, 0.0), b: (x, 9.0), ra: 3.0, rb: 3.0 }, 1.0, |_| [1.0; 3]);
        }
        assert!(canvas.pixels.iter().all(|&pixel| pixel == [0.0; 3]));
    }

    #[test]
    fn a_window_moves_by_fractions_of_a_pixel() {
        let mut canvas = Canvas::new(6, 3);
        canvas.fill(&Shape::Rectangle { min: (2.0, 0.0), max: (3.0, 3.0) }, 1.0, |_| [8.0; 3]);
        let window = canvas.window((1.25, 0.5), 3, 1);
        let red: Vec<f32> = window.pixels.iter().map(|pixel| pixel[0]).collect();
        assert_eq!(red, [2.0, 6.0, 0.0]);
    }
}
