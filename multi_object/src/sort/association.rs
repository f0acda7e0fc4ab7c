//! Pairs detections and predictions.
//!
//! 1. If every detection and every prediction has at most one overlap above the threshold, and some has, those are the pairs.
//! 2. Otherwise the pairs are those with the greatest total overlap, whatever each overlap is.
//! 3. A pair below the threshold is undone. (A good pair that step 2 gave up for the total is not looked for again.)

use crate::{assignment::Assigner, grid::Grid};

#[derive(Debug, Default)]
pub(super) struct Association {
    /// (detection, track), by detections.
    pub(super) pairs: Vec<(usize, usize)>,
    /// Detections without a track: first those that were never paired, then those whose pair was undone.
    pub(super) detections_left: Vec<usize>,
    candidates: Vec<(usize, usize)>,
    costs: Grid,
}

impl Association {
    /// Steps 1 to 3.
    pub(super) fn by_overlap(&mut self, overlap: &Grid, threshold: f64, assigner: &mut Assigner) {
        self.candidates.clear();
        if !only_candidates(overlap, threshold, &mut self.candidates) {
            self.costs.fill(overlap.rows(), overlap.columns(), |row, column| -overlap.at(row, column));
            self.candidates.clear();
            self.candidates.extend(assigner.solve(&self.costs));
        }
        self.keep(overlap, threshold);
    }

    /// Pairs with the greatest total `score` among those whose overlap reaches the threshold.
    pub(super) fn by_score(&mut self, score: &Grid, overlap: &Grid, threshold: f64, assigner: &mut Assigner) {
        self.costs.fill(overlap.rows(), overlap.columns(), |row, column| {
            if overlap.at(row, column) < threshold { 0.0 } else { -score.at(row, column) }
        });
        self.candidates.clear();
        self.candidates.extend(assigner.solve(&self.costs));
        self.keep(overlap, threshold);
    }

    /// Step 3.
    fn keep(&mut self, overlap: &Grid, threshold: f64) {
        self.pairs.clear();
        self.detections_left.clear();
        let mut candidates = self.candidates.iter().map(|pair| pair.0).peekable();
        for detection in 0..overlap.rows() {
            if candidates.peek() == Some(&detection) {
                candidates.next();
            } else {
                self.detections_left.push(detection);
            }
        }
        for &(detection, track) in &self.candidates {
            if overlap.at(detection, track) < threshold {
                self.detections_left.push(detection);
            } else {
                self.pairs.push((detection, track));
            }
        }
    }
}

/// Step 1: whether the overlaps above the threshold are pairs already; `pairs` then has them.
fn only_candidates(overlap: &Grid, threshold: f64, pairs: &mut Vec<(usize, usize)>) -> bool {
    for row in 0..overlap.rows() {
        let above = overlap.row(row).iter().enumerate().filter(|&(_, &value)| value > threshold);
        pairs.extend(above.map(|(column, _)| (row, column)));
    }
    let is_alone = |(index, &(row, column)): (usize, &(usize, usize))| {
        pairs[..index].iter().all(|&(r, c)| r != row && c != column)
    };
    !pairs.is_empty() && pairs.iter().enumerate().all(is_alone)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn associated(rows: &[&[f64]], threshold: f64) -> (Vec<(usize, usize)>, Vec<usize>) {
        let columns = rows.first().map_or(0, |row| row.len());
        let overlap = Grid::from_fn(rows.len(), columns, |row, column| rows[row][column]);
        let mut association = Association::default();
        association.by_overlap(&overlap, threshold, &mut Assigner::default());
        (association.pairs, association.detections_left)
    }

    #[test]
    fn the_only_overlap_above_the_threshold_is_taken_before_the_greatest_total() {
        // The greatest total, .29 + .29, would leave both alone.
        assert_eq!(associated(&[&[0.31, 0.29], &[0.29, 0.0]], 0.3), (vec![(0, 0)], vec![1]));
    }

    #[test]
    fn with_a_rival_the_greatest_total_decides_and_a_weak_pair_is_undone_not_replaced() {
        // Two above the threshold in the first row: .35 + .29 beats .5 + 0, and .29 is then undone.
        assert_eq!(associated(&[&[0.5, 0.45], &[0.29, 0.0]], 0.3), (vec![(0, 1)], vec![1]));
        assert_eq!(associated(&[&[0.5, 0.4], &[0.45, 0.0]], 0.3), (vec![(0, 1), (1, 0)], vec![]));
    }

    #[test]
    fn detections_that_were_never_paired_come_before_those_that_were() {
        // One prediction: the second detection gets it and loses it again.
        assert_eq!(associated(&[&[0.0], &[0.2], &[0.1]], 0.3), (vec![], vec![0, 2, 1]));
        assert_eq!(associated(&[&[], &[]], 0.3), (vec![], vec![0, 1]));
        assert_eq!(associated(&[], 0.3), (vec![], vec![]));
    }

    #[test]
    fn by_score_a_likely_pair_wins_only_where_it_overlaps_enough() {
        let overlap = Grid::from_fn(1, 3, |_, column| [0.5, 0.4, 0.1][column]);
        let score = Grid::from_fn(1, 3, |_, column| [0.5, 0.7, 0.9][column]);
        let mut association = Association::default();
        association.by_score(&score, &overlap, 0.3, &mut Assigner::default());
        assert_eq!(association.pairs, [(0, 1)]);
    }
}
