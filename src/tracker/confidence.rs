//! How sure the tracker is: confidence and status.
//!
//! Steps, each frame:
//! 1. the log-odds of the frame alone, from its evidence,
//! 2. the lowest of these so far, which is forgotten little by little: a target that was out of sight, or in a scene that was cut,
//!    may be another since,
//! 3. the confidence, from both,
//! 4. the confidence in one word.

use super::estimate::{Evidence, Status};

/// Below this confidence the target is not taken for seen.
const TRACKING: f64 = 0.7;
/// Below this confidence the target is taken for lost.
const LOST: f64 = 0.35;

/// Log-odds of an overlap above one half as a linear function of what a frame shows.
struct OfFrame {
    intercept: f64,
    /// What a mean stump of 1 adds.
    per_mean_stump: f64,
    /// What a unit of squared HOG distance takes away.
    per_hog_distance: f64,
    /// What a factor of e in the sharpness of the correlation filter's peak adds.
    per_log_sharpness: f64,
}

/// The same as a linear function of a frame's log-odds and the lowest.
struct WithMemory {
    intercept: f64,
    per_log_odds: f64,
    per_lowest: f64,
}

/// Logistic regressions over the frames of real sequences, people by their part and others by the whole box, each
/// sequence weighing the same; docs/calibration.md says which, and how well they hold on others.
const WITH_CORRELATION: OfFrame =
    OfFrame { intercept: -0.42, per_mean_stump: 2.59, per_hog_distance: 2.64, per_log_sharpness: 1.29 };
const WITHOUT_CORRELATION: OfFrame =
    OfFrame { intercept: 1.9, per_mean_stump: 3.8, per_hog_distance: 3.8, per_log_sharpness: 0.0 };
const WITH_MEMORY: WithMemory = WithMemory { intercept: 0.23, per_log_odds: 0.69, per_lowest: 0.31 };

/// From this likeness on, identity says nothing against the target.
const LIKE: f64 = 0.5;
/// What a unit of likeness below that takes away from the log-odds.
const PER_UNLIKENESS: f64 = 20.0;

/// Up to this correlation with the scenery, the scene says nothing against the target.
const OTHER_THAN_SCENERY: f64 = 0.65;
/// What a unit of correlation above that takes away from the log-odds.
const PER_SCENERY: f64 = 20.0;

/// The lowest log-odds before anything was seen, and at most.
const HIGHEST: f64 = 4.0;
/// Lower log-odds are remembered as these.
const LOWEST: f64 = -2.0;
/// What the lowest log-odds rise by in a frame.
const FORGOTTEN: f64 = 0.005;

/// What is believed of an estimate: probabilities that it overlaps the target by more than one half, in (0, 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Belief {
    /// From the frame alone: whether it is worth learning from.
    pub of_frame: f64,
    /// From the frame and those before: what the tracker reports.
    pub confidence: f64,
}

/// Turns evidence into belief, frame after frame.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Judge {
    lowest_log_odds: f64,
}

impl Default for Judge {
    fn default() -> Self {
        Self { lowest_log_odds: HIGHEST }
    }
}

impl Judge {
    /// The scene was cut: whoever is seen from here on may be another.
    pub fn doubt(&mut self) {
        self.lowest_log_odds = self.lowest_log_odds.min(LOWEST);
    }

    /// Steps 1 to 3; writes into the evidence what was remembered. Without the correlation filter there is no memory: the frame
    /// speaks alone.
    pub fn believe(&mut self, evidence: &mut Evidence) -> Belief {
        let of_frame = log_odds(evidence);
        let mut with_memory = of_frame;
        if evidence.peak_sharpness.is_some() {
            self.lowest_log_odds = of_frame.max(LOWEST).min(self.lowest_log_odds + FORGOTTEN).min(HIGHEST);
            evidence.lowest_log_odds = Some(self.lowest_log_odds);
            let WithMemory { intercept, per_log_odds, per_lowest } = WITH_MEMORY;
            with_memory = intercept + per_log_odds * of_frame + per_lowest * self.lowest_log_odds;
        }
        Belief { of_frame: probability(of_frame), confidence: probability(with_memory) }
    }
}

impl Evidence {
    /// Whether the box shows what stood there when the target was elsewhere.
    pub(super) fn shows_scenery(&self) -> bool {
        self.scenery.is_some_and(|scenery| scenery > OTHER_THAN_SCENERY)
    }
}

/// The probability that an estimate is right from the evidence of one frame alone.
pub(super) fn of_frame(evidence: &Evidence) -> f64 {
    probability(log_odds(evidence))
}

/// Step 1.
fn log_odds(evidence: &Evidence) -> f64 {
    let (model, sharpness) = match evidence.peak_sharpness {
        Some(sharpness) => (WITH_CORRELATION, sharpness.max(1.0)),
        None => (WITHOUT_CORRELATION, 1.0),
    };
    model.intercept + model.per_mean_stump * evidence.mean_stump
        - model.per_hog_distance * evidence.hog_distance
        + model.per_log_sharpness * sharpness.ln()
        - PER_UNLIKENESS * (LIKE - evidence.likeness).max(0.0)
        - PER_SCENERY * (evidence.scenery.unwrap_or(0.0) - OTHER_THAN_SCENERY).max(0.0)
}

fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

/// Step 4.
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

    fn evidence(mean_stump: f64, hog_distance: f64, peak_sharpness: Option<f64>) -> Evidence {
        Evidence {
            mean_stump,
            hog_distance,
            peak_sharpness,
            likeness: 0.7,
            scenery: None,
            lowest_log_odds: None,
        }
    }

    fn clear() -> Evidence {
        evidence(0.7, 0.2, Some(25.0))
    }

    #[test]
    fn a_better_fit_is_surer_and_the_words_follow() {
        let of = |mean_stump, hog_distance, peak_sharpness| {
            Judge::default().believe(&mut evidence(mean_stump, hog_distance, peak_sharpness)).confidence
        };
        assert!(of(0.5, 0.2, None) > of(0.0, 0.2, None) && of(0.5, 0.2, None) > of(0.5, 0.8, None));
        assert!(of(0.5, 0.2, Some(20.0)) > of(0.5, 0.2, Some(10.0)));
        assert_eq!(status(of(0.7, 0.2, Some(25.0))), Status::Tracking);
        assert_eq!(status(of(-0.4, 0.5, Some(10.0))), Status::Uncertain);
        assert_eq!(status(of(-0.8, 0.9, Some(8.0))), Status::Lost);
    }

    #[test]
    fn after_a_loss_a_clear_frame_is_not_as_sure_as_before_until_the_loss_is_forgotten() {
        let mut judge = Judge::default();
        let before = judge.believe(&mut clear());
        let mut hidden = evidence(-0.8, 0.9, Some(8.0));
        judge.believe(&mut hidden);
        assert!(log_odds(&hidden) < LOWEST);
        assert_eq!(hidden.lowest_log_odds, Some(LOWEST));
        let mut again = clear();
        let after = judge.believe(&mut again);
        assert_eq!(after.of_frame, before.of_frame);
        assert!(after.confidence < before.confidence - 0.02, "{} {}", after.confidence, before.confidence);
        assert!((again.lowest_log_odds.unwrap() - hidden.lowest_log_odds.unwrap() - FORGOTTEN).abs() < 1e-12);
        let later = (0..2000).map(|_| judge.believe(&mut clear())).last().unwrap();
        assert_eq!(later.confidence, before.confidence);
    }

    #[test]
    fn another_and_scenery_are_not_the_target_however_well_they_fit() {
        let sure = |likeness, scenery| {
            let mut evidence = Evidence { likeness, scenery: Some(scenery), ..clear() };
            Judge::default().believe(&mut evidence).confidence
        };
        assert_eq!(status(sure(0.6, 0.5)), Status::Tracking);
        assert_eq!(sure(0.6, 0.5), sure(0.9, 0.0), "neither says anything");
        assert!(sure(0.3, 0.0) < sure(0.4, 0.0) && sure(0.6, 0.9) < sure(0.6, 0.7));
        assert_eq!([status(sure(0.1, 0.0)), status(sure(0.9, 0.97))], [Status::Lost; 2]);
    }

    #[test]
    fn after_a_cut_the_target_is_doubted_as_after_a_loss() {
        let (mut cut, mut lost) = (Judge::default(), Judge::default());
        cut.doubt();
        lost.believe(&mut evidence(-1.0, 2.0, Some(1.0)));
        let [after_cut, after_loss] =
            [&mut cut, &mut lost].map(|judge| judge.believe(&mut clear()).confidence);
        assert_eq!(after_cut, after_loss);
        assert!(after_cut < Judge::default().believe(&mut clear()).confidence);
    }

    #[test]
    fn without_the_filter_the_frame_speaks_alone() {
        let mut judge = Judge::default();
        judge.believe(&mut evidence(-0.9, 1.0, None));
        let mut later = evidence(0.6, 0.2, None);
        let belief = judge.believe(&mut later);
        assert_eq!((belief.confidence, later.lowest_log_odds), (belief.of_frame, None));
    }
}
