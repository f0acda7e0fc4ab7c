//! CLEAR-MOT as TrackEval counts it. In each frame that has objects and tracks:
//!
//! 1. Pair them so that the sum of overlap, and of 1000 for each pairing of the last such frame, is greatest, among pairs that
//!    overlap by at least a half.
//! 2. An object whose track is another than its last has a switch.
//! 3. An object that was not matched in the last such frame, and now is, starts a piece; a fragment is every piece but the
//!    first.

use super::{Counts, FrameOverlaps, Timeline};
use crate::{assignment::Assigner, grid::Grid};

const MIN_OVERLAP: f64 = 0.5;
/// What a pairing of the frame before is worth, against overlaps of at most 1.
const KEPT: f64 = 1000.0;

struct Object {
    last_track: Option<usize>,
    track_before: Option<usize>,
    matched: usize,
    pieces: usize,
}

pub(super) fn count(timeline: &Timeline) -> Counts {
    let mut objects: Vec<Object> = (timeline.frames_of_truth.iter())
        .map(|_| Object { last_track: None, track_before: None, matched: 0, pieces: 0 })
        .collect();
    // Where no length is known (`Counts::of_length`) it is the last frame with a box.
    let frames = timeline.frames.last().map_or(0, |last| last.frame as usize);
    let mut counts = Counts { frames, ..Counts::default() };
    let mut assigner = Assigner::default();
    for frame in &timeline.frames {
        if frame.truth.is_empty() || frame.result.is_empty() {
            counts.misses += frame.truth.len();
            counts.false_positives += frame.result.len();
        } else {
            count_frame(frame, &mut objects, &mut assigner, &mut counts);
        }
    }
    for (object, &frames) in objects.iter().zip(&timeline.frames_of_truth) {
        let share = object.matched as f64 / frames as f64;
        match share {
            share if share > 0.8 => counts.mostly_tracked += 1,
            share if share >= 0.2 => counts.partially_tracked += 1,
            _ => counts.mostly_lost += 1,
        }
        counts.fragments += object.pieces.saturating_sub(1);
    }
    counts
}

fn count_frame(frame: &FrameOverlaps, objects: &mut [Object], assigner: &mut Assigner, counts: &mut Counts) {
    let costs = Grid::from_fn(frame.truth.len(), frame.result.len(), |row, column| {
        let overlap = frame.overlap.at(row, column);
        let is_kept = objects[frame.truth[row]].track_before == Some(frame.result[column]);
        match overlap < MIN_OVERLAP - f64::EPSILON {
            true => 0.0,
            false => -(overlap + if is_kept { KEPT } else { 0.0 }),
        }
    });
    let mut track_now: Vec<Option<usize>> = vec![None; objects.len()];
    let mut matches = 0;
    for &(row, column) in assigner.solve(&costs) {
        if costs.at(row, column) >= -f64::EPSILON {
            continue;
        }
        let (object, track) = (frame.truth[row], frame.result[column]);
        track_now[object] = Some(track);
        matches += 1;
        counts.distance_sum += 1.0 - frame.overlap.at(row, column);
    }
    for (object, now) in objects.iter_mut().zip(track_now) {
        if let Some(track) = now {
            counts.switches += usize::from(object.last_track.is_some_and(|last| last != track));
            object.pieces += usize::from(object.track_before.is_none());
            object.matched += 1;
            object.last_track = now;
        }
        object.track_before = now;
    }
    counts.matches += matches;
    counts.misses += frame.truth.len() - matches;
    counts.false_positives += frame.result.len() - matches;
}
