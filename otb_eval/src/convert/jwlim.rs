//! The Python benchmark's JSON: `OPE/TRACKER/SEQ.json`, a list of one, twenty (TRE) or twelve (SRE) segments.
//!
//! A segment has its first and last frame by the numbers in the files' names, and frames per second instead of times.
//! Its results are boxes, or are turned into boxes as the benchmark does: from the two opposite corners of an affine
//! template, rounded down.

use std::{
    fs,
    path::{Path, PathBuf},
};

use infopart::geometry::Rect;
use serde::Deserialize;
use serde_json::json;

use super::{ConvertError, OutputFile, Track, in_the_benchmarks_spelling, name_with_seed};
use crate::{catalogue, protocol::Protocol, results::ResultsError, scoring::frames_per_second};

#[derive(Deserialize)]
struct Entry {
    #[serde(rename = "seqName")]
    sequence: Option<String>,
    #[serde(rename = "shiftType")]
    shift: Option<String>,
    #[serde(rename = "resType")]
    kind: Option<String>,
    #[serde(rename = "startFrame")]
    start: Option<f64>,
    fps: Option<f64>,
    #[serde(rename = "tmplsize")]
    template: Option<Vec<f64>>,
    res: Vec<Vec<Option<f64>>>,
}

pub(super) fn read(path: &Path, problems: &mut Vec<ConvertError>) -> Result<Vec<Track>, ConvertError> {
    if !path.is_dir() {
        return Err(ResultsError::Missing { path: path.to_owned() }.into());
    }
    let mut tracks = Vec::new();
    for protocol in Protocol::ALL {
        for tracker in entries(&path.join(protocol.title())) {
            for file in
                entries(&tracker).iter().filter(|file| file.extension().is_some_and(|end| end == "json"))
            {
                let name = tracker.file_name().unwrap_or_default().to_string_lossy();
                match read_file(file, &name, protocol) {
                    Ok(of_file) => tracks.extend(of_file),
                    Err(problem) => problems.push(problem),
                }
            }
        }
    }
    Ok(tracks)
}

/// Sorted; nothing if it is no folder.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

fn read_file(path: &Path, tracker: &str, protocol: Protocol) -> Result<Vec<Track>, ConvertError> {
    let wrong = |problem: String| ConvertError::File { path: path.to_owned(), problem };
    let bytes = fs::read(path).map_err(|source| ResultsError::Io { path: path.to_owned(), source })?;
    // Python writes NaN, which is no JSON.
    let text = String::from_utf8_lossy(&bytes).replace("NaN", "null");
    let segments: Vec<Entry> = serde_json::from_str(&text).map_err(|error| {
        wrong(format!("{error}; it must be a list of segments, each with `res` and `resType`"))
    })?;
    let expected = if protocol == Protocol::Ope { 1 } else { segments.len() };
    if segments.len() != expected || segments.is_empty() {
        return Err(wrong(format!("{} segments; {} has one", segments.len(), protocol.title())));
    }
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = segments.iter().find_map(|segment| segment.sequence.as_deref()).unwrap_or(&stem);
    let sequence = in_the_benchmarks_spelling(name);
    let mut starts = Vec::new();
    for (index, segment) in segments.iter().enumerate() {
        starts.push(start_of(segment).map_err(|problem| wrong(format!("segment {}: {problem}", index + 1)))?);
    }
    let first_frame = first_frame(&sequence, &starts);
    let track = |(index, segment): (usize, Entry)| {
        let label = match protocol {
            Protocol::Ope => None,
            Protocol::Tre => Some(format!("{:02}", index + 1)),
            Protocol::Sre => Some(
                segment
                    .shift
                    .clone()
                    .ok_or_else(|| wrong(format!("segment {} has no shiftType", index + 1)))?,
            ),
        };
        let rows = boxes(&segment).map_err(wrong)?;
        let seconds = segment.fps.filter(|fps| *fps > 0.0).map(|fps| vec![fps.recip(); rows.len()]);
        let start = starts[index].filter(|_| protocol == Protocol::Tre);
        let start = start.and_then(|start| start.checked_sub(first_frame));
        let (tracker, sequence) = (tracker.to_owned(), sequence.clone());
        Ok(Track { tracker, protocol, seed: 0, sequence, label, start, rows, seconds, confidences: None })
    };
    segments.into_iter().enumerate().map(track).collect()
}

/// The number that a file's segments have for the first row of the truth: that in the name of the frame's file, or 1 if
/// one of them starts before that. The archive counts Tiger1 from 1, though its first file is 0006.
fn first_frame(sequence: &str, starts: &[Option<usize>]) -> usize {
    let in_files = catalogue::find(sequence).map_or(1, |known| known.first_frame);
    let earliest = starts.iter().flatten().copied().min();
    if earliest.is_some_and(|earliest| earliest < in_files) { 1 } else { in_files }
}

/// The number of a segment's first frame, which some writers have as 1.0.
fn start_of(segment: &Entry) -> Result<Option<usize>, String> {
    let Some(start) = segment.start else { return Ok(None) };
    let is_number = start.fract() == 0.0 && (1.0..1e9).contains(&start);
    if is_number {
        Ok(Some(start as usize))
    } else {
        Err(format!("startFrame is {start}, not the number of a frame"))
    }
}

/// A segment's results as boxes.
fn boxes(segment: &Entry) -> Result<Vec<Rect>, String> {
    let number = |value: &Option<f64>| value.unwrap_or(f64::NAN);
    let rows: Vec<Vec<f64>> = segment.res.iter().map(|row| row.iter().map(number).collect()).collect();
    let rects: Option<Vec<Rect>> = match segment.kind.as_deref().unwrap_or("rect") {
        "rect" => rows.iter().map(|row| rect(row)).collect(),
        "affine_ivt" | "ivtAff" => {
            let Some(&[w, h]) = segment.template.as_deref() else {
                return Err("its results are affine, but `tmplsize` has not two numbers".to_owned());
            };
            rows.iter().map(|row| of_affine(row, w, h)).collect()
        }
        "4corner" | "affine" => rows.chunks(2).map(of_corners).collect(),
        kind => {
            return Err(format!(
                "its results are of type `{kind}`, not boxes; turn them into `rect` with the benchmark's own code first"
            ));
        }
    };
    rects.ok_or_else(|| "a row of `res` has not as many numbers as its `resType` says".to_owned())
}

fn rect(row: &[f64]) -> Option<Rect> {
    let &[x, y, w, h] = row else { return None };
    Some(Rect::new(x, y, w, h))
}

/// The box between two opposite corners.
fn between((left, top): (f64, f64), (right, bottom): (f64, f64)) -> Rect {
    let (x, y) = (left.floor(), top.floor());
    Rect::new(x, y, right.floor() - x, bottom.floor() - y)
}

/// IVT's six numbers: the centre, and the matrix that a template of that width and height is placed with.
fn of_affine(row: &[f64], w: f64, h: f64) -> Option<Rect> {
    let &[x, y, xx, xy, yx, yy] = row else { return None };
    let (half_w, half_h) = ((xx * w + xy * h) / 2.0, (yx * w + yy * h) / 2.0);
    Some(between((x - half_w, y - half_h), (x + half_w, y + half_h)))
}

/// A row of the corners' x and one of their y, the third corner opposite to the first.
fn of_corners(rows: &[Vec<f64>]) -> Option<Rect> {
    let [x, y] = rows else { return None };
    Some(between((*x.first()?, *y.first()?), (*x.get(2)?, *y.get(2)?)))
}

/// A file for every tracker, protocol and sequence, with its segments in their order.
pub(super) fn files(tracks: &[Track]) -> Vec<OutputFile> {
    let mut groups: Vec<Vec<&Track>> = Vec::new();
    for track in tracks {
        let is_same = |group: &&mut Vec<&Track>| {
            let first = group[0];
            (&first.tracker, first.seed, first.protocol, &first.sequence)
                == (&track.tracker, track.seed, track.protocol, &track.sequence)
        };
        match groups.iter_mut().find(is_same) {
            Some(group) => group.push(track),
            None => groups.push(vec![track]),
        }
    }
    groups.into_iter().map(|group| file(group, tracks)).collect()
}

fn file(mut segments: Vec<&Track>, tracks: &[Track]) -> OutputFile {
    let first = segments[0];
    segments.sort_by_key(|track| order(track));
    let tracker_folder = PathBuf::from(first.protocol.title()).join(name_with_seed(first, tracks));
    // Where nothing else is known every segment ends with the sequence, and the first begins with it.
    let last = |track: &&Track| track.start.unwrap_or(0).saturating_add(track.rows.len());
    let whole = segments.iter().map(last).max().unwrap_or(0);
    let entries: Vec<String> = segments.iter().map(|track| entry(track, whole)).collect();
    OutputFile {
        path: tracker_folder.join(format!("{}.json", first.sequence)),
        tracker_folder,
        text: format!("[{}]\n", entries.join(", ")),
        has_boxes: true,
    }
}

/// The benchmark's order: by number in TRE, and of the shifts in SRE.
fn order(track: &Track) -> (usize, Option<&str>) {
    let is_meant = |shift: &crate::protocol::Shift| Some(shift.name()) == track.label.as_deref();
    let shift = crate::protocol::SHIFTS.iter().position(is_meant);
    (shift.unwrap_or(0), track.label.as_deref())
}

fn entry(track: &Track, whole: usize) -> String {
    let first_frame = catalogue::find(&track.sequence).map_or(1, |known| known.first_frame);
    let start = first_frame + track.start.unwrap_or(whole - track.rows.len());
    let fps = track.seconds.as_deref().and_then(frames_per_second).unwrap_or(-1.0);
    let shift = track.label.as_ref().filter(|_| track.protocol == Protocol::Sre);
    let head = json!({
        "tracker": track.tracker,
        "seqName": track.sequence,
        "startFrame": start,
        "endFrame": first_frame + whole - 1,
        "evalType": track.protocol.title(),
        "fps": fps,
        "shiftType": shift,
        "resType": "rect",
        "tmplsize": null,
    });
    let number = |value: f64| if value.is_nan() { "NaN".to_owned() } else { value.to_string() };
    let row = |row: &Rect| format!("[{}]", [row.x, row.y, row.w, row.h].map(number).join(", "));
    let rows: Vec<String> = track.rows.iter().map(row).collect();
    let head = head.to_string();
    format!("{}, \"res\": [{}]}}", head.trim_end_matches('}'), rows.join(", "))
}
