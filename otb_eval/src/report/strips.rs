//! Each sequence over time, which the script draws, and its frames with boxes: a picture is stored once, the boxes lie over it.

use std::fmt::Write as _;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use infopart::geometry::Rect;

use super::{
    Report, StripFrame,
    parts::{Choice, panels},
};
use crate::plots::escape;

/// A panel for each sequence; one is chosen from a list.
pub(super) fn sequences(report: &Report) -> String {
    let names = report.shown_sequences();
    let shown = names.iter().enumerate().map(|(place, name)| {
        let mut html = format!("<div id=\"sequence-{place}\" class=\"sequence\">\n");
        if let Some(index) = report.timelines.iter().position(|one| one.sequence == *name) {
            let _ = writeln!(html, "<div class=\"timeline\" data-timeline=\"{index}\"></div>");
        }
        if let Some(strip) = report.strips.iter().find(|strip| strip.sequence == *name) {
            html.push_str("<div class=\"strip\">\n");
            for frame in &strip.frames {
                html.push_str(&picture(report, name, frame));
            }
            html.push_str("</div>\n");
        }
        (*name, html + "</div>\n")
    });
    let html = panels(Choice::SelectOfAll("Sequence"), shown);
    if report.strips.is_empty() {
        return html;
    }
    format!(
        "<p>The true box is white, dashed. Frames are those in which trackers begin to fail, and some between.</p>\n{html}"
    )
}

fn picture(report: &Report, sequence: &str, frame: &StripFrame) -> String {
    let (width, height) = (frame.width, frame.height);
    let mut html = format!(
        "<figure data-frame=\"{}\"><svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{} frame {}\">\
         <image width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
         href=\"data:image/jpeg;base64,{}\"/>",
        frame.number,
        escape(sequence),
        frame.number,
        STANDARD.encode(&frame.jpeg)
    );
    if let Some(truth) = frame.truth.filter(Rect::is_proper) {
        html.push_str(&rectangle("under", truth, ""));
        html.push_str(&rectangle("truth", truth, "ground truth"));
    }
    for (place, found) in frame.boxes.iter().enumerate() {
        if let Some(found) = found.filter(Rect::is_proper) {
            let label = escape(&report.trackers[place].label);
            html.push_str(&rectangle(&format!("box s{place}"), found, &label));
        }
    }
    let _ = writeln!(html, "</svg><figcaption>#{}</figcaption></figure>", frame.number);
    html
}

fn rectangle(class: &str, Rect { x, y, w, h }: Rect, title: &str) -> String {
    let [x, y, w, h] = [x, y, w, h].map(|v| (v * 10.0).round() / 10.0);
    let shape = format!("<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"");
    if title.is_empty() { format!("{shape}/>") } else { format!("{shape}><title>{title}</title></rect>") }
}
