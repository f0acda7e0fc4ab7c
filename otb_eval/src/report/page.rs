//! The page around the report's parts.
//!
//! 1. Head: the style, with a rule for each tracker's colours.
//! 2. Header, and the bar of trackers.
//! 3. Overall scores, plots, attributes, sequences, each over time with frames, failed jobs, what scoring met, rules, how it was made.
//! 4. The plots' numbers and the script.

use std::fmt::Write as _;

use super::{Report, ReportError, figures, parts::sample, strips, tables};
use crate::plots::{Style, escape};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

pub(super) fn page(report: &Report) -> Result<String, ReportError> {
    let title = escape(&report.title);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}{}</style>\n</head>\n<body>\n",
        colours(report)
    );
    html.push_str(&header(report));
    html.push_str(&tracker_bar(report));
    html.push_str("<main>\n");
    section(&mut html, "overall", "Overall", &tables::overall(report));
    section(&mut html, "plots", "Plots", &figures::plots(report)?);
    section(&mut html, "attributes", "Attributes", &tables::attributes(report));
    section(&mut html, "sequences", "Sequences", &tables::sequences(report));
    section(&mut html, "time", "Over time", &strips::sequences(report));
    section(&mut html, "failures", "Failed jobs", &failures(report));
    section(&mut html, "scoring", "Met in scoring", &list(&report.scoring));
    section(&mut html, "notes", "Rules", &list(&report.notes));
    section(&mut html, "made", "How this was made", &how_made(report));
    let numbers = figures::numbers(report);
    let _ = write!(
        html,
        "</main>\n<div id=\"tip\" role=\"status\" hidden></div>\n\
         <script type=\"application/json\" id=\"numbers\">{numbers}</script>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n"
    );
    Ok(html)
}

/// Each tracker's colour as `--c` on everything of its class, in light and in dark.
fn colours(report: &Report) -> String {
    let rules = |pick: fn(&Style) -> (u8, u8, u8)| -> String {
        (0..report.trackers.len())
            .map(|place| {
                let (red, green, blue) = pick(&Style::of(place));
                format!(".s{place}{{--c:#{red:02x}{green:02x}{blue:02x}}}")
            })
            .collect()
    };
    format!(
        "{}\n@media screen and (prefers-color-scheme:dark){{{}}}\n",
        rules(Style::on_light),
        rules(Style::on_dark)
    )
}

fn header(report: &Report) -> String {
    let mut html = format!("<header>\n<h1>{}</h1>\n", escape(&report.title));
    if !report.subtitle.is_empty() {
        let _ = writeln!(html, "<p class=\"lead\">{}</p>", escape(&report.subtitle));
    }
    let made = report.made.iter().map(|made| ("made", made.as_str()));
    let versions = report.versions.iter().map(|(name, version)| (name.as_str(), version.as_str()));
    let facts: Vec<String> = made
        .chain(versions)
        .map(|(name, value)| format!("<span>{} <b>{}</b></span>", escape(name), escape(value)))
        .collect();
    if !facts.is_empty() {
        let _ = writeln!(html, "<p class=\"facts\">{}</p>", facts.join(" "));
    }
    html + "</header>\n"
}

/// A switch for each tracker. Without JavaScript it is the key to the colours.
fn tracker_bar(report: &Report) -> String {
    if report.trackers.is_empty() {
        return String::new();
    }
    let mut html = String::from("<div id=\"trackers\" role=\"group\" aria-label=\"Trackers\">\n");
    for (place, tracker) in report.trackers.iter().enumerate() {
        let _ = writeln!(
            html,
            "<label><input type=\"checkbox\" checked value=\"{place}\">{}{}</label>",
            sample(place),
            escape(&tracker.label)
        );
    }
    html + "<button type=\"button\" data-all=\"1\">all</button><button type=\"button\" data-all=\"\">none</button>\n</div>\n"
}

/// A section with a heading, unless there is nothing in it.
fn section(html: &mut String, id: &str, title: &str, content: &str) {
    if !content.is_empty() {
        let _ = writeln!(html, "<section id=\"{id}\">\n<h2>{title}</h2>\n{content}</section>");
    }
}

fn failures(report: &Report) -> String {
    let rows: String = report
        .failures
        .iter()
        .map(|failure| {
            format!(
                "<tr><th scope=\"row\">{}</th><td class=\"text\">{}</td></tr>\n",
                escape(&failure.job),
                escape(&failure.reason)
            )
        })
        .collect();
    if rows.is_empty() {
        return rows;
    }
    format!(
        "<div class=\"scroll\"><table data-name=\"failed jobs\">\n<thead><tr><th data-text>Job</th><th data-text>Reason</th></tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn list(texts: &[String]) -> String {
    let items: String = texts.iter().map(|text| format!("<li>{}</li>\n", escape(text))).collect();
    if items.is_empty() { items } else { format!("<ul>\n{items}</ul>\n") }
}

fn how_made(report: &Report) -> String {
    let mut html = String::new();
    if !report.commands.is_empty() {
        let commands: Vec<String> = report.commands.iter().map(|command| escape(command)).collect();
        let _ = writeln!(html, "<pre><code>{}</code></pre>", commands.join("\n"));
    }
    for (place, tracker) in report.trackers.iter().enumerate().filter(|(_, t)| !t.parameters.is_empty()) {
        let rows: String = tracker
            .parameters
            .iter()
            .map(|(name, value)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(value)))
            .collect();
        let label = escape(&tracker.label);
        let _ = writeln!(
            html,
            "<details><summary>{} {label}: parameters</summary><dl>\n{rows}</dl></details>",
            sample(place)
        );
    }
    html
}
