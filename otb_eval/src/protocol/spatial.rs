//! Spatial robustness evaluation (SRE): the twelve wrong boxes that a tracker is started with.
//!
//! Steps, in coordinates whose first pixel is 1:
//! 1. shift by a tenth of the side, rounded up; or move the named corner out by a tenth, the opposite one staying, which
//!    stretches the box; or scale about the centre; the last two rounded,
//! 2. clip to the frame: the left and top edge to the first pixel, then width and height to the last.

use infopart::geometry::Rect;

/// A way to make the first box wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shift {
    /// Moved to the left by a tenth of the width.
    Left,
    /// Moved to the right by a tenth of the width.
    Right,
    /// Moved up by a tenth of the height.
    Up,
    /// Moved down by a tenth of the height.
    Down,
    /// The top left corner moved out.
    TopLeft,
    /// The top right corner moved out.
    TopRight,
    /// The bottom left corner moved out.
    BottomLeft,
    /// The bottom right corner moved out.
    BottomRight,
    /// Scaled about the centre, in tenths: 8, 9, 11 or 12.
    Scale(u8),
}

/// The twelve, in the benchmark's order.
pub const SHIFTS: [Shift; 12] = [
    Shift::Left,
    Shift::Right,
    Shift::Up,
    Shift::Down,
    Shift::TopLeft,
    Shift::TopRight,
    Shift::BottomLeft,
    Shift::BottomRight,
    Shift::Scale(8),
    Shift::Scale(9),
    Shift::Scale(11),
    Shift::Scale(12),
];

/// Whose shifts: the benchmark's two codes differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ShiftRules {
    /// The MATLAB benchmark's, with which the published results were made.
    #[default]
    Matlab,
    /// The Python benchmark's: `down` widens the box instead of moving it, and the four plain shifts are a pixel longer
    /// where a tenth of the side is whole.
    OtbPy,
}

impl Shift {
    /// The benchmark's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
            Self::Up => "up",
            Self::Down => "down",
            Self::TopLeft => "topLeft",
            Self::TopRight => "topRight",
            Self::BottomLeft => "bottomLeft",
            Self::BottomRight => "bottomRight",
            Self::Scale(8) => "scale_8",
            Self::Scale(9) => "scale_9",
            Self::Scale(11) => "scale_11",
            Self::Scale(_) => "scale_12",
        }
    }

    /// The shifted box, for a frame of that width and height in pixels; the first pixel is 1.
    pub fn apply(self, true_box: Rect, frame_size: (usize, usize), rules: ShiftRules) -> Rect {
        clipped(self.moved(true_box, rules), frame_size)
    }

    /// Step 1.
    fn moved(self, true_box: Rect, rules: ShiftRules) -> Rect {
        let Rect { x, y, w, h } = true_box;
        let shift = |side: f64| match rules {
            ShiftRules::Matlab => (0.1 * side).ceil(),
            ShiftRules::OtbPy => (0.1 * side + 0.5).round_ties_even(),
        };
        let stretched = |dx: f64, dy: f64| stretched(true_box, dx, dy);
        match self {
            Self::Left => Rect { x: x - shift(w), ..true_box },
            Self::Right => Rect { x: x + shift(w), ..true_box },
            Self::Up => Rect { y: y - shift(h), ..true_box },
            Self::Down if rules == ShiftRules::OtbPy => Rect { w: w + shift(h), ..true_box },
            Self::Down => Rect { y: y + shift(h), ..true_box },
            Self::TopLeft => stretched(-0.1, -0.1),
            Self::TopRight => stretched(0.1, -0.1),
            Self::BottomLeft => stretched(-0.1, 0.1),
            Self::BottomRight => stretched(0.1, 0.1),
            Self::Scale(tenths) => scaled(true_box, f64::from(tenths) / 10.0),
        }
    }
}

/// Moves the corner at the side of the signs of (`dx`, `dy`) by these shares of the sides; the opposite corner stays.
fn stretched(true_box: Rect, dx: f64, dy: f64) -> Rect {
    let (x, w) = stretched_side(true_box.x, true_box.w, dx);
    let (y, h) = stretched_side(true_box.y, true_box.h, dy);
    Rect { x, y, w, h }
}

fn stretched_side(first: f64, side: f64, share: f64) -> (f64, f64) {
    let last = first + side - 1.0;
    if share < 0.0 {
        let first = (first + share * side).round();
        (first, last - first + 1.0)
    } else {
        (first, (last + share * side).round() - first + 1.0)
    }
}

fn scaled(true_box: Rect, ratio: f64) -> Rect {
    let (w, h) = (ratio * true_box.w, ratio * true_box.h);
    let (x, y) = true_box.centre();
    Rect::new((x - w / 2.0).round(), (y - h / 2.0).round(), w.round(), h.round())
}

/// Step 2.
fn clipped(shifted: Rect, (width, height): (usize, usize)) -> Rect {
    let (x, y) = (shifted.x.max(1.0), shifted.y.max(1.0));
    let w = if x + shifted.w - 1.0 > width as f64 { width as f64 - x + 1.0 } else { shifted.w };
    let h = if y + shifted.h - 1.0 > height as f64 { height as f64 - y + 1.0 } else { shifted.h };
    Rect { x, y, w, h }
}

/// A result of the run `label` with the scaling of its first box undone: divided by the ratio about its centre and rounded,
/// as one of the benchmark's two scoring codes does before it compares. Other runs' results stay as they are.
pub fn unscaled(result: Rect, label: &str) -> Rect {
    let Some(shift) = SHIFTS.iter().find(|shift| shift.name() == label) else { return result };
    match shift {
        Shift::Scale(tenths) => scaled(result, 10.0 / f64::from(*tenths)),
        _ => result,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRUE_BOX: Rect = Rect::new(51.0, 47.0, 25.0, 62.0);

    fn shifted(rules: ShiftRules) -> Vec<[f64; 4]> {
        let numbers = |Rect { x, y, w, h }: Rect| [x, y, w, h];
        SHIFTS.iter().map(|shift| numbers(shift.apply(TRUE_BOX, (320, 240), rules))).collect()
    }

    #[test]
    fn the_twelve_boxes_of_couple_by_hand() {
        assert_eq!(
            shifted(ShiftRules::Matlab),
            [
                [48.0, 47.0, 25.0, 62.0],
                [54.0, 47.0, 25.0, 62.0],
                [51.0, 40.0, 25.0, 62.0],
                [51.0, 54.0, 25.0, 62.0],
                [49.0, 41.0, 27.0, 68.0],
                [51.0, 41.0, 28.0, 68.0],
                [49.0, 47.0, 27.0, 68.0],
                [51.0, 47.0, 28.0, 68.0],
                [54.0, 53.0, 20.0, 50.0],
                [52.0, 50.0, 23.0, 56.0],
                [50.0, 44.0, 28.0, 68.0],
                [49.0, 41.0, 30.0, 74.0],
            ]
        );
    }

    #[test]
    fn the_python_code_widens_for_down_and_shifts_whole_tenths_further() {
        assert_eq!(shifted(ShiftRules::OtbPy)[3], [51.0, 47.0, 32.0, 62.0]);
        let wide = Rect::new(51.0, 47.0, 30.0, 62.0);
        assert_eq!(Shift::Left.apply(wide, (320, 240), ShiftRules::Matlab).x, 48.0);
        assert_eq!(Shift::Left.apply(wide, (320, 240), ShiftRules::OtbPy).x, 47.0);
    }

    #[test]
    fn boxes_are_cut_at_the_frame() {
        let near = Rect::new(2.0, 3.0, 40.0, 50.0);
        assert_eq!(Shift::Left.apply(near, (50, 60), ShiftRules::Matlab), Rect::new(1.0, 3.0, 40.0, 50.0));
        assert_eq!(
            Shift::BottomRight.apply(near, (43, 54), ShiftRules::Matlab),
            Rect::new(2.0, 3.0, 42.0, 52.0)
        );
        assert_eq!(
            Shift::Scale(12).apply(near, (500, 600), ShiftRules::Matlab),
            Rect::new(1.0, 1.0, 48.0, 60.0)
        );
    }

    #[test]
    fn undoing_a_scale_gives_the_true_size_back() {
        let result = Shift::Scale(8).apply(TRUE_BOX, (320, 240), ShiftRules::Matlab);
        assert_eq!(unscaled(result, "scale_8"), Rect::new(52.0, 47.0, 25.0, 63.0));
        assert_eq!(unscaled(result, "left"), result);
    }
}
