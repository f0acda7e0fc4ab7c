//! How far a part's HOG is from what the target's looked like: -gamma ||HOG1 - HOG2||^2 of Algorithm 2.

use crate::features::{hog::Hog, region::BoxInRegion, region::RegionIntegrals};

use super::{Cue, Hypothesis, Parameters};

/// The template and its weight.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Gradients {
    /// HOG1.
    template: Hog,
    /// gamma.
    weight: f64,
    /// A in HOG1 += A (HOG2 - HOG1).
    ageing: f32,
}

impl Gradients {
    pub fn new(parameters: &Parameters, template: Hog) -> Self {
        Self { template, weight: parameters.hog_weight, ageing: parameters.hog_ageing as f32 }
    }

    /// Squared distance to the template, in [0, 2].
    pub fn distance(&self, hypothesis: &Hypothesis<'_>) -> f32 {
        self.template.squared_distance(&Hog::of(hypothesis.integrals, &hypothesis.part_in_region))
    }

    /// Lets the template follow what the part looks like now.
    pub fn age(&mut self, integrals: &RegionIntegrals, part: &BoxInRegion) {
        if self.ageing > 0.0 {
            self.template.age_towards(&Hog::of(integrals, part), self.ageing);
        }
    }
}

impl Cue for Gradients {
    fn log_likelihood(&self, hypothesis: &Hypothesis<'_>) -> f64 {
        -self.weight * f64::from(self.distance(hypothesis))
    }
}
