//! Formats of rows: OTB, CSV, JSON lines, MOTChallenge.

use std::fmt::Write;

use serde::Serialize;

use super::{Tracks, one_based};

const COLUMNS: &str = "frame,object,name,class,x,y,w,h,confidence,key,time_s";

/// A row as JSON has it; CSV has the same columns.
#[derive(Serialize)]
struct Row<'a> {
    frame: usize,
    object: usize,
    name: &'a str,
    class: &'a str,
    x: f64,
    y: f64,
    w: f64,
    h: f64,
    confidence: f64,
    key: bool,
    time_s: Option<f64>,
}

fn rows<'a>(tracks: &'a Tracks<'a>) -> impl Iterator<Item = Row<'a>> {
    tracks.boxes().map(|(frame, number, object, found)| Row {
        frame: frame + 1,
        object: number + 1,
        name: &object.name,
        class: &object.class,
        x: found.box_in_frame.x,
        y: found.box_in_frame.y,
        w: found.box_in_frame.w,
        h: found.box_in_frame.h,
        confidence: found.confidence,
        key: found.is_key,
        time_s: tracks.about.times.get(frame).copied().flatten().map(|time| time.as_secs_f64()),
    })
}

/// The first object's box in each frame.
pub(super) fn otb(tracks: &Tracks<'_>) -> String {
    let mut text = String::new();
    let track = tracks.tracks.first().map(Vec::as_slice).unwrap_or_default();
    for found in track {
        let [x, y, w, h] = found.map_or([f64::NAN; 4], |found| one_based(found.box_in_frame));
        // Writing to a String does not fail.
        let _ = writeln!(text, "{x},{y},{w},{h}");
    }
    text
}

pub(super) fn csv(tracks: &Tracks<'_>) -> String {
    let mut text = format!("{COLUMNS}\n");
    for row in rows(tracks) {
        let Row { frame, object, name, class, x, y, w, h, confidence, key, time_s } = row;
        let (name, class, key) = (cell(name), cell(class), u8::from(key));
        let time = time_s.map(|time| time.to_string()).unwrap_or_default();
        let _ = writeln!(text, "{frame},{object},{name},{class},{x},{y},{w},{h},{confidence},{key},{time}");
    }
    text
}

/// A cell by RFC 4180: in quotes if it has to be, quotes doubled.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

pub(super) fn json_lines(tracks: &Tracks<'_>) -> String {
    // Numbers and text always serialise.
    rows(tracks).map(|row| serde_json::to_string(&row).unwrap_or_default() + "\n").collect()
}

/// Ground truth: every row counts, is visible, and is of a class counted from 1.
pub(super) fn mot(tracks: &Tracks<'_>) -> String {
    let mut text = String::new();
    for (frame, number, object, found) in tracks.boxes() {
        let [x, y, w, h] = one_based(found.box_in_frame);
        let class = tracks.class_of(object) + 1;
        let _ = writeln!(text, "{},{},{x},{y},{w},{h},1,{class},1", frame + 1, number + 1);
    }
    text
}
