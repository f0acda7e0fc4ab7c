//! The state and its estimates over a run, as an SVG.

use std::fmt::Write;

use super::{ExperimentError, Filter, SAMPLES, Setup, TIME_STEP, truth};
use crate::bayes::State;

const WIDTH: f64 = 860.0;
const PANEL_HEIGHT: f64 = 200.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 150.0;
const TOP: f64 = 44.0;
const BETWEEN: f64 = 34.0;
const BOTTOM: f64 = 48.0;
/// Colours that are told apart with any eyes (Okabe and Ito 2008), and dashes for those that lie on each other.
const STYLES: [(&str, &str); 5] =
    [("#d55e00", ""), ("#0072b2", "7 4"), ("#009e73", "2 3"), ("#cc79a7", "9 3 2 3"), ("#e69f00", "4 2")];

/// A curve of every panel.
struct Curve {
    name: String,
    colour: &'static str,
    dashes: &'static str,
    states: Vec<State<2>>,
}

/// Draws x and x' of the truth, of run 0's measurements and of each filter's estimates over time, and the errors of x.
///
/// # Errors
/// [`ExperimentError`] if the set-up is out of range.
pub fn plot(setup: &Setup, filters: &[Filter], seed: u64) -> Result<String, ExperimentError> {
    setup.check()?;
    let truth = truth(setup.mu);
    let measured = setup.measure(&truth, seed, 0);
    let mut curves = vec![Curve { name: "truth".to_owned(), colour: "#000000", dashes: "", states: truth }];
    for (index, filter) in filters.iter().enumerate() {
        let (colour, dashes) = STYLES[index % STYLES.len()];
        let track = filter.track(setup, &measured, seed, 0, index);
        let states = track.beliefs.iter().map(|belief| belief.mean).collect();
        curves.push(Curve { name: filter.to_string(), colour, dashes, states });
    }
    Ok(draw(setup, &curves, &measured))
}

/// One of the pictures below each other; a row of values for each curve, or none.
struct Panel<'a> {
    label: &'a str,
    values: Vec<Vec<f64>>,
    dots: &'a [f64],
}

fn panels<'a>(curves: &[Curve], measured: &'a [f64]) -> [Panel<'a>; 3] {
    let truth = &curves[0].states;
    let of = |component: usize| {
        let row = |curve: &Curve| curve.states.iter().map(|state| state[component]).collect();
        curves.iter().map(row).collect()
    };
    let errors = |curve: &Curve| curve.states.iter().zip(truth).map(|(a, b)| a[0] - b[0]).collect();
    [
        Panel { label: "x", values: of(0), dots: measured },
        Panel { label: "x\u{2032}", values: of(1), dots: &[] },
        Panel { label: "error of x", values: curves.iter().map(errors).collect(), dots: &[] },
    ]
}

fn draw(setup: &Setup, curves: &[Curve], measured: &[f64]) -> String {
    let panels = panels(curves, measured);
    let height = TOP + panels.len() as f64 * (PANEL_HEIGHT + BETWEEN) - BETWEEN + BOTTOM;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
         height=\"{height}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    text(&mut svg, LEFT, 24.0, "start", &title(setup));
    for (number, panel) in panels.iter().enumerate() {
        draw_panel(&mut svg, TOP + number as f64 * (PANEL_HEIGHT + BETWEEN), panel, curves);
    }
    text(&mut svg, LEFT + inner_width() / 2.0, height - 12.0, "middle", "time, s");
    legend(&mut svg, curves);
    svg + "</svg>\n"
}

fn title(setup: &Setup) -> String {
    format!(
        "Van der Pol oscillator, mu {}: {SAMPLES} samples, q {}, r {:.3e}",
        setup.mu, setup.process_variance, setup.measurement_variance
    )
}

fn inner_width() -> f64 {
    WIDTH - LEFT - RIGHT
}

/// Where a sample is, from left to right.
fn across(k: usize) -> f64 {
    LEFT + inner_width() * k as f64 / (SAMPLES - 1) as f64
}

/// 1, 2 or 5 times a power of ten: what leaves at most `most` steps in `range`.
fn tick_step(range: f64, most: f64) -> f64 {
    let power = 10f64.powf((range / most).log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|digit| digit * power)
        .into_iter()
        .find(|step| range / step <= most)
        .unwrap_or(range)
}

fn draw_panel(svg: &mut String, top: f64, panel: &Panel, curves: &[Curve]) {
    let values =
        || panel.values.iter().flatten().chain(panel.dots).copied().filter(|value| value.is_finite());
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let step = tick_step((high - low).max(1e-9), 6.0);
    let (first, last) = ((low / step).floor(), (high / step).ceil());
    let down = |value: f64| top + PANEL_HEIGHT * (last - value / step) / (last - first).max(1.0);
    let _ = writeln!(
        svg,
        "<rect x=\"{LEFT}\" y=\"{top}\" width=\"{}\" height=\"{PANEL_HEIGHT}\" fill=\"none\" stroke=\"#888888\"/>",
        inner_width()
    );
    let decimals = (-step.log10().floor()).max(0.0) as usize;
    for number in 0..=(last - first) as i32 {
        let value = (first + f64::from(number)) * step;
        grid(svg, (LEFT, down(value)), (LEFT + inner_width(), down(value)));
        text(svg, LEFT - 8.0, down(value) + 4.5, "end", &format!("{value:.decimals$}"));
    }
    for k in (0..SAMPLES).step_by(20) {
        grid(svg, (across(k), top), (across(k), top + PANEL_HEIGHT));
        let seconds = format!("{:.0}", k as f64 * TIME_STEP);
        text(svg, across(k), top + PANEL_HEIGHT + 17.0, "middle", &seconds);
    }
    text(svg, LEFT + 6.0, top + 17.0, "start", panel.label);
    for (k, value) in panel.dots.iter().enumerate() {
        let _ = writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.2}\" r=\"2.2\" fill=\"#999999\"/>",
            across(k),
            down(*value)
        );
    }
    for (curve, values) in curves.iter().zip(&panel.values) {
        let points: Vec<String> = values
            .iter()
            .enumerate()
            .filter(|(_, value)| value.is_finite())
            .map(|(k, value)| format!("{:.1},{:.2}", across(k), down(*value)))
            .collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-dasharray=\"{}\"/>",
            points.join(" "),
            curve.colour,
            curve.dashes
        );
    }
}

fn legend(svg: &mut String, curves: &[Curve]) {
    let left = WIDTH - RIGHT + 14.0;
    for (row, curve) in curves.iter().enumerate() {
        let y = TOP + 12.0 + 22.0 * row as f64;
        let _ = writeln!(
            svg,
            "<line x1=\"{left}\" y1=\"{y}\" x2=\"{}\" y2=\"{y}\" stroke=\"{}\" stroke-width=\"2\" \
             stroke-dasharray=\"{}\"/>",
            left + 30.0,
            curve.colour,
            curve.dashes
        );
        text(svg, left + 38.0, y + 4.5, "start", &curve.name);
    }
    let y = TOP + 12.0 + 22.0 * curves.len() as f64;
    let _ = writeln!(svg, "<circle cx=\"{}\" cy=\"{y}\" r=\"2.2\" fill=\"#999999\"/>", left + 15.0);
    text(svg, left + 38.0, y + 4.5, "start", "measured");
}

fn grid(svg: &mut String, from: (f64, f64), to: (f64, f64)) {
    let _ = writeln!(
        svg,
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#dddddd\" stroke-width=\"0.7\"/>",
        from.0, from.1, to.0, to.1
    );
}

fn text(svg: &mut String, x: f64, y: f64, anchor: &str, words: &str) {
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>");
}
