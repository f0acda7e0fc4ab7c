//! Plots, and the numbers under the pointer.

use std::fmt::Write as _;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde_json::{Value, json};

use super::{
    Report, ReportError, Timeline,
    parts::{Choice, panels},
};
use crate::plots::Plot;

/// Digits of a value under the pointer.
const DECIMALS: i32 = 4;

/// The plots as SVG, a tab for each group. The n-th plot of the page has the n-th entry of [`numbers`].
pub(super) fn plots(report: &Report) -> Result<String, ReportError> {
    let mut groups = Vec::with_capacity(report.plots.len());
    for group in &report.plots {
        let mut html = String::from(if group.plots.len() > 4 {
            "<div class=\"plots small\">\n"
        } else {
            "<div class=\"plots\">\n"
        });
        for plot in &group.plots {
            let _ = writeln!(html, "<div class=\"plot\">{}</div>", plot.svg()?);
        }
        groups.push((group.title.as_str(), html + "</div>\n"));
    }
    Ok(panels(Choice::Tabs, groups.into_iter()))
}

/// What the script needs of every plot and timeline, as JSON that can stand in a page.
pub(super) fn numbers(report: &Report) -> String {
    let plots: Vec<Value> = report.plots.iter().flat_map(|group| &group.plots).map(plot_numbers).collect();
    let labels: Vec<&str> = report.trackers.iter().map(|tracker| tracker.label.as_str()).collect();
    let timelines: Vec<Value> = report.timelines.iter().map(timeline_numbers).collect();
    let json = json!({ "trackers": labels, "plots": plots, "timelines": timelines });
    json.to_string().replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// A plot's area, and each curve as its tracker, thresholds (unless they are the first curve's) and values.
fn plot_numbers(plot: &Plot) -> Value {
    let area = plot.area();
    let curves: Vec<Value> = plot
        .curves
        .iter()
        .enumerate()
        .map(|(i, curve)| {
            let mut entry = json!({ "t": curve.style, "y": rounded(&curve.y) });
            if i == 0 || curve.x != plot.curves[0].x {
                entry["x"] = json!(rounded(&curve.x));
            }
            entry
        })
        .collect();
    let corners = [area.left, area.top, area.right, area.bottom];
    json!({ "area": rounded(&corners), "max": plot.x_max, "label": plot.x_label, "curves": curves })
}

/// Stands for a frame without a value.
const NOTHING: u8 = 255;
/// Steps of a value that is shown.
const STEPS: f64 = 250.0;

/// A byte a value, so that a page of a hundred sequences stays small: overlaps in 250ths, errors in 250ths of the largest.
fn timeline_numbers(timeline: &Timeline) -> Value {
    let largest = timeline.errors.iter().flatten().flatten().copied().fold(1.0, f64::max);
    let bytes = |values: &Vec<Option<f64>>, unit: f64| {
        let byte = |value: &Option<f64>| {
            value.map_or(NOTHING, |value| (value / unit * STEPS).round().clamp(0.0, STEPS) as u8)
        };
        STANDARD.encode(values.iter().map(byte).collect::<Vec<u8>>())
    };
    let overlaps: Vec<String> = timeline.overlaps.iter().map(|values| bytes(values, 1.0)).collect();
    let errors: Vec<String> = timeline.errors.iter().map(|values| bytes(values, largest)).collect();
    json!({
        "name": timeline.sequence,
        "every": timeline.every,
        "frames": timeline.frames,
        "largest": (largest * 10.0).round() / 10.0,
        "overlaps": overlaps,
        "errors": errors,
    })
}

fn rounded(values: &[f64]) -> Vec<f64> {
    let scale = 10f64.powi(DECIMALS);
    values.iter().map(|value| (value * scale).round() / scale).collect()
}
