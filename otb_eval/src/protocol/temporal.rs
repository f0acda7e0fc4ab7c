//! Temporal robustness evaluation (TRE): the starts of its twenty runs.
//!
//! Steps, with frames counted from 1:
//! 1. keep the frames whose true box has four positive numbers, but for those on which the target is hidden,
//! 2. the last start is the last kept frame from which at least 20 frames remain,
//! 3. the starts are every (last / 19)-th kept frame from the first on, rounded down, and the last start.
//!
//! Frames that the benchmark omits altogether (Tiger1's first five) are not in the truth any more. With the benchmark's
//! lists of hidden frames 78 of the 100 targets get the starts of the archived runs; archived results say themselves where
//! each of them starts.

use std::ops::RangeInclusive;

use infopart::geometry::Rect;

use super::ProtocolError;

/// Runs of TRE.
pub const RUNS: usize = 20;

/// Frames of its shortest run.
pub(super) const SHORTEST: usize = 20;

/// Rows of the truth, counted from 0, on which the twenty runs start, in order; the first is OPE's. There are fewer
/// if fewer than 19 frames could be the last start. None starts on the rows of `hidden`.
///
/// # Errors
/// [`ProtocolError::TooShort`] if no run of 20 frames is left.
pub fn starts(truth: &[Rect], hidden: &[RangeInclusive<usize>]) -> Result<Vec<usize>, ProtocolError> {
    let is_hidden = |row: &usize| hidden.iter().any(|range| range.contains(row));
    let kept: Vec<usize> =
        (0..truth.len()).filter(|row| is_positive(&truth[*row]) && !is_hidden(row)).collect();
    let last = kept.iter().filter(|&&row| truth.len() - row >= SHORTEST).count();
    if last == 0 {
        return Err(ProtocolError::TooShort { frames: kept.len() });
    }
    let step = last as f64 / (RUNS - 1) as f64;
    let regular = (0..RUNS - 1).map(|run| 1.0 + run as f64 * step).take_while(|&start| start <= last as f64);
    let positions = regular.map(|start| start.floor() as usize).chain([last]);
    Ok(positions.map(|position| kept[position - 1]).collect())
}

fn is_positive(row: &Rect) -> bool {
    [row.x, row.y, row.w, row.h].iter().all(|&number| number > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(frames: usize) -> Vec<Rect> {
        vec![Rect::new(1.0, 1.0, 5.0, 5.0); frames]
    }

    /// As the benchmark counts, from 1.
    fn one_based(truth: &[Rect]) -> Vec<usize> {
        starts(truth, &[]).unwrap().into_iter().map(|row| row + 1).collect()
    }

    #[test]
    fn a_sequence_of_140_frames_starts_where_couples_archived_runs_start() {
        assert_eq!(
            one_based(&truth(140)),
            [1, 7, 13, 20, 26, 32, 39, 45, 51, 58, 64, 71, 77, 83, 90, 96, 102, 109, 115, 121]
        );
    }

    #[test]
    fn no_run_starts_on_a_frame_that_is_hidden_or_without_a_positive_box() {
        let mut truth = truth(100);
        for row in [0, 1, 40, 41, 42] {
            truth[row] = Rect::new(0.0, 0.0, 0.0, 0.0);
        }
        truth[50].x = f64::NAN;
        let starts = starts(&truth, &[30..=31, 99..=200]).unwrap();
        assert_eq!((starts.len(), starts[0], starts[19]), (20, 2, 80));
        assert!(starts.iter().all(|row| ![0, 1, 30, 31, 40, 41, 42, 50].contains(row)));
        assert!(starts.is_sorted());
    }

    #[test]
    fn a_short_sequence_has_fewer_runs_and_a_shorter_one_none() {
        assert_eq!(
            one_based(&truth(38)),
            [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 19]
        );
        assert_eq!(one_based(&truth(21)), [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2]);
        assert_eq!(one_based(&truth(20)), [1, 1]);
        assert_eq!(starts(&truth(19), &[]), Err(ProtocolError::TooShort { frames: 19 }));
    }
}
