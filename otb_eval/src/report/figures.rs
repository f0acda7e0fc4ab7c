//! Plots, bars by attribute, and the numbers under the pointer.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::{AttributeChart, Report, ReportError, page::tabs, tables};
use crate::plots::{Plot, escape};

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
    Ok(tabs(groups.into_iter()))
}

/// What the script needs of every plot, as JSON that can stand in a page.
pub(super) fn numbers(report: &Report) -> String {
    let plots: Vec<Value> = report.plots.iter().flat_map(|group| &group.plots).map(plot_numbers).collect();
    let labels: Vec<&str> = report.trackers.iter().map(|tracker| tracker.label.as_str()).collect();
    let json = json!({ "trackers": labels, "plots": plots });
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

fn rounded(values: &[f64]) -> Vec<f64> {
    let scale = 10f64.powi(DECIMALS);
    values.iter().map(|value| (value * scale).round() / scale).collect()
}

/// Grouped bars, and the same numbers as a table.
pub(super) fn attributes(report: &Report) -> String {
    tabs(report.attributes.iter().map(|chart| {
        let source = format!("<p>Attributes from <b>{}</b>.</p>\n", escape(&chart.source));
        let rows = chart
            .attributes
            .iter()
            .map(|row| (format!("{} ({})", row.attribute, row.sequences), row.scores.as_slice()));
        let table = tables::by_tracker(report, "Attribute (sequences)", rows);
        let bars = bars(report, chart);
        (
            chart.title.as_str(),
            format!("{source}{bars}<details><summary>Numbers</summary>\n{table}</details>\n"),
        )
    }))
}

fn bars(report: &Report, chart: &AttributeChart) -> String {
    let mut html = String::from("<div class=\"scroll\"><div class=\"bars\">\n<div class=\"scale\">");
    for fifth in (0..=5).rev() {
        let _ = write!(html, "<span>{:.1}</span>", f64::from(fifth) / 5.0);
    }
    html.push_str("</div>\n");
    for row in &chart.attributes {
        html.push_str("<div class=\"group\"><div class=\"stack\">");
        for (place, score) in row.scores.iter().enumerate() {
            let Some(score) = score.filter(|score| score.is_finite()) else { continue };
            let height = 100.0 * score.clamp(0.0, 1.0);
            let label = escape(&report.trackers[place].label);
            let _ = write!(
                html,
                "<i class=\"s{place}\" style=\"height:{height:.1}%\" title=\"{label} {score:.3}\"></i>"
            );
        }
        let _ =
            writeln!(html, "</div><b>{}</b><small>{}</small></div>", escape(&row.attribute), row.sequences);
    }
    html + "</div></div>\n"
}
