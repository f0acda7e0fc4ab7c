//! Where everything in a plot goes.
//!
//! 1. The legend's size follows from its rows.
//! 2. It goes into the first corner of the plotting area where no curve runs behind it, and if it must, smaller.
//! 3. If no corner is free, it goes to the right of a narrower plotting area.

use plotters::style::{FontDesc, FontFamily, FontStyle};

use super::{Appearance, Curve, Plot, style::FONTS};

/// A plot's size.
pub(super) const WIDTH: f64 = 720.0;
pub(super) const HEIGHT: f64 = 500.0;

const MARGIN_LEFT: f64 = 68.0;
const MARGIN_RIGHT: f64 = 18.0;
const MARGIN_TOP: f64 = 42.0;
const MARGIN_TOP_UNTITLED: f64 = 14.0;
const MARGIN_BOTTOM: f64 = 58.0;

/// Between the legend and the edge of the plotting area, and between the legend and the curves.
const GAP: f64 = 6.0;
/// Within the legend's box.
const PADDING: f64 = 6.0;
/// A row's height and its line's length, in heights of its letters.
const ROW: f64 = 1.18;
const SAMPLE: f64 = 2.8;
/// Heights of the legend's letters to try inside the area.
const LETTERS: [f64; 6] = [17.0, 16.0, 15.0, 14.0, 13.0, 12.0];
/// The narrowest plotting area beside a legend.
const NARROWEST: f64 = 260.0;

/// A rectangle in a plot, in the units of [`Plot::size`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Left edge.
    pub left: f64,
    /// Top edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Bottom edge.
    pub bottom: f64,
}

/// Where the legend goes and how large its letters are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Legend {
    pub(super) place: Area,
    pub(super) letters: f64,
    pub(super) inside: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    pub(super) area: Area,
    pub(super) legend: Option<Legend>,
    /// By how much letters are larger than usual.
    pub(super) text: f64,
    pub(super) has_title: bool,
    /// The curve that is to be seen first.
    pub(super) highlight: Option<usize>,
}

impl Plot {
    /// Width and height of the plot as SVG; the PNG has twice as many pixels each way.
    pub fn size(&self) -> (f64, f64) {
        (WIDTH, HEIGHT)
    }

    /// The plotting area, from threshold 0 at its left to `x_max` at its right and from value 0 at its bottom to 1 at
    /// its top.
    pub fn area(&self) -> Area {
        self.layout(&Appearance::default()).area
    }

    pub(super) fn layout(&self, appearance: &Appearance) -> Layout {
        let text = appearance.text_factor();
        let top = if appearance.has_title { MARGIN_TOP } else { MARGIN_TOP_UNTITLED };
        let whole = Area {
            left: MARGIN_LEFT * text,
            top: top * text,
            right: WIDTH - MARGIN_RIGHT * text,
            bottom: HEIGHT - MARGIN_BOTTOM * text,
        };
        let (area, legend) = match self.legend_inside(whole, text) {
            _ if self.curves.is_empty() => (whole, None),
            Some(inside) => (whole, Some(inside)),
            None => {
                let (area, legend) = beside(whole, &self.curves, text);
                (area, Some(legend))
            }
        };
        let highlight = appearance.highlight.as_ref();
        let highlight = highlight.and_then(|name| self.curves.iter().position(|curve| curve.label == *name));
        Layout { area, legend, text, has_title: appearance.has_title, highlight }
    }

    fn legend_inside(&self, whole: Area, text: f64) -> Option<Legend> {
        LETTERS.iter().find_map(|&letters| {
            let letters = letters * text;
            let (w, h) = legend_size(&self.curves, letters);
            let place = corners(whole, w, h).into_iter().find(|place| self.is_free(whole, *place))?;
            Some(Legend { place, letters, inside: true })
        })
    }

    /// Whether no curve comes near a place in the plotting area.
    fn is_free(&self, area: Area, place: Area) -> bool {
        let fits = place.left > area.left
            && place.right < area.right
            && place.bottom < area.bottom
            && place.top > area.top;
        let near = Area {
            left: place.left - GAP,
            top: place.top - GAP,
            right: place.right + GAP,
            bottom: place.bottom + GAP,
        };
        let points = self.curves.iter().map(|curve| self.points(area, curve));
        fits && points.into_iter().all(|points| points.windows(2).all(|pair| !near.meets(pair[0], pair[1])))
    }

    /// A curve's points in the units of the plot, cut off at the ends of the axes.
    pub(super) fn points(&self, area: Area, curve: &Curve) -> Vec<(f64, f64)> {
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(curve.x.len());
        let mut last = None;
        for (&x, &y) in curve.x.iter().zip(&curve.y) {
            let y = y.clamp(0.0, 1.0);
            for edge in [0.0, self.x_max] {
                if let Some((x0, y0)) = last.filter(|&(x0, _)| x0 < edge && edge < x) {
                    points.push((edge, y0 + (y - y0) * (edge - x0) / (x - x0)));
                }
            }
            if (0.0..=self.x_max).contains(&x) {
                points.push((x, y));
            }
            last = Some((x, y));
        }
        points.into_iter().map(|(x, y)| area.at(x / self.x_max, y)).collect()
    }
}

impl Area {
    /// The place of shares (0 to 1) of the horizontal and the vertical axis.
    pub(super) fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (self.left + (self.right - self.left) * x, self.bottom - (self.bottom - self.top) * y)
    }

    /// Whether a line from `a` to `b` has a point inside: what is left of it after clipping at the four edges.
    fn meets(&self, a: (f64, f64), b: (f64, f64)) -> bool {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let edges =
            [(-dx, a.0 - self.left), (dx, self.right - a.0), (-dy, a.1 - self.top), (dy, self.bottom - a.1)];
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (towards, room) in edges {
            if towards == 0.0 {
                if room < 0.0 {
                    return false;
                }
            } else if towards < 0.0 {
                from = from.max(room / towards);
            } else {
                to = to.min(room / towards);
            }
        }
        from <= to
    }
}

impl Legend {
    /// Left end of a row's line, its right end, left end of its text, and the middle's height.
    pub(super) fn row(&self, rank: usize) -> (f64, f64, f64, f64) {
        let left = self.place.left + PADDING;
        let right = left + SAMPLE * self.letters;
        let middle = self.place.top + PADDING + (rank as f64 + 0.5) * ROW * self.letters;
        (left, right, right + 0.5 * self.letters, middle)
    }

    /// Half of a row's height.
    pub(super) fn half_row(&self) -> f64 {
        ROW * self.letters / 2.0
    }
}

/// The corners in the order they are tried: where the papers put it first.
fn corners(area: Area, w: f64, h: f64) -> [Area; 4] {
    let (left, right) = (area.left + GAP, area.right - GAP);
    let (top, bottom) = (area.top + GAP, area.bottom - GAP);
    let at = |left: f64, top: f64| Area { left, top, right: left + w, bottom: top + h };
    [at(right - w, top), at(right - w, bottom - h), at(left, bottom - h), at(left, top)]
}

/// The legend to the right of a plotting area that makes room for it.
fn beside(whole: Area, curves: &[Curve], text: f64) -> (Area, Legend) {
    let height = whole.bottom - whole.top;
    let widest = whole.right - whole.left - NARROWEST;
    let fits = |letters: f64| {
        let (w, h) = legend_size(curves, letters);
        let share = (height / h).min(widest / w);
        if share < 1.0 { letters * share } else { letters }
    };
    let letters = fits(LETTERS[1] * text);
    let (w, h) = legend_size(curves, letters);
    let left = WIDTH - MARGIN_RIGHT / 2.0 - w;
    let place = Area { left, top: whole.top, right: left + w, bottom: whole.top + h };
    let area = Area { right: left - GAP, ..whole };
    (area, Legend { place, letters, inside: false })
}

fn legend_size(curves: &[Curve], letters: f64) -> (f64, f64) {
    let text = curves.iter().map(|curve| text_width(&curve.legend(), letters)).fold(0.0, f64::max);
    let w = 2.0 * PADDING + (SAMPLE + 0.5) * letters + text;
    (w, 2.0 * PADDING + ROW * letters * curves.len() as f64)
}

/// A text's width in letters of a height. Measured large, because the library rounds to whole pixels, and with room
/// for the wider fonts that a browser may have.
fn text_width(text: &str, letters: f64) -> f64 {
    const MEASURED_AT: f64 = 200.0;
    let font = FontDesc::new(FontFamily::Name(FONTS), MEASURED_AT, FontStyle::Normal);
    let measured =
        font.box_size(text).map_or(0.5 * MEASURED_AT * text.chars().count() as f64, |s| f64::from(s.0));
    measured * letters / MEASURED_AT * 1.06
}

/// The marks of an axis from 0 to `end`: at most ten steps of 1, 2 or 5 times a power of ten, and how many decimals
/// they need.
pub(super) fn ticks(end: f64) -> (Vec<f64>, usize) {
    let power = end.log10().floor() as i32 - 1;
    let (mantissa, power) = (power..power + 3)
        .flat_map(|power| [1.0, 2.0, 5.0].map(|mantissa| (mantissa, power)))
        .find(|&(mantissa, power)| end / (mantissa * 10f64.powi(power)) <= 10.0 + 1e-9)
        .unwrap_or((1.0, power));
    let step = mantissa * 10f64.powi(power);
    let count = (end / step + 1e-9).floor() as usize;
    ((0..=count).map(|i| i as f64 * step).collect(), (-power).max(0) as usize)
}
