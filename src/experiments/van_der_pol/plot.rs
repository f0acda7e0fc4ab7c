//! The state and its estimates over a run, as an SVG.

use std::fmt::Write;

use super::{ExperimentError, Filter, SAMPLES, Setup, TIME_STEP, truth};
use crate::bayes::State;

const WIDTH: f64 = 860.0;
const PANEL_HEIGHT: f64 = 250.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 150.0;
const TOP: f64 = 44.0;
const BETWEEN: f64 = 34.0;
const BOTTOM: f64 = 48.0;
/// Colours that are told apart with any eyes (Okabe and Ito 2008), and dashes for those that lie on each other.
const STYLES: [(&str, &str); 5] =
    [("#d55e00", ""), ("#0072b2", "7 4"), ("#009e73", "2 3"), ("#cc79a7", "9 3 2 3"), ("#e69f00", "4 2")];

/// A curve of both panels.
struct Curve {
    name: String,
    colour: &'static str,
    dashes: &'static str,
    states: Vec<State<2>>,
}

/// Draws x and x' of the truth, of run 0's measurements and of each filter's estimates over time.
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

fn draw(setup: &Setup, curves: &[Curve], measured: &[f64]) -> String {
    let height = TOP + 2.0 * PANEL_HEIGHT + BETWEEN + BOTTOM;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
         height=\"{height}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    text(&mut svg, LEFT, 24.0, "start", &title(setup));
    for component in 0..2 {
        let top = TOP + component as f64 * (PANEL_HEIGHT + BETWEEN);
        let seen = if component == 0 { measured } else { &[] };
        panel(&mut svg, top, component, curves, seen);
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

fn panel(svg: &mut String, top: f64, component: usize, curves: &[Curve], measured: &[f64]) {
    let values = || {
        let of_curves = curves.iter().flat_map(|curve| curve.states.iter().map(|state| state[component]));
        of_curves.chain(measured.iter().copied()).filter(|value| value.is_finite())
    };
    let (low, high) =
        (values().fold(f64::INFINITY, f64::min).floor(), values().fold(f64::NEG_INFINITY, f64::max).ceil());
    let down = |value: f64| top + PANEL_HEIGHT * (high - value) / (high - low).max(1.0);
    let _ = writeln!(
        svg,
        "<rect x=\"{LEFT}\" y=\"{top}\" width=\"{}\" height=\"{PANEL_HEIGHT}\" fill=\"none\" stroke=\"#888888\"/>",
        inner_width()
    );
    let every = ((high - low) / 6.0).ceil().max(1.0);
    let ticks = (0..=((high - low) / every) as usize).map(|i| low + i as f64 * every);
    for value in ticks {
        grid(svg, (LEFT, down(value)), (LEFT + inner_width(), down(value)));
        text(svg, LEFT - 8.0, down(value) + 4.5, "end", &value.to_string());
    }
    for k in (0..SAMPLES).step_by(20) {
        grid(svg, (across(k), top), (across(k), top + PANEL_HEIGHT));
        let seconds = format!("{:.0}", k as f64 * TIME_STEP);
        text(svg, across(k), top + PANEL_HEIGHT + 17.0, "middle", &seconds);
    }
    text(svg, 16.0, top + PANEL_HEIGHT / 2.0, "middle", ["x", "x\u{2032}"][component]);
    for (k, value) in measured.iter().enumerate() {
        let _ = writeln!(
            svg,
            "<circle cx=\"{:.1}\" cy=\"{:.2}\" r=\"2.2\" fill=\"#999999\"/>",
            across(k),
            down(*value)
        );
    }
    for curve in curves {
        let points: Vec<String> = curve
            .states
            .iter()
            .enumerate()
            .filter(|(_, state)| state[component].is_finite())
            .map(|(k, state)| format!("{:.1},{:.2}", across(k), down(state[component])))
            .collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" stroke-dasharray=\"{}\"/>",
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
