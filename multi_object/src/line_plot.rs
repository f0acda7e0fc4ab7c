//! Line plots as SVG, for curves over frames.

use std::fmt::Write as _;

const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 360.0;
const LEFT: f64 = 60.0;
const RIGHT: f64 = 130.0;
const TOP: f64 = 36.0;
const BOTTOM: f64 = 48.0;
/// Colours that people with any colour vision tell apart (Okabe and Ito).
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// A named curve of points (x, y), by x.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

/// A plot of curves over one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct LinePlot {
    /// What stands above it.
    pub title: String,
    /// The horizontal axis, with its unit.
    pub x_label: String,
    /// The vertical axis, with its unit. It begins at 0.
    pub y_label: String,
    /// The curves, in the legend's order.
    pub curves: Vec<Curve>,
}

impl LinePlot {
    /// The plot as an SVG document.
    pub fn to_svg(&self) -> String {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let x_end = points().map(|point| point.0).fold(1.0, f64::max);
        let y_step = step_for(points().map(|point| point.1).fold(0.0, f64::max));
        let y_end = y_step * (points().map(|point| point.1).fold(y_step, f64::max) / y_step).ceil();
        let (plot_width, plot_height) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
        let x_of = |x: f64| LEFT + plot_width * x / x_end;
        let y_of = |y: f64| TOP + plot_height * (1.0 - y / y_end);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
             font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"#222\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        );
        // Writing to a String cannot fail.
        let mut line = |text: String| {
            let _ = writeln!(svg, "{text}");
        };
        line(text(WIDTH / 2.0, 22.0, "middle", &self.title, " font-size=\"15\" font-weight=\"bold\""));
        let mut y = 0.0;
        while y <= y_end + y_step / 2.0 {
            let at = y_of(y);
            line(format!("<path d=\"M{LEFT} {at:.1}H{:.1}\" stroke=\"#e3e3e3\"/>", WIDTH - RIGHT));
            line(text(LEFT - 6.0, at + 4.0, "end", &tick(y, y_step), ""));
            y += y_step;
        }
        let x_step = step_for(x_end);
        let mut x = 0.0;
        while x <= x_end {
            line(text(x_of(x), HEIGHT - BOTTOM + 18.0, "middle", &tick(x, x_step), ""));
            x += x_step;
        }
        line(format!(
            "<path d=\"M{LEFT} {TOP}V{:.1}H{:.1}\" stroke=\"#222\" fill=\"none\"/>",
            HEIGHT - BOTTOM,
            WIDTH - RIGHT
        ));
        line(text(LEFT + plot_width / 2.0, HEIGHT - 10.0, "middle", &self.x_label, ""));
        let turned = format!(" transform=\"rotate(-90 16 {:.1})\"", TOP + plot_height / 2.0);
        line(text(16.0, TOP + plot_height / 2.0, "middle", &self.y_label, &turned));
        for (index, curve) in self.curves.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            let points = curve.points.iter().map(|&(x, y)| format!("{:.1},{:.1}", x_of(x), y_of(y)));
            let points: Vec<String> = points.collect();
            line(format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.4\" stroke-linejoin=\"round\"/>",
                points.join(" ")
            ));
            let (left, at) = (WIDTH - RIGHT + 12.0, TOP + 14.0 + 20.0 * index as f64);
            line(format!("<path d=\"M{left} {at:.1}h22\" stroke=\"{colour}\" stroke-width=\"3\"/>"));
            line(text(left + 28.0, at + 4.0, "start", &curve.name, ""));
        }
        svg + "</svg>\n"
    }
}

fn text(x: f64, y: f64, anchor: &str, what: &str, more: &str) -> String {
    let what = what.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\"{more}>{what}</text>")
}

/// A step of 1, 2 or 5 times a power of ten that cuts [0, `end`] into at most six.
fn step_for(end: f64) -> f64 {
    let least = (end / 6.0).max(1e-9);
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .iter()
        .map(|one| one * power)
        .find(|step| *step >= least * (1.0 - 1e-9))
        .unwrap_or(power * 10.0)
}

fn tick(value: f64, step: f64) -> String {
    let digits = (-step.log10().floor()).max(0.0) as usize;
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_at_most_six() {
        assert_eq!([1.0, 6.0, 7.0, 30.0, 795.0].map(step_for), [0.2, 1.0, 2.0, 5.0, 200.0]);
        assert_eq!((tick(0.4, 0.2), tick(200.0, 200.0)), ("0.4".into(), "200".into()));
    }

    #[test]
    fn a_curve_is_where_its_points_are_and_names_are_escaped() {
        let plot = LinePlot {
            title: "a < b".into(),
            x_label: "frame".into(),
            y_label: "RMSE, pixels".into(),
            curves: vec![Curve { name: "PF".into(), points: vec![(0.0, 0.0), (10.0, 6.0)] }],
        };
        let svg = plot.to_svg();
        assert!(svg.contains("a &lt; b") && svg.contains(">PF</text>"), "{svg}");
        // Bottom left to top right of the plotting area.
        assert!(svg.contains("points=\"60.0,312.0 770.0,36.0\""), "{svg}");
    }
}
