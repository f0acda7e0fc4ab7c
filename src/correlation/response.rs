//! What a correlation filter says of a window: how much each place looks like the target's centre.

use super::window::Window;

/// Distance from the middle of a cell, in cells, that is rounding.
const NEARLY: f64 = 1e-9;

/// Responses over a window, about 1 where the target is as learnt.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Response {
    side: usize,
    window: Window,
    values: Vec<f32>,
}

/// The best place of a response.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Peak {
    /// Frame pixels from the left edge.
    pub x: f64,
    /// Frame pixels from the top edge.
    pub y: f64,
    /// The response there.
    pub value: f32,
    /// How far it stands above the rest of the window, in standard deviations of the rest.
    pub sharpness: f32,
}

impl Response {
    /// An empty response of `side` x `side` cells.
    pub fn new(side: usize) -> Self {
        Self { side, window: Window { x: 0.0, y: 0.0, side: 1.0 }, values: vec![0.0; side * side] }
    }

    /// Responses by shift, rows one after another, shift 0 first and negative shifts at the end.
    pub(super) fn values_mut(&mut self, window: Window) -> &mut [f32] {
        self.window = window;
        &mut self.values
    }

    /// The window last responded to.
    pub fn window(&self) -> Window {
        self.window
    }

    /// Responses by shift.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Frame pixels along a cell's side.
    pub fn cell(&self) -> f64 {
        self.window.side / self.side as f64
    }

    /// The response at a place of the frame; 0 outside the window.
    pub fn at(&self, x: f64, y: f64) -> f32 {
        let cell = self.cell();
        let (u, v) = ((x - self.window.x) / cell, (y - self.window.y) / cell);
        let half = self.side as f64 / 2.0 - 1.0;
        if u.abs() <= half && v.abs() <= half { self.cubic(u, v) } else { 0.0 }
    }

    fn wrapped(&self, column: i64, row: i64) -> f32 {
        let side = self.side as i64;
        self.values[(row.rem_euclid(side) * side + column.rem_euclid(side)) as usize]
    }

    /// Catmull-Rom interpolation; at the middle of a cell what the cell has.
    fn cubic(&self, u: f64, v: f64) -> f32 {
        let (column, row) = (u.round(), v.round());
        if (u - column).abs() < NEARLY && (v - row).abs() < NEARLY {
            return self.wrapped(column as i64, row as i64);
        }
        let (column, row) = (u.floor(), v.floor());
        let (wu, wv) = (cubic_weights((u - column) as f32), cubic_weights((v - row) as f32));
        let mut sum = 0.0;
        for (j, wv) in wv.iter().enumerate() {
            for (i, wu) in wu.iter().enumerate() {
                sum += wu * wv * self.wrapped(column as i64 + i as i64 - 1, row as i64 + j as i64 - 1);
            }
        }
        sum
    }

    /// The highest response, between the cells by a parabola through its neighbours.
    pub fn peak(&self) -> Peak {
        let (best, value) =
            self.values.iter().enumerate().fold((0, f32::NEG_INFINITY), |best, (i, &value)| {
                if value > best.1 { (i, value) } else { best }
            });
        let signed = |i: usize| if i >= self.side / 2 { i as i64 - self.side as i64 } else { i as i64 };
        let (column, row) = (signed(best % self.side), signed(best / self.side));
        let offset = |before: f32, after: f32| {
            let curvature = before - 2.0 * value + after;
            if curvature < 0.0 { f64::from(0.5 * (before - after) / curvature).clamp(-0.5, 0.5) } else { 0.0 }
        };
        let du = offset(self.wrapped(column - 1, row), self.wrapped(column + 1, row));
        let dv = offset(self.wrapped(column, row - 1), self.wrapped(column, row + 1));
        let cell = self.cell();
        Peak {
            x: self.window.x + (column as f64 + du) * cell,
            y: self.window.y + (row as f64 + dv) * cell,
            value,
            sharpness: self.sharpness(column, row, value),
        }
    }

    fn sharpness(&self, column: i64, row: i64, value: f32) -> f32 {
        let side = self.side as i64;
        let (mut count, mut sum, mut squares) = (0.0f32, 0.0, 0.0);
        for (i, &other) in self.values.iter().enumerate() {
            let far = |at: i64, from: i64| {
                let distance = (at - from).rem_euclid(side);
                distance.min(side - distance) > 2
            };
            if far(i as i64 % side, column) || far(i as i64 / side, row) {
                count += 1.0;
                sum += other;
                squares += other * other;
            }
        }
        let mean = sum / count;
        (value - mean) / (squares / count - mean * mean).max(1e-12).sqrt()
    }
}

/// Weights of a Catmull-Rom cubic between the second and the third of four values, at `t` in [0, 1] of the way.
pub(super) fn cubic_weights(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (-t3 + 2.0 * t2 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (-3.0 * t3 + 4.0 * t2 + t),
        0.5 * (t3 - t2),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 8;

    /// A response over 16 x 16 pixels around (50, 40), cells of two pixels, from a function of the shift in cells.
    fn response(value: impl Fn(f64, f64) -> f64) -> Response {
        let mut response = Response::new(SIDE);
        let signed = |i: usize| if i >= SIDE / 2 { i as f64 - SIDE as f64 } else { i as f64 };
        let values: Vec<f32> =
            (0..SIDE * SIDE).map(|i| value(signed(i % SIDE), signed(i / SIDE)) as f32).collect();
        response.values_mut(Window { x: 50.0, y: 40.0, side: 16.0 }).copy_from_slice(&values);
        response
    }

    #[test]
    fn a_peak_between_cells_is_found() {
        let peak = response(|x, y| 1.0 - 0.1 * ((x - 1.25).powi(2) + (y + 2.0).powi(2))).peak();
        assert!((peak.x - 52.5).abs() < 1e-4 && (peak.y - 36.0).abs() < 1e-4, "{peak:?}");
    }

    #[test]
    fn between_cells_a_plane_stays_a_plane_and_outside_nothing_is_known() {
        let plane = response(|x, y| 0.5 + 0.25 * x - 0.125 * y);
        for (x, y) in [(50.0, 40.0), (51.0, 40.5), (47.3, 42.9)] {
            let expected = 0.5 + 0.25 * (x - 50.0) / 2.0 - 0.125 * (y - 40.0) / 2.0;
            assert!((f64::from(plane.at(x, y)) - expected).abs() < 1e-5, "{x} {y}");
        }
        assert_eq!(plane.at(50.0, 60.0), 0.0);
        assert_eq!(plane.at(f64::NAN, 40.0), 0.0);
    }

    #[test]
    fn a_lone_peak_is_sharper_than_one_of_two() {
        let lone = response(|x, y| if (x, y) == (0.0, 0.0) { 1.0 } else { 0.01 * x });
        let two = response(|x, y| if (x, y) == (0.0, 0.0) || (x, y) == (-4.0, 3.0) { 1.0 } else { 0.01 * x });
        assert!(lone.peak().sharpness > 3.0 * two.peak().sharpness);
    }
}
