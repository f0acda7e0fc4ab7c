//! HOTA (Luiten et al. 2021), as TrackEval computes it.
//!
//! 1. How well each object and each track go together over the whole sequence: the sum of their overlaps, each divided by all
//!    the overlap that the two boxes have in the frame, as a share of the frames of either.
//! 2. In each frame, pair objects and tracks so that the sum of (1) times the overlap is greatest.
//! 3. For each threshold α of 0.05, 0.10 ... 0.95: pairs that overlap by at least α are true positives (TP), other boxes false
//!    ones (FN, FP); DetA = TP / (TP + FN + FP); AssA is the mean over TP of
//!    frames paired / (frames of the object + frames of the track - frames paired); HOTA = sqrt(DetA AssA).
//! 4. Each score is the mean over the thresholds.

use super::Timeline;
use crate::{assignment::Assigner, grid::Grid};

/// Number of thresholds.
pub(super) const THRESHOLDS: usize = 19;

/// What is counted at one threshold; sums over sequences give the counts of all.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct AtThreshold {
    pub(super) true_positives: usize,
    pub(super) misses: usize,
    pub(super) false_positives: usize,
    /// The sum over true positives of how well their object and track stay together.
    pub(super) association_sum: f64,
}

pub(super) fn threshold(index: usize) -> f64 {
    0.05 + index as f64 * 0.05
}

pub(super) fn count(timeline: &Timeline) -> [AtThreshold; THRESHOLDS] {
    let alignment = alignment(timeline);
    let mut assigner = Assigner::default();
    let mut pairs = Vec::new();
    for frame in &timeline.frames {
        let costs = Grid::from_fn(frame.truth.len(), frame.result.len(), |row, column| {
            -alignment.at(frame.truth[row], frame.result[column]) * frame.overlap.at(row, column)
        });
        let of_frame = assigner.solve(&costs).iter();
        pairs.extend(of_frame.map(|&(r, c)| (frame.truth[r], frame.result[c], frame.overlap.at(r, c))));
    }
    std::array::from_fn(|index| at_threshold(threshold(index), timeline, &pairs))
}

/// Step 1.
fn alignment(timeline: &Timeline) -> Grid {
    let (objects, tracks) = (&timeline.frames_of_truth, &timeline.frames_of_result);
    let mut together = Grid::from_fn(objects.len(), tracks.len(), |_, _| 0.0);
    for frame in &timeline.frames {
        let (of_rows, of_columns) = (frame.overlap.row_sums(), frame.overlap.column_sums());
        for (row, &object) in frame.truth.iter().enumerate() {
            for (column, &track) in frame.result.iter().enumerate() {
                let overlap = frame.overlap.at(row, column);
                let all = of_columns[column] + of_rows[row] - overlap;
                if all > f64::EPSILON {
                    *together.at_mut(object, track) += overlap / all;
                }
            }
        }
    }
    Grid::from_fn(objects.len(), tracks.len(), |object, track| {
        let together = together.at(object, track);
        together / ((objects[object] + tracks[track]) as f64 - together)
    })
}

/// Step 3.
fn at_threshold(threshold: f64, timeline: &Timeline, pairs: &[(usize, usize, f64)]) -> AtThreshold {
    let (objects, tracks) = (&timeline.frames_of_truth, &timeline.frames_of_result);
    let mut paired = Grid::from_fn(objects.len(), tracks.len(), |_, _| 0.0);
    let mut true_positives = 0;
    for &(object, track, _) in pairs.iter().filter(|pair| pair.2 >= threshold - f64::EPSILON) {
        *paired.at_mut(object, track) += 1.0;
        true_positives += 1;
    }
    let mut association_sum = 0.0;
    for (object, &frames_of_object) in objects.iter().enumerate() {
        for (&paired, &frames_of_track) in paired.row(object).iter().zip(tracks) {
            association_sum +=
                paired * paired / ((frames_of_object + frames_of_track) as f64 - paired).max(1.0);
        }
    }
    AtThreshold {
        true_positives,
        misses: timeline.truth_boxes() - true_positives,
        false_positives: timeline.result_boxes() - true_positives,
        association_sum,
    }
}
