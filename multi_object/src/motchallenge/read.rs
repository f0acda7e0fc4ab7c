//! Reading rows.

use std::{collections::HashMap, fs, path::Path};

use infopart::geometry::Rect;

use super::{Annotation, Detection, MotError, RowProblem, TrackRow};
use crate::sort::is_trackable;

/// Frames beyond this are taken for a mistake: nothing holds so many.
const MAX_FRAME: f64 = 1e8;

/// Reads ground truth: the rows whose confidence is not 0, as MOT15 has it (-1 is none given). Rows stand in any order.
///
/// # Errors
/// [`MotError`] if the file cannot be read, a row cannot be used, or no row counts.
pub fn read_ground_truth(path: &Path) -> Result<Vec<TrackRow>, MotError> {
    let annotations = read_annotations(path, None)?;
    Ok(annotations.iter().filter(|one| one.is_counted()).map(|one| one.row).collect())
}

/// Reads every row of ground truth, with its class if it has one. Rows stand in any order. Boxes of rows that do not count may
/// be anything. No row may be of a frame beyond `length`, if that is known.
///
/// # Errors
/// [`MotError`] if the file cannot be read, a row cannot be used, or no row counts.
pub fn read_annotations(path: &Path, length: Option<u32>) -> Result<Vec<Annotation>, MotError> {
    let annotations = parse_annotations(&text_of(path)?, path, length)?;
    if !annotations.iter().any(Annotation::is_counted) {
        let what = "no row with confidence 1 (the seventh field), so nothing to find; give ground truth";
        return Err(MotError::Empty { path: path.to_owned(), what });
    }
    Ok(annotations)
}

/// Reads tracks, such as a tracker's result; the confidence may be missing and filters nothing. Nothing in the file is
/// a tracker that found nothing. No row may be of a frame beyond `length`, if that is known.
///
/// # Errors
/// [`MotError`] if the file cannot be read or a row cannot be used.
pub fn read_tracks(path: &Path, length: Option<u32>) -> Result<Vec<TrackRow>, MotError> {
    parse_tracks(&text_of(path)?, path, length)
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
        let class = class_of(&fields).map_err(row)?;
        detections.push(Detection { frame, box_in_file, confidence, class });
    }
    if detections.is_empty() {
        let what = "no detection in it; give rows FRAME,-1,X,Y,WIDTH,HEIGHT,CONFIDENCE";
        return Err(MotError::Empty { path: path.to_owned(), what });
    }
    Ok(detections)
}

/// The file's text; that of standard input for `-`.
fn text_of(path: &Path) -> Result<String, MotError> {
    let read = match path.as_os_str() == "-" {
        true => std::io::read_to_string(std::io::stdin()),
        false => fs::read_to_string(path),
    };
    read.map_err(|source| MotError::Unreadable { path: path.to_owned(), source })
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

pub(super) fn parse_tracks(text: &str, path: &Path, length: Option<u32>) -> Result<Vec<TrackRow>, MotError> {
    let mut lines = Lines::default();
    (rows_of(text).map(|(line, fields)| {
        let row = |problem| MotError::Row { path: path.to_owned(), line, problem };
        let (frame, identity) = (frame_of(&fields).map_err(row)?, identity_of(&fields).map_err(row)?);
        within(frame, length).map_err(row)?;
        let confidence = confidence_of(&fields).map_err(row)?.unwrap_or(1.0);
        let box_in_file = box_of(&fields).map_err(row)?;
        lines.add(frame, identity, line).map_err(row)?;
        Ok(TrackRow { frame, identity, box_in_file, confidence })
    }))
    .collect()
}

pub(super) fn parse_annotations(
    text: &str,
    path: &Path,
    length: Option<u32>,
) -> Result<Vec<Annotation>, MotError> {
    let mut lines = Lines::default();
    let mut annotations = Vec::new();
    for (line, fields) in rows_of(text) {
        let row = |problem| MotError::Row { path: path.to_owned(), line, problem };
        let (frame, identity) = (frame_of(&fields).map_err(row)?, identity_of(&fields).map_err(row)?);
        within(frame, length).map_err(row)?;
        let needed = 7;
        let confidence = confidence_of(&fields).map_err(row)?;
        let confidence =
            confidence.ok_or(RowProblem::TooFewFields { found: fields.len(), needed }).map_err(row)?;
        let class = class_of(&fields).map_err(row)?;
        let is_counted = confidence.trunc() != 0.0;
        let box_in_file = match box_of(&fields) {
            Ok(read) => read,
            Err(problem) if is_counted => return Err(row(problem)),
            // It stands for nobody.
            Err(_) => continue,
        };
        if is_counted {
            lines.add(frame, identity, line).map_err(row)?;
        }
        let row = TrackRow { frame, identity, box_in_file, confidence };
        annotations.push(Annotation { row, class });
    }
    Ok(annotations)
}

/// Where each identity is in each frame.
#[derive(Default)]
struct Lines(HashMap<(u32, u64), usize>);

impl Lines {
    fn add(&mut self, frame: u32, identity: u64, line: usize) -> Result<(), RowProblem> {
        match self.0.insert((frame, identity), line) {
            Some(first_line) => Err(RowProblem::DuplicateIdentity { identity, frame, first_line }),
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

fn within(frame: u32, length: Option<u32>) -> Result<(), RowProblem> {
    match length.filter(|&length| frame > length) {
        Some(length) => Err(RowProblem::Beyond { frame, length }),
        None => Ok(()),
    }
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
    if !read.is_proper() {
        return Err(RowProblem::Size { width, height });
    }
    if !is_trackable(&read) {
        return Err(RowProblem::Absurd { x, y, width, height });
    }
    Ok(read)
}

/// The class, if there is one; -1 is none.
fn class_of(fields: &[&str]) -> Result<Option<u32>, RowProblem> {
    if fields.len() < 8 {
        return Ok(None);
    }
    let class = number(fields, 7, "the class")?;
    Ok((0.0..1e6).contains(&class).then_some(class as u32))
}

fn confidence_of(fields: &[&str]) -> Result<Option<f64>, RowProblem> {
    (fields.len() > 6).then(|| number(fields, 6, "the confidence")).transpose()
}
