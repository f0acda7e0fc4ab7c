//! Reading rows.

use std::{
    collections::{HashMap, HashSet},
    fs,
    path::Path,
};

use infopart::geometry::Rect;

use super::{Detection, MotError, RowProblem, TrackRow};

/// Frames beyond this are taken for a mistake: nothing holds so many.
const MAX_FRAME: f64 = 1e8;
/// The confidence of the ground truth's rows that count.
const COUNTED: f64 = 1.0;

/// Reads ground truth: the rows whose confidence is 1, as MOT15 has it. Rows stand in the file's order, by frame or by
/// identity.
///
/// # Errors
/// [`MotError`] if the file cannot be read, a row cannot be used, or no row counts.
pub fn read_ground_truth(path: &Path) -> Result<Vec<TrackRow>, MotError> {
    let rows = parse_tracks(&text_of(path)?, path, true)?;
    if rows.is_empty() {
        let what = "no row with confidence 1 (the seventh field), so nothing to find; give ground truth";
        return Err(MotError::Empty { path: path.to_owned(), what });
    }
    Ok(rows)
}

/// Reads tracks, such as a tracker's result; the confidence may be missing and filters nothing. Nothing in the file is
/// a tracker that found nothing.
///
/// # Errors
/// [`MotError`] if the file cannot be read or a row cannot be used.
pub fn read_tracks(path: &Path) -> Result<Vec<TrackRow>, MotError> {
    parse_tracks(&text_of(path)?, path, false)
}

/// Reads detections; the identity is not looked at. Rows must be in the order of their frames.
///
/// # Errors
/// [`MotError`] if the file cannot be read, a row cannot be used, frames go back, or there is no row.
pub fn read_detections(path: &Path) -> Result<Vec<Detection>, MotError> {
    let text = text_of(path)?;
    let mut detections: Vec<Detection> = Vec::new();
    for (line, fields) in rows_of(&text) {
        let row = |problem| MotError::Row { path: path.to_owned(), line, problem };
        let frame = frame_of(&fields).map_err(row)?;
        if let Some(previous) = detections.last().map(|last| last.frame).filter(|&previous| frame < previous)
        {
            return Err(row(RowProblem::OutOfOrder { frame, previous }));
        }
        let box_in_file = box_of(&fields).map_err(row)?;
        let confidence = confidence_of(&fields).map_err(row)?.unwrap_or(1.0);
        detections.push(Detection { frame, box_in_file, confidence });
    }
    if detections.is_empty() {
        let what = "no detection in it; give rows FRAME,-1,X,Y,WIDTH,HEIGHT,CONFIDENCE";
        return Err(MotError::Empty { path: path.to_owned(), what });
    }
    Ok(detections)
}

fn text_of(path: &Path) -> Result<String, MotError> {
    fs::read_to_string(path).map_err(|source| MotError::Unreadable { path: path.to_owned(), source })
}

/// The rows that are not blank, with their lines counted from 1, cut at commas, or else at blanks.
fn rows_of(text: &str) -> impl Iterator<Item = (usize, Vec<&str>)> {
    let rows = text.trim_start_matches('\u{feff}').lines().enumerate();
    rows.filter(|(_, row)| !row.trim().is_empty()).map(|(index, row)| {
        let fields = match row.contains(',') {
            true => row.trim().trim_end_matches(',').split(',').map(str::trim).collect(),
            false => row.split_whitespace().collect(),
        };
        (index + 1, fields)
    })
}

pub(super) fn parse_tracks(text: &str, path: &Path, is_truth: bool) -> Result<Vec<TrackRow>, MotError> {
    let mut rows: Vec<TrackRow> = Vec::new();
    let mut order = Order::default();
    let mut lines: HashMap<(u32, u64), usize> = HashMap::new();
    for (line, fields) in rows_of(text) {
        let row = |problem| MotError::Row { path: path.to_owned(), line, problem };
        let frame = frame_of(&fields).map_err(row)?;
        let identity = identity_of(&fields).map_err(row)?;
        order.check(frame, identity).map_err(row)?;
        let confidence = confidence_of(&fields).map_err(row)?;
        if is_truth {
            let needed = 7;
            let confidence =
                confidence.ok_or(RowProblem::TooFewFields { found: fields.len(), needed }).map_err(row)?;
            if confidence != COUNTED {
                continue;
            }
        }
        let box_in_file = box_of(&fields).map_err(row)?;
        if let Some(first_line) = lines.insert((frame, identity), line) {
            return Err(row(RowProblem::DuplicateIdentity { identity, frame, first_line }));
        }
        rows.push(TrackRow { frame, identity, box_in_file, confidence: confidence.unwrap_or(1.0) });
    }
    Ok(rows)
}

/// Files of tracks are sorted by frame, or by identity and then by frame: a frame number may go back only where an
/// identity begins.
#[derive(Default)]
struct Order {
    previous: Option<u32>,
    seen: HashSet<u64>,
}

impl Order {
    fn check(&mut self, frame: u32, identity: u64) -> Result<(), RowProblem> {
        let is_new = self.seen.insert(identity);
        match self.previous.replace(frame).filter(|&previous| frame < previous && !is_new) {
            Some(previous) => Err(RowProblem::OutOfOrder { frame, previous }),
            None => Ok(()),
        }
    }
}

fn field<'a>(fields: &[&'a str], index: usize) -> Result<&'a str, RowProblem> {
    fields.get(index).copied().ok_or(RowProblem::TooFewFields { found: fields.len(), needed: 6 })
}

fn number(fields: &[&str], index: usize, name: &'static str) -> Result<f64, RowProblem> {
    let text = field(fields, index)?;
    let value = text.parse().ok().filter(|value: &f64| value.is_finite());
    value.ok_or_else(|| RowProblem::NotANumber { field: name, text: text.to_owned() })
}

fn frame_of(fields: &[&str]) -> Result<u32, RowProblem> {
    let value = number(fields, 0, "the frame")?;
    if value.fract() != 0.0 || !(1.0..=MAX_FRAME).contains(&value) {
        return Err(RowProblem::Frame { text: fields[0].to_owned() });
    }
    Ok(value as u32)
}

fn identity_of(fields: &[&str]) -> Result<u64, RowProblem> {
    let value = number(fields, 1, "the identity")?;
    // Above 2^53 neighbours become one.
    if value.fract() != 0.0 || !(0.0..=9e15).contains(&value) {
        return Err(RowProblem::Identity { text: fields[1].to_owned() });
    }
    Ok(value as u64)
}

fn box_of(fields: &[&str]) -> Result<Rect, RowProblem> {
    field(fields, 5)?;
    let (x, y) = (number(fields, 2, "x")?, number(fields, 3, "y")?);
    let (width, height) = (number(fields, 4, "the width")?, number(fields, 5, "the height")?);
    let read = Rect::new(x, y, width, height);
    if read.is_proper() { Ok(read) } else { Err(RowProblem::Size { width, height }) }
}

fn confidence_of(fields: &[&str]) -> Result<Option<f64>, RowProblem> {
    (fields.len() > 6).then(|| number(fields, 6, "the confidence")).transpose()
}
