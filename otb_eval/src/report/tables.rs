//! Tables of scores.

use std::fmt::Write as _;

use super::{
    Report,
    page::{sample, tabs},
};
use crate::plots::escape;

/// What stands where there is no score.
const NOTHING: &str = "–";

/// A table for each protocol or toolkit, the trackers its rows, ranked by the first metric.
pub(super) fn overall(report: &Report) -> String {
    let tables = report.overall.iter().map(|table| {
        let mut html = String::from("<div class=\"scroll\"><table>\n<thead><tr><th data-text>Tracker</th>");
        for metric in &table.metrics {
            let _ = write!(html, "<th>{}</th>", escape(metric));
        }
        html.push_str("<th>fps</th><th>seeds</th></tr></thead>\n<tbody>\n");
        let means = |row: usize, column: usize| table.rows[row].scores[column].map(|score| score.mean);
        let best: Vec<Option<f64>> =
            (0..table.metrics.len()).map(|c| best((0..table.rows.len()).map(|row| means(row, c)))).collect();
        let key = |row: usize| {
            table.rows[row].scores.first().copied().flatten().map_or(f64::NEG_INFINITY, |score| score.mean)
        };
        let mut order: Vec<usize> = (0..table.rows.len()).collect();
        order.sort_by(|&a, &b| key(b).total_cmp(&key(a)));
        for row in order.into_iter().map(|row| &table.rows[row]) {
            let label = escape(&report.trackers[row.tracker].label);
            let _ = write!(
                html,
                "<tr class=\"s{}\"><th scope=\"row\">{}{label}</th>",
                row.tracker,
                sample(row.tracker)
            );
            for (score, best) in row.scores.iter().zip(&best) {
                let text = score.map_or(NOTHING.into(), |score| match score.spread {
                    Some(spread) => format!("{:.3} <small>± {spread:.3}</small>", score.mean),
                    None => format!("{:.3}", score.mean),
                });
                let _ = write!(html, "{}", cell(&text, score.map(|score| score.mean), *best, ""));
            }
            let fps = row.fps.map_or(NOTHING.into(), |fps| format!("{fps:.1}"));
            let _ = writeln!(html, "<td>{fps}</td><td>{}</td></tr>", row.seeds);
        }
        (table.title.as_str(), html + "</tbody></table></div>\n")
    });
    tabs(tables)
}

/// A table for each metric, the sequences its rows, the trackers its columns.
pub(super) fn sequences(report: &Report) -> String {
    tabs(report.sequences.iter().map(|table| {
        let rows = table.rows.iter().map(|row| (row.sequence.clone(), row.scores.as_slice()));
        (table.metric.as_str(), by_tracker(report, "Sequence", rows))
    }))
}

/// A table with a column a tracker; the best of a row stands out.
pub(super) fn by_tracker<'a>(
    report: &Report,
    first: &str,
    rows: impl Iterator<Item = (String, &'a [Option<f64>])>,
) -> String {
    let mut html = format!("<div class=\"scroll tall\"><table>\n<thead><tr><th data-text>{first}</th>");
    for (place, tracker) in report.trackers.iter().enumerate() {
        let _ = write!(html, "<th class=\"s{place}\">{}</th>", escape(&tracker.label));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for (label, scores) in rows {
        let _ = write!(html, "<tr><th scope=\"row\">{}</th>", escape(&label));
        let best = best(scores.iter().copied());
        for (place, score) in scores.iter().enumerate() {
            let text = score.map_or(NOTHING.into(), |score| format!("{score:.3}"));
            html.push_str(&cell(&text, *score, best, &format!("s{place}")));
        }
        html.push_str("</tr>\n");
    }
    html + "</tbody></table></div>\n"
}

/// The best of several scores that may be missing.
fn best(scores: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    scores.flatten().reduce(f64::max)
}

/// A cell that stands out if its score shows the same digits as the best.
fn cell(text: &str, score: Option<f64>, best: Option<f64>, class: &str) -> String {
    let is_best = matches!((score, best), (Some(a), Some(b)) if format!("{a:.3}") == format!("{b:.3}"));
    match (class, is_best) {
        ("", false) => format!("<td>{text}</td>"),
        ("", true) => format!("<td class=\"best\">{text}</td>"),
        (class, false) => format!("<td class=\"{class}\">{text}</td>"),
        (class, true) => format!("<td class=\"{class} best\">{text}</td>"),
    }
}
