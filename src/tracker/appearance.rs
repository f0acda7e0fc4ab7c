//! Algorithm 2: the likelihood of a frame given a hypothesis.
//!
//! Steps:
//! 1. the hypothesis in the search region's cells (features are evaluated scaled instead of resizing a crop),
//! 2. HOG2 and the Haar-like features that the classifier reads,
//! 3. conf = F(Haar2) (Algorithm 3),
//! 4. likelihood = exp(alpha * conf - gamma * ||HOG1 - HOG2||^2 + beta * the correlation filter's response
//!    + its weight * the scale filter's response).
//!
//! What it compares with is learnt from samples of frames (Algorithms 4 and 5).

use rand::Rng;
use rayon::prelude::*;

use crate::{
    bayes::Observation,
    boosting::{BoostingOptions, GentleAdaBoost, Label, SampleMemory, StrongClassifier, Stump},
    features::{
        haar::HaarFeature,
        hog::Hog,
        region::{BoxInRegion, RegionIntegrals},
    },
    geometry::Rect,
};

use super::{
    locator::Locator,
    motion::{PartState, box_of},
    parameters::Parameters,
    sampling::Sampler,
};

/// What the target looks like.
#[derive(Debug, Clone)]
pub(super) struct Appearance {
    /// The Haar-like features that samples are made of.
    pool: Vec<HaarFeature>,
    /// HOG1.
    template: Hog,
    /// The classifier's stumps, each with the feature it reads.
    stumps: Vec<(HaarFeature, Stump)>,
    score_weight: f32,
    hog_weight: f32,
    /// A in HOG1 += A (HOG2 - HOG1).
    ageing: f32,
    sampler: Sampler,
    memory: SampleMemory,
    trainer: GentleAdaBoost,
    classifier: StrongClassifier,
    /// Where samples are taken, and their feature vectors, one after another.
    boxes: Vec<(Rect, Label)>,
    samples: Vec<f32>,
}

/// How well a box fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    /// conf: the classifier's score, in [-s, s].
    pub score: f32,
    /// Squared HOG distance to the template, in [0, 2].
    pub hog_distance: f32,
}

impl Appearance {
    pub fn new(parameters: &Parameters, pool: Vec<HaarFeature>, template: Hog) -> Self {
        let per_score = if parameters.score_per_root_stump { (parameters.stumps as f64).sqrt() } else { 1.0 };
        Self {
            boxes: Vec::new(),
            samples: Vec::new(),
            memory: SampleMemory::new(
                pool.len(),
                parameters.first_targets + parameters.first_backgrounds,
                parameters.recent_samples,
            ),
            trainer: GentleAdaBoost::new(BoostingOptions {
                rounds: parameters.stumps,
                balanced: parameters.balanced_labels,
                turns: parameters.boosting_turns,
            }),
            classifier: StrongClassifier::default(),
            sampler: Sampler::new(parameters),
            pool,
            template,
            ageing: parameters.hog_ageing as f32,
            stumps: Vec::with_capacity(parameters.stumps),
            score_weight: (parameters.score_weight / per_score) as f32,
            hog_weight: parameters.hog_weight as f32,
        }
    }

    /// Samples the part and its surroundings inside the search region, so many targets and backgrounds (Algorithm 5), and
    /// trains the classifier on all samples in the memory (Algorithm 4).
    pub fn learn<R: Rng + ?Sized>(
        &mut self,
        integrals: &RegionIntegrals,
        part: &Rect,
        counts: (usize, usize),
        rng: &mut R,
    ) {
        let Self { pool, memory, boxes, samples, .. } = self;
        boxes.clear();
        let field = integrals.region().to_rect();
        self.sampler.draw(part, &field, counts, rng, |part, label| boxes.push((*part, label)));
        samples.resize(boxes.len() * pool.len(), 0.0);
        samples.par_chunks_exact_mut(pool.len()).zip(boxes.par_iter()).with_max_len(1).for_each(
            |(sample, (part, _))| {
                let hypothesis = integrals.to_region(*part);
                for (value, feature) in sample.iter_mut().zip(pool.iter()) {
                    *value = feature.evaluate(integrals, &hypothesis);
                }
            },
        );
        for (sample, (_, label)) in samples.chunks_exact(pool.len()).zip(boxes.iter()) {
            memory.add(sample, *label);
        }
        self.trainer.train(&self.memory, &mut self.classifier);
        self.stumps.clear();
        self.stumps.extend(self.classifier.stumps().iter().map(|stump| (self.pool[stump.feature], *stump)));
    }

    /// Lets the template follow what the part looks like now.
    pub fn age_template(&mut self, integrals: &RegionIntegrals, part: Rect) {
        if self.ageing > 0.0 {
            self.template.age_towards(&Hog::of(integrals, &integrals.to_region(part)), self.ageing);
        }
    }

    /// Steps 2 and 3.
    pub fn fit(&self, integrals: &RegionIntegrals, hypothesis: &BoxInRegion) -> Fit {
        let score = self
            .stumps
            .iter()
            .map(|(feature, stump)| stump.answer(feature.evaluate(integrals, hypothesis)))
            .sum();
        let hog_distance = self.template.squared_distance(&Hog::of(integrals, hypothesis));
        Fit { score, hog_distance }
    }
}

/// A frame as an observation of the part's state.
pub(super) struct FrameObservation<'a> {
    /// The search region.
    pub integrals: &'a RegionIntegrals,
    /// What is looked for.
    pub appearance: &'a Appearance,
    /// h / w of the part.
    pub aspect: f64,
    /// The correlation filters that have looked at the frame.
    pub locator: Option<&'a Locator>,
}

impl Observation<3> for FrameObservation<'_> {
    fn log_likelihood(&self, state: &PartState) -> f64 {
        let part = box_of(state, self.aspect);
        let fit = self.appearance.fit(self.integrals, &self.integrals.to_region(part));
        let of_fit = self.appearance.score_weight * fit.score - self.appearance.hog_weight * fit.hog_distance;
        f64::from(of_fit) + self.locator.map_or(0.0, |locator| locator.log_likelihood(part))
    }
}
