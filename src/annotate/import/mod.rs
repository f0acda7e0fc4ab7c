//! Annotations that other programs made, to be corrected here.
//!
//! Steps:
//! 1. a reader for each format gives rows: object, frame, box,
//! 2. an object's key frames are those that the file calls so; where it does not say, as few as straight lines between them need to err
//!    by no more than a pixel ([`editable_frames`]); where rows are missing the object is absent,
//! 3. rows between key frames become what a forward pass would have seen, so that they stay as they are until somebody corrects a
//!    neighbour.

use std::collections::BTreeMap;

use thiserror::Error;

use super::{
    VideoInfo,
    export::editable_frames,
    keys::{Colour, Mark, Object},
    passes::{Direction, Pass, Passes, Sighting},
    track::Annotated,
};
use crate::geometry::Rect;

mod coco;
mod cvat;
mod json_lines;
mod rows;

/// A file of annotations that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}: {reason}")]
pub struct ImportError {
    /// The file.
    pub file: String,
    /// What is wrong, where, and what to do.
    pub reason: String,
}

/// An object of a file, with the boxes between its key frames.
pub type Imported = (Object, Passes);

/// An object's rows as a file has them.
#[derive(Debug, Clone, Default, PartialEq)]
struct RowTrack {
    name: String,
    class: String,
    /// By frame, counted from 0.
    rows: BTreeMap<usize, Row>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Row {
    rect: Rect,
    confidence: f64,
    /// Whether somebody drew it, if the file says so.
    is_key: Option<bool>,
}

/// Objects of a file of CSV, JSON lines, OTB, MOTChallenge, CVAT or COCO, recognised by what is in it, for the video that `about`
/// tells of.
///
/// # Errors
/// [`ImportError`], naming the line where there is one.
pub fn read(file: &str, text: &str, about: &VideoInfo) -> Result<Vec<Imported>, ImportError> {
    let failed = |reason: String| ImportError { file: file.to_owned(), reason };
    let text = text.trim_start_matches('\u{feff}');
    let start = text.trim_start();
    let tracks = if start.starts_with('<') {
        cvat::tracks(text)
    } else if start.starts_with('{') && serde_json::from_str::<serde_json::Value>(text).is_ok() {
        if start.lines().nth(1).is_none() && !start.contains("\"annotations\"") {
            json_lines::tracks(text)
        } else {
            coco::tracks(text)
        }
    } else if start.starts_with('{') {
        json_lines::tracks(text)
    } else {
        rows::tracks(text)
    }
    .map_err(failed)?;
    if tracks.iter().all(|track| track.rows.is_empty()) {
        return Err(failed("there is no box in it".to_owned()));
    }
    let tracks = tracks.into_iter().filter(|track| !track.rows.is_empty());
    tracks.enumerate().map(|(index, track)| imported(index, track, about).map_err(failed)).collect()
}

/// Steps 2 and 3.
fn imported(index: usize, track: RowTrack, about: &VideoInfo) -> Result<Imported, String> {
    let RowTrack { name, class, rows } = track;
    let frames = about.frames;
    if let Some((&last, _)) = rows.last_key_value()
        && last >= frames
    {
        return Err(format!(
            "{name:?} has a box in frame {}, but the video has {frames} frames: is it of another video?",
            last + 1
        ));
    }
    for (frame, row) in &rows {
        if !row.rect.is_proper() {
            let Rect { x, y, w, h } = row.rect;
            let number = frame + 1;
            return Err(format!(
                "{name:?}, frame {number}: the box {x},{y},{w},{h} needs finite numbers and a positive width and height"
            ));
        }
    }
    let mut object = Object { name, class, colour: Colour::of_object(index), keys: BTreeMap::new() };
    let mut passes = Passes::default();
    let mut pass: Option<Pass> = None;
    for (frame, is_key) in key_frames(&rows, frames).into_iter().enumerate() {
        match rows.get(&frame) {
            Some(row) if is_key => {
                object.keys.insert(frame, Mark::Box(row.rect));
                let next = Pass {
                    from: frame,
                    start: row.rect,
                    direction: Direction::Forward,
                    sightings: Vec::new(),
                };
                keep(&mut passes, pass.replace(next));
            }
            Some(row) => {
                if let Some(pass) = &mut pass {
                    pass.sightings.push(Sighting { box_in_frame: row.rect, confidence: row.confidence });
                }
            }
            None => {
                if frame == 0 || rows.contains_key(&(frame - 1)) {
                    object.keys.insert(frame, Mark::Absent);
                }
                keep(&mut passes, pass.take());
            }
        }
    }
    keep(&mut passes, pass);
    Ok((object, passes))
}

fn keep(passes: &mut Passes, pass: Option<Pass>) {
    if let Some(pass) = pass.filter(|pass| !pass.sightings.is_empty()) {
        passes.insert(pass);
    }
}

/// Which rows are key frames; the first after a gap always is one.
fn key_frames(rows: &BTreeMap<usize, Row>, frames: usize) -> Vec<bool> {
    if rows.values().all(|row| row.is_key.is_none()) {
        let found = |row: &Row| Annotated { box_in_frame: row.rect, confidence: 1.0, is_key: false };
        let track: Vec<_> = (0..frames).map(|frame| rows.get(&frame).map(found)).collect();
        return editable_frames(&track);
    }
    (0..frames)
        .map(|frame| {
            let begins = frame == 0 || !rows.contains_key(&(frame - 1));
            rows.get(&frame).is_some_and(|row| begins || row.is_key == Some(true))
        })
        .collect()
}

/// A class that a file does not name.
fn no_class() -> String {
    "object".to_owned()
}

/// The track with this key, made if it is not there; in the order of the file.
fn track_of<K: PartialEq>(
    tracks: &mut Vec<(K, RowTrack)>,
    key: K,
    words: impl FnOnce() -> (String, String),
) -> &mut RowTrack {
    let at = tracks.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
        let (name, class) = words();
        tracks.push((key, RowTrack { name, class, rows: BTreeMap::new() }));
        tracks.len() - 1
    });
    &mut tracks[at].1
}

#[cfg(test)]
mod tests;
