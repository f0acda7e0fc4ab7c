//! How sure a fit makes the tracker: confidence and status.

use super::{appearance::Fit, estimate::Status};

/// Below this confidence the target is not taken for seen.
const TRACKING: f64 = 0.5;
/// Below this confidence the target is taken for lost.
const LOST: f64 = 0.2;

/// The probability that the estimate overlaps the target by more than one half: a logistic regression on the
/// classifier's mean stump and the HOG distance of the estimate.
pub(super) fn confidence(fit: &Fit, stumps: usize) -> f64 {
    let mean_stump = f64::from(fit.score) / stumps as f64;
    let log_odds = 1.0 + 8.0 * mean_stump - 4.0 * f64::from(fit.hog_distance);
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
