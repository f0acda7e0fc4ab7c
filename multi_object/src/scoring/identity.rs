//! Identity scores (Ristani et al. 2016): each true object is given at most one track for the whole sequence, so that the
//! boxes that then agree (overlap of at least a half) are as many as can be.

use super::Timeline;
use crate::{assignment::Assigner, grid::Grid};

/// Boxes that agree under the best one-to-one pairing of objects and tracks (IDTP).
pub(super) fn true_positives(timeline: &Timeline) -> usize {
    let agreements = agreements(timeline);
    let costs =
        Grid::from_fn(agreements.rows(), agreements.columns(), |row, column| -agreements.at(row, column));
    let pairs = Assigner::default().solve(&costs).to_vec();
    pairs.iter().map(|&(row, column)| agreements.at(row, column) as usize).sum()
}

/// In how many frames each object and each track overlap by at least a half.
fn agreements(timeline: &Timeline) -> Grid {
    let mut agreements =
        Grid::from_fn(timeline.frames_of_truth.len(), timeline.frames_of_result.len(), |_, _| 0.0);
    for frame in &timeline.frames {
        for (row, &object) in frame.truth.iter().enumerate() {
            for (column, &track) in frame.result.iter().enumerate() {
                if frame.overlap.at(row, column) >= 0.5 {
                    *agreements.at_mut(object, track) += 1.0;
                }
            }
        }
    }
    agreements
}
