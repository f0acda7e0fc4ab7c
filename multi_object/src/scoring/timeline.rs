//! Ground truth and result side by side, frame by frame.

use std::collections::{BTreeMap, HashMap};

use crate::{grid::Grid, motchallenge::TrackRow};

/// One frame: who is there, and how much their boxes overlap.
#[derive(Debug, Clone, Default)]
pub struct FrameOverlaps {
    /// The frame, counted from 1.
    pub frame: u32,
    /// Index of each true object among all of them, in the file's order.
    pub truth: Vec<usize>,
    /// Index of each track of the result among all of them, in the file's order.
    pub result: Vec<usize>,
    /// Overlap (intersection over union) of each true box (rows) and each box of the result (columns).
    pub overlap: Grid,
}

/// All frames that have a box of either, in order.
#[derive(Debug, Clone, Default)]
pub struct Timeline {
    /// The frames.
    pub frames: Vec<FrameOverlaps>,
    /// In how many frames each true object is.
    pub frames_of_truth: Vec<usize>,
    /// In how many frames each track of the result is.
    pub frames_of_result: Vec<usize>,
}

#[derive(Default)]
struct Boxes<'a> {
    truth: Vec<(&'a TrackRow, usize)>,
    result: Vec<(&'a TrackRow, usize)>,
}

/// Numbers identities by their first row and counts their rows.
#[derive(Default)]
struct Identities {
    index_of: HashMap<u64, usize>,
    rows: Vec<usize>,
}

impl Identities {
    fn index(&mut self, row: &TrackRow) -> usize {
        let index = *self.index_of.entry(row.identity).or_insert(self.rows.len());
        if index == self.rows.len() {
            self.rows.push(0);
        }
        self.rows[index] += 1;
        index
    }
}

impl Timeline {
    /// Puts the rows of both side by side.
    pub fn new(truth: &[TrackRow], result: &[TrackRow]) -> Self {
        let mut by_frame: BTreeMap<u32, Boxes<'_>> = BTreeMap::new();
        let (mut objects, mut tracks) = (Identities::default(), Identities::default());
        for row in truth {
            by_frame.entry(row.frame).or_default().truth.push((row, objects.index(row)));
        }
        for row in result {
            by_frame.entry(row.frame).or_default().result.push((row, tracks.index(row)));
        }
        let frames = by_frame.into_iter().map(|(frame, boxes)| overlaps(frame, &boxes)).collect();
        Self { frames, frames_of_truth: objects.rows, frames_of_result: tracks.rows }
    }

    /// Boxes of the ground truth.
    pub fn truth_boxes(&self) -> usize {
        self.frames_of_truth.iter().sum()
    }

    /// Boxes of the result.
    pub fn result_boxes(&self) -> usize {
        self.frames_of_result.iter().sum()
    }
}

fn overlaps(frame: u32, boxes: &Boxes<'_>) -> FrameOverlaps {
    let overlap = Grid::from_fn(boxes.truth.len(), boxes.result.len(), |row, column| {
        boxes.truth[row].0.box_in_file.overlap(&boxes.result[column].0.box_in_file)
    });
    let indices = |boxes: &[(&TrackRow, usize)]| boxes.iter().map(|&(_, index)| index).collect();
    FrameOverlaps { frame, truth: indices(&boxes.truth), result: indices(&boxes.result), overlap }
}
