//! JSON lines with the keys that are exported.

use serde::Deserialize;

use super::{Row, RowTrack, no_class, track_of};
use crate::geometry::Rect;

#[derive(Deserialize)]
struct Line {
    frame: usize,
    #[serde(default)]
    object: usize,
    name: Option<String>,
    #[serde(default = "no_class")]
    class: String,
    x: f64,
    y: f64,
    w: f64,
    h: f64,
    confidence: Option<f64>,
    key: Option<bool>,
}

pub(super) fn tracks(text: &str) -> Result<Vec<RowTrack>, String> {
    let mut tracks = Vec::new();
    for (at, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let number = at + 1;
        let line: Line = serde_json::from_str(line).map_err(|error| format!("line {number}: {error}"))?;
        let index = line
            .frame
            .checked_sub(1)
            .ok_or_else(|| format!("line {number}: frame 0; frames count from 1"))?;
        let Line { object, name, class, x, y, w, h, confidence, key, .. } = line;
        let words = || (name.clone().unwrap_or_else(|| format!("object {object}")), class);
        let id = (object, name.clone());
        let row = Row { rect: Rect::new(x, y, w, h), confidence: confidence.unwrap_or(1.0), is_key: key };
        track_of(&mut tracks, id, words).rows.insert(index, row);
    }
    Ok(tracks.into_iter().map(|(_, track)| track).collect())
}
