//! Tables of scores.

use std::fmt::Write as _;

use super::{
    AttributeChart, OverallTable, Report, Score,
    parts::{Choice, panels, sample},
};
use crate::plots::escape;

/// What stands where there is no score.
const NOTHING: &str = "–";

/// A table for each protocol or toolkit, the trackers its rows, ranked by the first metric.
pub(super) fn overall(report: &Report) -> String {
    let tables = report.overall.iter().map(|table| (table.title.as_str(), overall_table(report, table)));
    panels(Choice::Tabs, tables)
}

fn overall_table(report: &Report, table: &OverallTable) -> String {
    let mut html = format!(
        "<div class=\"scroll\"><table data-name=\"{}\">\n<thead><tr><th data-text>Tracker</th>",
        escape(&table.title)
    );
    for metric in &table.metrics {
        let _ = write!(html, "<th>{}</th>", escape(metric));
    }
    let has_speed = table.rows.iter().any(|row| row.fps.is_some());
    let has_seeds = table.rows.iter().any(|row| row.seeds > 1);
    if has_speed {
        html.push_str("<th>fps</th>");
    }
    if has_seeds {
        html.push_str("<th>seeds</th>");
    }
    if let Some(against) = &table.against {
        let _ = write!(html, "<th>{}</th><th>p</th>", escape(against));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    let means = |row: usize, column: usize| table.rows[row].scores[column].map(|score| score.mean);
    let ends: Vec<Ends> =
        (0..table.metrics.len()).map(|c| Ends::of((0..table.rows.len()).map(|row| means(row, c)))).collect();
    let key = |row: usize| {
        table.rows[row].scores.first().copied().flatten().map_or(f64::NEG_INFINITY, |score| score.mean)
    };
    let mut order: Vec<usize> = (0..table.rows.len()).collect();
    order.sort_by(|&a, &b| key(b).total_cmp(&key(a)));
    for row in order.into_iter().map(|row| &table.rows[row]) {
        let label = escape(&report.trackers[row.tracker].label);
        let place = row.tracker;
        let _ = write!(html, "<tr class=\"s{place}\"><th scope=\"row\">{}{label}</th>", sample(place));
        for (score, ends) in row.scores.iter().zip(&ends) {
            let text = score.map_or(NOTHING.into(), |score| with_certainty(&score));
            html.push_str(&cell(&text, score.map(|score| score.mean), ends, ""));
        }
        if has_speed {
            let fps = row.fps.map_or(NOTHING.into(), |fps| format!("{fps:.1}"));
            let _ = write!(html, "<td>{fps}</td>");
        }
        if has_seeds {
            let _ = write!(html, "<td>{}</td>", row.seeds);
        }
        if table.against.is_some() {
            match &row.against {
                Some(tested) => {
                    let (low, high) = (tested.interval.low, tested.interval.high);
                    let clear = if tested.interval.is_clear_of_zero() { " class=\"clear\"" } else { "" };
                    let _ = write!(
                        html,
                        "<td{clear}>{:+.3} <small>[{low:+.3}, {high:+.3}]</small></td><td>{}</td>",
                        tested.difference,
                        probability(tested.p)
                    );
                }
                None => html.push_str(&format!("<td>{NOTHING}</td><td>{NOTHING}</td>")),
            }
        }
        html.push_str("</tr>\n");
    }
    html + "</tbody></table></div>\n"
}

fn probability(p: f64) -> String {
    if p < 0.0005 { "&lt; 0.001".to_owned() } else { format!("{p:.3}") }
}

/// A mean with its spread over seeds and its interval over sequences.
fn with_certainty(score: &Score) -> String {
    let spread = score.spread.map_or_else(String::new, |spread| format!("± {spread:.3}"));
    let interval =
        score.interval.map_or_else(String::new, |one| format!("[{:.3}, {:.3}]", one.low, one.high));
    let more = [spread, interval].into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(" ");
    if more.is_empty() {
        format!("{:.3}", score.mean)
    } else {
        format!("{:.3} <small>{more}</small>", score.mean)
    }
}

/// A table for each metric, the sequences its rows, the trackers its columns; one is chosen from a list.
pub(super) fn sequences(report: &Report) -> String {
    let tables = report.sequences.iter().map(|table| {
        let rows = table.rows.iter().map(|row| {
            let name = escape(&row.sequence);
            let shown = report.shown(&row.sequence);
            let label =
                shown.map_or(name.clone(), |place| format!("<a href=\"#sequence-{place}\">{name}</a>"));
            (label, row.scores.as_slice())
        });
        (table.metric.as_str(), by_tracker(report, &table.metric, "Sequence", rows))
    });
    let tables = panels(Choice::Select("Measure"), tables);
    if tables.is_empty() {
        return tables;
    }
    format!(
        "<p class=\"tools\"><label>Filter rows <input type=\"search\" id=\"filter\" placeholder=\"part of a name\"></label> <output id=\"filtered\"></output></p>\n{tables}"
    )
}

/// A table with a column a tracker; the best of a row stands out.
fn by_tracker<'a>(
    report: &Report,
    name: &str,
    first: &str,
    rows: impl Iterator<Item = (String, &'a [Option<f64>])>,
) -> String {
    let mut html = format!(
        "<div class=\"scroll tall\"><table data-name=\"{}\">\n<thead><tr><th data-text>{first}</th>",
        escape(name)
    );
    for (place, tracker) in report.trackers.iter().enumerate() {
        let _ = write!(html, "<th class=\"s{place}\">{}</th>", escape(&tracker.label));
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    for (label, scores) in rows {
        let _ = write!(html, "<tr><th scope=\"row\">{label}</th>");
        let ends = Ends::of(scores.iter().copied());
        for (place, score) in scores.iter().enumerate() {
            let text = score.map_or(NOTHING.into(), |score| format!("{score:.3}"));
            html.push_str(&cell(&text, *score, &ends, &format!("s{place}")));
        }
        html.push_str("</tr>\n");
    }
    html + "</tbody></table></div>\n"
}

/// A heat map for each chart: trackers by attributes, a cell's colour its score's place between the least and the most of the chart.
pub(super) fn attributes(report: &Report) -> String {
    let charts = report.attributes.iter().map(|chart| {
        let source =
            format!("<p>Attributes from <b>{}</b>; the darker, the better.</p>\n", escape(&chart.source));
        (chart.title.as_str(), source + &heat_map(report, chart))
    });
    panels(Choice::Tabs, charts)
}

fn heat_map(report: &Report, chart: &AttributeChart) -> String {
    let all = || chart.attributes.iter().flat_map(|row| row.scores.iter().flatten().copied());
    let (least, most) = (all().fold(1.0, f64::min), all().fold(0.0, f64::max));
    let mut html = format!(
        "<div class=\"scroll\"><table class=\"heat\" data-name=\"{}\">\n<thead><tr><th data-text>Tracker</th>",
        escape(&chart.title)
    );
    for row in &chart.attributes {
        let _ = write!(html, "<th>{}<small> {}</small></th>", escape(&row.attribute), row.sequences);
    }
    html.push_str("</tr></thead>\n<tbody>\n");
    let ends: Vec<Ends> = chart.attributes.iter().map(|row| Ends::of(row.scores.iter().copied())).collect();
    for (place, tracker) in report.trackers.iter().enumerate() {
        let scores: Vec<Option<f64>> = chart.attributes.iter().map(|row| row.scores[place]).collect();
        if scores.iter().all(Option::is_none) {
            continue;
        }
        let label = escape(&tracker.label);
        let _ = write!(html, "<tr class=\"s{place}\"><th scope=\"row\">{}{label}</th>", sample(place));
        for (score, ends) in scores.into_iter().zip(&ends) {
            match score {
                None => html.push_str(&format!("<td>{NOTHING}</td>")),
                Some(score) => {
                    let share = if most > least { (score - least) / (most - least) } else { 0.5 };
                    let class = ends.class(score);
                    let _ = write!(html, "<td class=\"{class}\" style=\"--v:{share:.2}\">{score:.3}</td>");
                }
            }
        }
        html.push_str("</tr>\n");
    }
    html + "</tbody></table></div>\n"
}

/// The best and the second best of several scores, by the digits shown.
struct Ends {
    best: Option<String>,
    second: Option<String>,
}

impl Ends {
    fn of(scores: impl Iterator<Item = Option<f64>>) -> Self {
        let mut shown: Vec<f64> = scores.flatten().map(|score| (score * 1000.0).round()).collect();
        shown.sort_by(|a, b| b.total_cmp(a));
        shown.dedup();
        let text = |value: Option<&f64>| value.map(|value| format!("{:.3}", value / 1000.0));
        Self { best: text(shown.first()), second: text(shown.get(1)) }
    }

    fn class(&self, score: f64) -> &'static str {
        let shown = Some(format!("{score:.3}"));
        if shown == self.best {
            "best"
        } else if shown == self.second {
            "second"
        } else {
            ""
        }
    }
}

/// A cell that stands out if its score is the best or the second.
fn cell(text: &str, score: Option<f64>, ends: &Ends, class: &str) -> String {
    let rank = score.map_or("", |score| ends.class(score));
    let classes = [class, rank].into_iter().filter(|one| !one.is_empty()).collect::<Vec<_>>().join(" ");
    if classes.is_empty() {
        format!("<td>{text}</td>")
    } else {
        format!("<td class=\"{classes}\">{text}</td>")
    }
}
