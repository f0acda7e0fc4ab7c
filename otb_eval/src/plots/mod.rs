//! Success and precision plots as the benchmark's papers show them, and their curves as CSV.
//!
//! Nothing here computes a score: a [`Curve`] says what to draw and by which score its tracker is ranked. SVG and
//! PNG come from the same drawing code (`draw`), and need no font of the system.

mod csv;
mod draw;
mod layout;
mod render;
mod style;
#[cfg(test)]
mod tests;

use thiserror::Error;

pub use csv::{curves_csv, points_csv};
pub use layout::Area;
pub(crate) use render::escape;
pub use style::Style;

/// One tracker's curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The tracker's name.
    pub label: String,
    /// Which [`Style`] it is drawn in: the tracker's place among all trackers, so that it looks the same in every
    /// plot, whatever its rank.
    pub style: usize,
    /// What the legend shows and ranks by: area under the curve, precision at 20 pixels, ... NaN if unknown, which
    /// ranks last.
    pub score: f64,
    /// Thresholds, ascending.
    pub x: Vec<f64>,
    /// Share of frames at each threshold, in [0, 1].
    pub y: Vec<f64>,
}

/// A plot of several trackers' curves, its vertical axis from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Above the plot, such as `Success plots of OPE`.
    pub title: String,
    /// Under the horizontal axis.
    pub x_label: String,
    /// Beside the vertical axis.
    pub y_label: String,
    /// Where the horizontal axis, which starts at 0, ends.
    pub x_max: f64,
    /// The threshold at which the legend's scores are read, marked by a vertical line; `None` if the score is a mean
    /// over the curve.
    pub mark: Option<f64>,
    /// The curves, in the order of the trackers; the legend ranks them.
    pub curves: Vec<Curve>,
}

/// Points of a plot's width unless another is asked for: 720 pixels of CSS.
const USUAL_POINTS: f64 = 540.0;
/// Size of an axis's label in units of a plot that is 720 wide.
const LABEL_SIZE: f64 = 16.0;

/// How a plot is to look.
#[derive(Debug, Clone, PartialEq)]
pub struct Appearance {
    /// Width, points (72 an inch); `None` for a web page's 720 pixels.
    pub width_points: Option<f64>,
    /// Size of the axes' labels, points; `None` for the usual share of the width. Other texts keep their proportion to it.
    pub font_points: Option<f64>,
    /// Whether the title is drawn; a paper has it in the caption.
    pub has_title: bool,
    /// The tracker that is drawn in front and alone in colour.
    pub highlight: Option<String>,
}

impl Default for Appearance {
    fn default() -> Self {
        Self { width_points: None, font_points: None, has_title: true, highlight: None }
    }
}

impl Appearance {
    /// By how much letters are larger than usual. With more than 3 nothing but letters would be left.
    pub fn text_factor(&self) -> f64 {
        let usual = LABEL_SIZE / layout::WIDTH * self.width_points.unwrap_or(USUAL_POINTS);
        self.font_points.map_or(1.0, |points| points / usual)
    }
}

/// Why a plot or its CSV cannot be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlotError {
    /// A curve that cannot be drawn.
    #[error("plot `{plot}`: the curve of `{label}` {problem}")]
    Curve {
        /// The plot's title, or `CSV`.
        plot: String,
        /// The curve's label.
        label: String,
        /// What is wrong with it and what it must be.
        problem: String,
    },
    /// An axis without an extent.
    #[error("plot `{plot}`: the horizontal axis ends at {x_max}; it must be a finite number above 0")]
    Axis {
        /// The plot's title.
        plot: String,
        /// The end that was given.
        x_max: f64,
    },
    /// The drawing library's own error.
    #[error("plot `{plot}` cannot be drawn: {reason}")]
    Drawing {
        /// The plot's title.
        plot: String,
        /// What the library says.
        reason: String,
    },
    /// The picture cannot be encoded.
    #[error("plot `{plot}` cannot be written as PNG: {source}")]
    Png {
        /// The plot's title.
        plot: String,
        /// What the encoder says.
        source: image::ImageError,
    },
}

/// A success plot: share of frames whose overlap exceeds a threshold in [0, 1].
pub fn success_plot(title: impl Into<String>, curves: Vec<Curve>) -> Plot {
    Plot {
        title: title.into(),
        x_label: "Overlap threshold".into(),
        y_label: "Success rate".into(),
        x_max: 1.0,
        mark: None,
        curves,
    }
}

/// A precision plot: share of frames whose centre error is at most a threshold of 0 to 50 pixels; marked at the 20
/// pixels that precision is quoted at.
pub fn precision_plot(title: impl Into<String>, curves: Vec<Curve>) -> Plot {
    Plot {
        title: title.into(),
        x_label: "Location error threshold (pixels)".into(),
        y_label: "Precision".into(),
        x_max: 50.0,
        mark: Some(20.0),
        curves,
    }
}

/// A normalised precision plot: share of frames whose centre error, divided by the true box's sides, is at most a
/// threshold of 0 to 0.5; marked at the 0.2 that it is quoted at.
pub fn normalised_precision_plot(title: impl Into<String>, curves: Vec<Curve>) -> Plot {
    Plot {
        title: title.into(),
        x_label: "Normalised location error threshold".into(),
        y_label: "Normalised precision".into(),
        x_max: 0.5,
        mark: Some(0.2),
        curves,
    }
}

/// A plot of precision over recall, over the thresholds of a tracker's confidence.
pub fn precision_recall_plot(title: impl Into<String>, curves: Vec<Curve>) -> Plot {
    Plot {
        title: title.into(),
        x_label: "Recall".into(),
        y_label: "Precision".into(),
        x_max: 1.0,
        mark: None,
        curves,
    }
}

impl Plot {
    /// The curves' indices from the highest score to the lowest; equal scores keep the curves' order, NaN comes last.
    pub fn ranking(&self) -> Vec<usize> {
        let score = |i: usize| {
            let score = self.curves[i].score;
            if score.is_nan() { f64::NEG_INFINITY } else { score }
        };
        let mut order: Vec<usize> = (0..self.curves.len()).collect();
        order.sort_by(|&a, &b| score(b).total_cmp(&score(a)));
        order
    }

    /// With the `count` best ranked curves only, and that of the tracker `always`.
    pub fn top(mut self, count: usize, always: Option<&str>) -> Self {
        let ranking = self.ranking();
        let kept: Vec<usize> = ranking.into_iter().take(count).collect();
        let mut place = 0;
        self.curves.retain(|curve| {
            place += 1;
            kept.contains(&(place - 1)) || always == Some(curve.label.as_str())
        });
        self
    }

    /// Says what makes a curve or an axis impossible to draw.
    fn check(&self) -> Result<(), PlotError> {
        if !(self.x_max.is_finite() && self.x_max > 0.0) {
            return Err(PlotError::Axis { plot: self.title.clone(), x_max: self.x_max });
        }
        self.curves.iter().try_for_each(|curve| curve.check(&self.title))
    }
}

impl Curve {
    fn check(&self, plot: &str) -> Result<(), PlotError> {
        let (x, y) = (&self.x, &self.y);
        let problem = if x.len() != y.len() {
            format!("has {} thresholds and {} values; give one value a threshold", x.len(), y.len())
        } else if x.is_empty() {
            "has no points; leave a tracker without a score out".into()
        } else if x.iter().chain(y).any(|v| !v.is_finite()) {
            "has a number that is not finite; leave that point out".into()
        } else if x.windows(2).any(|pair| pair[0] >= pair[1]) {
            "has thresholds that do not ascend; sort them".into()
        } else {
            return Ok(());
        };
        Err(PlotError::Curve { plot: plot.into(), label: self.label.clone(), problem })
    }

    /// What the legend says of it, as the papers do: `MDNet [0.678]`.
    fn legend(&self) -> String {
        const LONGEST: usize = 36;
        let mut label: String = self.label.chars().take(LONGEST).collect();
        if label.len() < self.label.len() {
            label.pop();
            label.push('…');
        }
        if self.score.is_nan() { format!("{label} [n/a]") } else { format!("{label} [{:.3}]", self.score) }
    }
}
