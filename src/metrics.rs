//! The benchmark's measures (Wu, Lim, Yang 2015), defined once: success and precision curves and what is read off them.
//!
//! Frames whose ground truth is missing are the caller's to leave out. Toolkits' special rules (first
//! frame overwritten, invalid frames as hits or misses) are not here: these are the plain definitions.

use serde::{Deserialize, Serialize};

use crate::geometry::Rect;

/// Overlap thresholds of the success curve: 0, 0.05, ..., 1.
pub const SUCCESS_THRESHOLDS: usize = 21;
/// Centre-error thresholds of the precision curve: 0, 1, ..., 50 pixels.
pub const PRECISION_THRESHOLDS: usize = 51;
/// Centre error, in pixels, up to which a frame counts for R1.
pub const R1_PIXELS: usize = 20;
/// Index of the overlap threshold 0.5, beyond which a frame counts for R2.
const R2_INDEX: usize = 10;

/// Share of frames, in [0, 1], whose overlap is strictly greater than each of 0, 0.05, ..., 1.
pub fn success_curve(overlaps: &[f64]) -> [f64; SUCCESS_THRESHOLDS] {
    std::array::from_fn(|i| share(overlaps, |overlap| overlap > i as f64 / 20.0))
}

/// Share of frames, in [0, 1], whose centre error is at most each of 0, 1, ..., 50 pixels.
pub fn precision_curve(centre_errors: &[f64]) -> [f64; PRECISION_THRESHOLDS] {
    std::array::from_fn(|i| share(centre_errors, |error| error <= i as f64))
}

/// What a pass over a sequence is judged by.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Scores {
    /// Frames that have ground truth, the first among them.
    pub frames: usize,
    /// R1: percentage of frames with a centre error of at most 20 pixels.
    pub r1: f64,
    /// R2: percentage of frames with an overlap greater than 0.5.
    pub r2: f64,
    /// Area under the success curve: the plain mean of its 21 values, in [0, 20/21].
    pub auc: f64,
}

/// Scores pairs of (result, ground truth), both in the same coordinates; `None` if there is no pair.
pub fn score(pairs: &[(Rect, Rect)]) -> Option<Scores> {
    if pairs.is_empty() {
        return None;
    }
    let overlaps: Vec<f64> = pairs.iter().map(|(result, truth)| result.overlap(truth)).collect();
    let errors: Vec<f64> = pairs.iter().map(|(result, truth)| result.centre_distance(truth)).collect();
    let success = success_curve(&overlaps);
    Some(Scores {
        frames: pairs.len(),
        r1: 100.0 * precision_curve(&errors)[R1_PIXELS],
        r2: 100.0 * success[R2_INDEX],
        auc: success.iter().sum::<f64>() / SUCCESS_THRESHOLDS as f64,
    })
}

fn share(values: &[f64], hit: impl Fn(f64) -> bool) -> f64 {
    values.iter().filter(|&&v| hit(v)).count() as f64 / values.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_perfect_tracker_scores_twenty_of_twenty_one() {
        let truth = Rect::new(1.0, 2.0, 30.0, 40.0);
        let scores = score(&[(truth, truth); 7]).unwrap();
        assert_eq!((scores.r1, scores.r2, scores.frames), (100.0, 100.0, 7));
        assert!((scores.auc - 0.952381).abs() < 1e-6);
    }

    #[test]
    fn success_is_strict_and_precision_inclusive() {
        let truth = Rect::new(0.0, 0.0, 20.0, 10.0);
        let half = Rect::new(0.0, 0.0, 10.0, 10.0);
        assert_eq!(half.overlap(&truth), 0.5);
        assert_eq!(score(&[(half, truth)]).unwrap().r2, 0.0);
        let twenty_off = truth.translated(12.0, 16.0);
        assert_eq!(score(&[(twenty_off, truth)]).unwrap().r1, 100.0);
        assert_eq!(score(&[(twenty_off.translated(0.0, 1e-9), truth)]).unwrap().r1, 0.0);
    }

    #[test]
    fn a_nan_result_is_a_miss_everywhere() {
        let truth = Rect::new(0.0, 0.0, 10.0, 10.0);
        let lost = Rect::new(f64::NAN, 0.0, 10.0, 10.0);
        let scores = score(&[(lost, truth), (truth, truth)]).unwrap();
        assert_eq!((scores.r1, scores.r2), (50.0, 50.0));
        assert!((scores.auc - 0.952381 / 2.0).abs() < 1e-6);
    }

    #[test]
    fn nothing_to_score_has_no_score() {
        assert_eq!(score(&[]), None);
    }
}
