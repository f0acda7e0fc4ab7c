//! Steps 3b and 3c: where the target is by the sets, what the frame shows there, and how sure that is.

use crate::{features::region::RegionIntegrals, frame::FrameView, geometry::Rect};

use super::{
    super::{
        confidence::{Belief, status},
        cues::Fit,
        estimate::{Estimate, Evidence, Status},
        identity::Portrait,
        motion::box_of,
        parameters::CheckedParameters,
    },
    SURE, Target, merge,
};

/// Frames in a row in which the target is lost and its place shows scenery, after which it is waited for where it was seen last.
const HIDDEN: u32 = 5;

impl Target {
    /// Looks at the scene; after a cut the target is doubted, and searched for at once if it is not seen.
    pub(super) fn see_scene(&mut self, frame: &FrameView<'_>) {
        if self.scene.as_mut().is_some_and(|scene| scene.see(frame)) {
            self.judge.doubt();
            self.search.hurry();
        }
    }

    /// Steps 3b and 3c.
    pub(super) fn judge(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &RegionIntegrals,
    ) -> Fit {
        let (mean, covariance) = merge(&self.set_estimates);
        let part = box_of(&mean, self.aspect);
        let full = parameters.region.full_from_part(part);
        let (fit, mut evidence) = self.evidence(parameters, frame, integrals, part, full);
        let Belief { of_frame, confidence } = self.judge.believe(&mut evidence);
        self.learnable = self.gate.opens(of_frame, fit.response) && self.search.suspect().is_none();
        if let Some(scene) = self.scene.as_mut().filter(|_| confidence >= SURE) {
            scene.remember(frame, full);
        }
        self.estimate = Estimate::new(full, part, confidence, status(confidence));
        self.estimate.effective_sample_size =
            self.set_estimates.iter().map(|set| set.effective_sample_size).sum();
        self.estimate.covariance = covariance;
        self.estimate.evidence = Some(evidence);
        self.find_competitors();
        self.cues.credit(&full);
        self.stay_where_seen(parameters);
        fit
    }

    /// Somebody hidden by the scenery for long is waited for where the target was seen last: the particles would hold on to the scenery.
    fn stay_where_seen(&mut self, parameters: &CheckedParameters) {
        if self.estimate.status == Status::Tracking {
            self.last_seen = self.estimate.box_in_frame;
        }
        let shows_scenery = self.estimate.evidence.is_some_and(|evidence| evidence.shows_scenery());
        self.hidden = if self.estimate.status == Status::Lost && shows_scenery { self.hidden + 1 } else { 0 };
        if self.hidden >= HIDDEN {
            let part = parameters.region.part_from_full(self.last_seen);
            (self.estimate.box_in_frame, self.estimate.part_in_frame) = (self.last_seen, part);
            self.restart_sets(parameters, &part);
            self.hidden = 0;
        }
    }

    /// How well a part and its whole box fit, and what that tells.
    pub(super) fn evidence(
        &mut self,
        parameters: &CheckedParameters,
        frame: &FrameView<'_>,
        integrals: &RegionIntegrals,
        part: Rect,
        full: Rect,
    ) -> (Fit, Evidence) {
        let fit = self.cues.fit(&self.cues.hypothesis(integrals, part, full));
        let likeness = self.identity.likeness(&Portrait::of(integrals, part));
        let evidence = Evidence {
            mean_stump: f64::from(fit.score) / parameters.stumps as f64,
            hog_distance: f64::from(fit.hog_distance),
            peak_sharpness: self.cues.peak_sharpness(),
            likeness: f64::from(likeness),
            scenery: self.scene.as_mut().map(|scene| scene.sameness(frame, part, full)),
            lowest_log_odds: None,
        };
        (fit, evidence)
    }
}
