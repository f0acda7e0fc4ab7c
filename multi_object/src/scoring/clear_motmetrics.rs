//! CLEAR-MOT (Bernardin and Stiefelhagen 2008) as py-motmetrics counts it. In each frame:
//!
//! 1. A true object, in the file's order, keeps the track that it had last, however long ago, if that is there, not taken,
//!    and overlaps by at least a half.
//! 2. The others are paired so that the sum of 1 - overlap is least, as many as can be.
//! 3. An object whose track is another than its last has a switch (an ascent, if that track was never matched before); a
//!    track that was newly given to another object before is a transfer (a migration, if the object was never matched before).
//! 4. Objects without a track are misses, tracks without an object false positives.
//!
//! A fragment is a step from matched to missed between an object's first and last match.

use std::ops::Range;

use super::{Counts, FrameOverlaps, Timeline};
use crate::{assignment::Assigner, grid::Grid};

/// Largest distance, 1 - overlap, of a match.
const MAX_DISTANCE: f64 = 0.5;

#[derive(Default)]
struct History {
    /// The track that each object had last.
    track_of: Vec<Option<usize>>,
    /// The object that each track was given to last, not counting those kept in step 1.
    object_of: Vec<Option<usize>>,
    track_was_matched: Vec<bool>,
    object_was_matched: Vec<bool>,
    /// In each object's frames, whether it was matched.
    matched: Vec<Vec<bool>>,
}

pub(super) fn count(timeline: &Timeline) -> Counts {
    let (objects, tracks) = (timeline.frames_of_truth.len(), timeline.frames_of_result.len());
    let mut history = History {
        track_of: vec![None; objects],
        object_of: vec![None; tracks],
        track_was_matched: vec![false; tracks],
        object_was_matched: vec![false; objects],
        matched: vec![Vec::new(); objects],
    };
    let mut counts = Counts { frames: timeline.frames.len(), ..Counts::default() };
    let mut assigner = Assigner::default();
    for frame in &timeline.frames {
        count_frame(frame, &mut history, &mut assigner, &mut counts);
    }
    for matched in &history.matched {
        let share = matched.iter().filter(|&&m| m).count() as f64 / matched.len() as f64;
        match share {
            share if share >= 0.8 => counts.mostly_tracked += 1,
            share if share < 0.2 => counts.mostly_lost += 1,
            _ => counts.partially_tracked += 1,
        }
        counts.fragments += fragments(matched);
    }
    counts
}

fn count_frame(frame: &FrameOverlaps, history: &mut History, assigner: &mut Assigner, counts: &mut Counts) {
    let distance = |row, column| 1.0 - frame.overlap.at(row, column);
    let mut column_of: Vec<Option<usize>> = vec![None; frame.truth.len()];
    let mut is_taken = vec![false; frame.result.len()];
    for (row, &object) in frame.truth.iter().enumerate() {
        let column = history.track_of[object].and_then(|track| frame.result.iter().position(|&t| t == track));
        let free = column.filter(|&column| !is_taken[column] && distance(row, column) <= MAX_DISTANCE);
        if let Some(column) = free {
            column_of[row] = Some(column);
            is_taken[column] = true;
            counts.distance_sum += distance(row, column);
            history.object_was_matched[object] = true;
            history.track_was_matched[frame.result[column]] = true;
        }
    }
    let rows: Vec<usize> = (0..frame.truth.len()).filter(|&row| column_of[row].is_none()).collect();
    let columns: Vec<usize> = (0..frame.result.len()).filter(|&column| !is_taken[column]).collect();
    // A pair too far apart costs more than all good pairs together, so that it is taken only where nothing else is left.
    let too_far = 2.0 * (rows.len().min(columns.len()) as f64 + 1.0);
    let costs = Grid::from_fn(rows.len(), columns.len(), |row, column| {
        let distance = distance(rows[row], columns[column]);
        if distance <= MAX_DISTANCE { distance } else { too_far }
    });
    for &(row, column) in assigner.solve(&costs) {
        if costs.at(row, column) > MAX_DISTANCE {
            continue;
        }
        let (row, column) = (rows[row], columns[column]);
        column_of[row] = Some(column);
        counts.distance_sum += distance(row, column);
        note_pair(frame.truth[row], frame.result[column], history, counts);
    }
    for (row, &object) in frame.truth.iter().enumerate() {
        history.matched[object].push(column_of[row].is_some());
    }
    let matches = column_of.iter().flatten().count();
    counts.matches += matches;
    counts.misses += frame.truth.len() - matches;
    counts.false_positives += frame.result.len() - matches;
}

/// Step 3.
fn note_pair(object: usize, track: usize, history: &mut History, counts: &mut Counts) {
    if history.track_of[object].is_some_and(|last| last != track) {
        counts.switches += 1;
        counts.ascents += usize::from(!history.track_was_matched[track]);
    }
    if history.object_of[track].is_some_and(|last| last != object) {
        counts.transfers += 1;
        counts.migrations += usize::from(!history.object_was_matched[object]);
    }
    history.track_was_matched[track] = true;
    history.object_was_matched[object] = true;
    history.track_of[object] = Some(track);
    history.object_of[track] = Some(object);
}

fn fragments(matched: &[bool]) -> usize {
    let first = matched.iter().position(|&m| m);
    let last = matched.iter().rposition(|&m| m);
    let Some(span) = first.zip(last).map(|(first, last)| Range { start: first, end: last }) else { return 0 };
    matched[span].windows(2).filter(|pair| pair[0] && !pair[1]).count()
}
