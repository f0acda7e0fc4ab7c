//! How sure a fit makes the tracker: confidence and status.

use super::{appearance::Fit, estimate::Status};

/// Below this confidence the target is not taken for seen.
const TRACKING: f64 = 0.7;
/// Below this confidence the target is taken for lost.
const LOST: f64 = 0.35;

/// Log-odds of an overlap above one half as a linear function of what is seen. The coefficients are those of logistic
/// regressions over the frames of sixteen real sequences: eight of people by their part, eight others by the whole box.
struct LogOdds {
    intercept: f64,
    /// What a mean stump of 1 (every stump certain of the target) adds.
    per_mean_stump: f64,
    /// What a unit of squared HOG distance takes away.
    per_hog_distance: f64,
    /// What a factor of e in the sharpness of the correlation filter's peak adds.
    per_log_sharpness: f64,
}

const WITHOUT_CORRELATION: LogOdds =
    LogOdds { intercept: 1.9, per_mean_stump: 3.8, per_hog_distance: 3.8, per_log_sharpness: 0.0 };
const WITH_CORRELATION: LogOdds =
    LogOdds { intercept: -3.61, per_mean_stump: 1.04, per_hog_distance: 3.15, per_log_sharpness: 2.56 };

/// The probability that the estimate overlaps the target by more than one half, in (0, 1). `sharpness` is that of the
/// correlation filter's peak, if there is a filter.
pub(super) fn confidence(fit: &Fit, stumps: usize, sharpness: Option<f32>) -> f64 {
    let mean_stump = f64::from(fit.score) / stumps as f64;
    let (model, sharpness) = match sharpness {
        Some(sharpness) => (WITH_CORRELATION, f64::from(sharpness).max(1.0)),
        None => (WITHOUT_CORRELATION, 1.0),
    };
    let log_odds = model.intercept + model.per_mean_stump * mean_stump
        - model.per_hog_distance * f64::from(fit.hog_distance)
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
        let of = |score, hog_distance| confidence(&Fit { score, hog_distance }, 40, None);
        assert!(of(20.0, 0.2) > of(0.0, 0.2) && of(20.0, 0.2) > of(20.0, 0.8));
        assert_eq!(status(of(20.0, 0.2)), Status::Tracking);
        assert_eq!(status(of(-10.0, 0.5)), Status::Uncertain);
        assert_eq!(status(of(-30.0, 1.0)), Status::Lost);
    }
}
