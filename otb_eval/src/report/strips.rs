//! Frames with boxes: each picture is stored once, the boxes lie over it.

use std::fmt::Write as _;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use infopart::geometry::Rect;

use super::{Report, StripFrame};
use crate::plots::escape;

/// A strip for each sequence.
pub(super) fn strips(report: &Report) -> String {
    let mut html = String::new();
    for strip in &report.strips {
        let _ = writeln!(html, "<h3>{}</h3>\n<div class=\"strip\">", escape(&strip.sequence));
        for frame in &strip.frames {
            html.push_str(&picture(report, &strip.sequence, frame));
        }
        html.push_str("</div>\n");
    }
    if html.is_empty() {
        return html;
    }
    format!("<p>The true box is white, dashed.</p>\n{html}")
}

fn picture(report: &Report, sequence: &str, frame: &StripFrame) -> String {
    let (width, height) = (frame.width, frame.height);
    let mut html = format!(
        "<figure><svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{} frame {}\">\
         <image width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" \
         href=\"data:image/jpeg;base64,{}\"/>",
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
