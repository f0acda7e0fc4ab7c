//! How sure a fit makes the tracker: confidence and status.

use super::{appearance::Fit, estimate::Status};

/// Below this confidence the target is not taken for seen.
const TRACKING: f64 = 0.5;
/// Below this confidence the target is taken for lost.
const LOST: f64 = 0.2;

/// Log-odds of an overlap above one half at score 0 and HOG distance 0; these three are the logistic regression over
/// the frames of sixteen real sequences and three seeds, each sequence weighing the same: eight of people by their
/// part, eight others by the whole box.
const INTERCEPT: f64 = 1.9;
/// What a mean stump of 1 (every stump certain of the target) adds.
const PER_MEAN_STUMP: f64 = 3.8;
/// What a unit of squared HOG distance takes away.
const PER_HOG_DISTANCE: f64 = 3.8;

/// The probability that the estimate overlaps the target by more than one half, in (0, 1).
pub(super) fn confidence(fit: &Fit, stumps: usize) -> f64 {
    let mean_stump = f64::from(fit.score) / stumps as f64;
    let log_odds = INTERCEPT + PER_MEAN_STUMP * mean_stump - PER_HOG_DISTANCE * f64::from(fit.hog_distance);
    1.0 / (1.0 + (-log_odds).exp())
}

/// The confidence in one word.
pub(super) fn status(confidence: f64) -> Status {
    if confidence >= TRACKING {
        Status::Tracking
    } else if confidence >= LOST {
        Status::Uncertain
    } else {
        Status::Lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_better_fit_is_surer_and_the_words_follow() {
        let of = |score, hog_distance| confidence(&Fit { score, hog_distance }, 40);
        assert!(of(20.0, 0.2) > of(0.0, 0.2) && of(20.0, 0.2) > of(20.0, 0.8));
        assert_eq!(status(of(20.0, 0.2)), Status::Tracking);
        assert_eq!(status(of(-10.0, 0.5)), Status::Uncertain);
        assert_eq!(status(of(-30.0, 1.0)), Status::Lost);
    }
}
