//! How sure a fit makes the tracker: confidence and status.

use super::estimate::{Evidence, Status};

/// Below this confidence the target is not taken for seen.
const TRACKING: f64 = 0.7;
/// Below this confidence the target is taken for lost.
const LOST: f64 = 0.35;

/// Log-odds of an overlap above one half as a linear function of the evidence.
struct LogOdds {
    intercept: f64,
    /// What a mean stump of 1 adds.
    per_mean_stump: f64,
    /// What a unit of squared HOG distance takes away.
    per_hog_distance: f64,
    /// What a factor of e in the sharpness of the correlation filter's peak adds.
    per_log_sharpness: f64,
}

/// Logistic regressions over the frames of real sequences, people by their part and others by the whole box, each
/// sequence weighing the same; docs/calibration.md says which, and how well they hold on others.
const WITH_CORRELATION: LogOdds =
    LogOdds { intercept: -0.42, per_mean_stump: 2.59, per_hog_distance: 2.64, per_log_sharpness: 1.29 };
const WITHOUT_CORRELATION: LogOdds =
    LogOdds { intercept: 1.9, per_mean_stump: 3.8, per_hog_distance: 3.8, per_log_sharpness: 0.0 };

/// The probability that the estimate overlaps the target by more than one half, in (0, 1).
pub(super) fn confidence(evidence: &Evidence) -> f64 {
    let (model, sharpness) = match evidence.peak_sharpness {
        Some(sharpness) => (WITH_CORRELATION, sharpness.max(1.0)),
        None => (WITHOUT_CORRELATION, 1.0),
    };
    let log_odds = model.intercept + model.per_mean_stump * evidence.mean_stump
        - model.per_hog_distance * evidence.hog_distance
        + model.per_log_sharpness * sharpness.ln();
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
        let of = |mean_stump, hog_distance, peak_sharpness| {
            confidence(&Evidence { mean_stump, hog_distance, peak_sharpness })
        };
        assert!(of(0.5, 0.2, None) > of(0.0, 0.2, None) && of(0.5, 0.2, None) > of(0.5, 0.8, None));
        assert!(of(0.5, 0.2, Some(20.0)) > of(0.5, 0.2, Some(10.0)));
        assert_eq!(status(of(0.7, 0.2, Some(25.0))), Status::Tracking);
        assert_eq!(status(of(-0.4, 0.5, Some(10.0))), Status::Uncertain);
        assert_eq!(status(of(-0.8, 0.9, Some(8.0))), Status::Lost);
    }
}
