//! What counts before anything is scored: the rules of the MOTChallenge benchmarks, as TrackEval has them.
//!
//! MOT15: rows of the ground truth whose confidence is not 0 (or -1, for none given) count; there are no classes. MOT16, MOT17 and MOT20:
//!
//! 1. In each frame, pair all boxes of the ground truth, of every class and marked or not, with those of the result so that the total
//!    overlap is greatest, among pairs that overlap by at least a half.
//! 2. A box of the result paired with a distractor is removed: nobody is punished for a person in a car, a statue, a mirror image.
//! 3. Of the ground truth only pedestrians count whose confidence is not 0.

use std::collections::BTreeMap;

use crate::{
    assignment::Assigner,
    grid::Grid,
    motchallenge::{Annotation, TrackRow},
};

const MIN_OVERLAP: f64 = 0.5;
const PEDESTRIAN: u32 = 1;

/// Whose rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Benchmark {
    /// 2D MOT 2015: no classes.
    #[default]
    Mot15,
    /// MOT16, whose rules are those of MOT17.
    Mot16,
    /// MOT17.
    Mot17,
    /// MOT20, in which vehicles without an engine are distractors, too.
    Mot20,
}

impl Benchmark {
    fn is_distractor(self, class: u32) -> bool {
        match self {
            Self::Mot15 => false,
            // A person on a vehicle, a static person, a distractor, a reflection; 6 is a vehicle without an engine.
            Self::Mot16 | Self::Mot17 => matches!(class, 2 | 7 | 8 | 12),
            Self::Mot20 => matches!(class, 2 | 6 | 7 | 8 | 12),
        }
    }

    /// Steps 1 to 3: the ground truth and the result that are scored.
    pub fn counted(self, truth: &[Annotation], result: &[TrackRow]) -> (Vec<TrackRow>, Vec<TrackRow>) {
        let is_wanted =
            |one: &&Annotation| one.is_counted() && (self == Self::Mot15 || one.class == Some(PEDESTRIAN));
        let rows = truth.iter().filter(is_wanted).map(|one| one.row).collect();
        if self == Self::Mot15 {
            return (rows, result.to_vec());
        }
        let mut frames: BTreeMap<u32, (Vec<&Annotation>, Vec<usize>)> = BTreeMap::new();
        for one in truth {
            frames.entry(one.row.frame).or_default().0.push(one);
        }
        for (index, row) in result.iter().enumerate() {
            frames.entry(row.frame).or_default().1.push(index);
        }
        let mut is_kept = vec![true; result.len()];
        let mut assigner = Assigner::default();
        for (truth, found) in frames.values() {
            let costs = Grid::from_fn(truth.len(), found.len(), |row, column| {
                let overlap = truth[row].row.box_in_file.overlap(&result[found[column]].box_in_file);
                if overlap < MIN_OVERLAP - f64::EPSILON { 0.0 } else { -overlap }
            });
            for &(row, column) in assigner.solve(&costs) {
                let is_pair = costs.at(row, column) < -f64::EPSILON;
                if is_pair && truth[row].class.is_some_and(|class| self.is_distractor(class)) {
                    is_kept[found[column]] = false;
                }
            }
        }
        let kept = result.iter().zip(is_kept).filter_map(|(row, kept)| kept.then_some(*row)).collect();
        (rows, kept)
    }
}

#[cfg(test)]
mod tests {
    use infopart::geometry::Rect;

    use super::*;

    fn row(identity: u64, x: f64, confidence: f64) -> TrackRow {
        TrackRow { frame: 1, identity, box_in_file: Rect::new(x, 0.0, 10.0, 20.0), confidence }
    }

    fn annotation(identity: u64, x: f64, confidence: f64, class: u32) -> Annotation {
        Annotation { row: row(identity, x, confidence), class: Some(class) }
    }

    #[test]
    fn what_is_paired_with_a_distractor_is_removed_and_only_pedestrians_that_count_are_truth() {
        let truth = [
            annotation(1, 0.0, 1.0, 1),
            annotation(2, 50.0, 0.0, 8),
            annotation(3, 100.0, 0.0, 1),
            annotation(4, 150.0, 0.0, 6),
            annotation(5, 200.0, 1.0, 3),
        ];
        let result =
            [row(1, 1.0, 1.0), row(2, 51.0, 1.0), row(3, 101.0, 1.0), row(4, 151.0, 1.0), row(5, 58.0, 1.0)];
        let names = |rows: &[TrackRow]| rows.iter().map(|row| row.identity).collect::<Vec<_>>();
        let counted = |benchmark: Benchmark| {
            let (truth, result) = benchmark.counted(&truth, &result);
            (names(&truth), names(&result))
        };
        assert_eq!(counted(Benchmark::Mot17), (vec![1], vec![1, 3, 4, 5]));
        assert_eq!(counted(Benchmark::Mot16), counted(Benchmark::Mot17));
        assert_eq!(counted(Benchmark::Mot20), (vec![1], vec![1, 3, 5]));
        assert_eq!(counted(Benchmark::Mot15), (vec![1, 5], vec![1, 2, 3, 4, 5]));
    }
}
