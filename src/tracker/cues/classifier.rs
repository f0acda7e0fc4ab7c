//! The boosted classifier over Haar-like features of the part: alpha * F(Haar2) of Algorithms 2 and 3, trained by
//! Algorithms 4 and 5.

use rand::Rng;

use crate::{
    boosting::{BoostingOptions, GentleAdaBoost, Label, SampleMemory, StrongClassifier, Stump},
    features::{haar::HaarFeature, region::RegionIntegrals},
    geometry::Rect,
    parallel::{ChunksMut, for_each},
};

use super::{Cue, Hypothesis, Parameters};
use crate::tracker::sampling::Sampler;

/// The classifier, what it is trained on, and its weight.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Classifier {
    /// alpha.
    weight: f64,
    /// The Haar-like features that samples are made of.
    pool: Vec<HaarFeature>,
    /// The stumps, each with the feature it reads.
    stumps: Vec<(HaarFeature, Stump)>,
    sampler: Sampler,
    memory: SampleMemory,
    trainer: GentleAdaBoost,
    strong: StrongClassifier,
    /// Where samples are taken, and their feature vectors, one after another.
    boxes: Vec<(Rect, Label)>,
    samples: Vec<f32>,
}

/// Where a lesson takes its samples.
pub(in crate::tracker) struct Lesson<'a> {
    /// Integral images of all that is sampled.
    pub integrals: &'a RegionIntegrals,
    /// The target's part.
    pub part: Rect,
    /// Boxes of the part's size that look like it and are not: hard negatives.
    pub others: &'a [Rect],
    /// Targets and backgrounds to draw besides.
    pub counts: (usize, usize),
}

impl Classifier {
    pub fn new(parameters: &Parameters, pool: Vec<HaarFeature>) -> Self {
        let per_score = if parameters.score_per_root_stump { (parameters.stumps as f64).sqrt() } else { 1.0 };
        Self {
            weight: parameters.score_weight / per_score,
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
            strong: StrongClassifier::default(),
            sampler: Sampler::new(parameters),
            pool,
            stumps: Vec::with_capacity(parameters.stumps),
        }
    }

    /// conf = F(Haar2), in [-s, s].
    pub fn score(&self, hypothesis: &Hypothesis<'_>) -> f32 {
        let answer = |(feature, stump): &(HaarFeature, Stump)| {
            stump.answer(feature.evaluate(hypothesis.integrals, &hypothesis.part_in_region))
        };
        self.stumps.iter().map(answer).sum()
    }

    /// Samples the part, its surroundings and the others (Algorithm 5), and trains on all samples in the memory
    /// (Algorithm 4).
    pub fn train<R: Rng + ?Sized>(&mut self, lesson: &Lesson<'_>, rng: &mut R) {
        let Self { pool, memory, boxes, samples, .. } = self;
        let Lesson { integrals, part, others, counts } = lesson;
        boxes.clear();
        let field = integrals.region().to_rect();
        self.sampler.draw(part, &field, *counts, rng, |part, label| boxes.push((*part, label)));
        self.sampler.draw_others(part, others, rng, |other| boxes.push((*other, Label::Background)));
        samples.resize(boxes.len() * pool.len(), 0.0);
        let of_boxes = (ChunksMut(samples, pool.len()), boxes.as_slice());
        for_each(of_boxes, 1, |_, (sample, (part, _))| {
            let hypothesis = integrals.to_region(*part);
            for (value, feature) in sample.iter_mut().zip(pool.iter()) {
                *value = feature.evaluate(integrals, &hypothesis);
            }
        });
        for (sample, (_, label)) in samples.chunks_exact(pool.len()).zip(boxes.iter()) {
            memory.add(sample, *label);
        }
        self.trainer.train(&self.memory, &mut self.strong);
        self.stumps.clear();
        self.stumps.extend(self.strong.stumps().iter().map(|stump| (self.pool[stump.feature], *stump)));
    }
}

impl Cue for Classifier {
    fn log_likelihood(&self, hypothesis: &Hypothesis<'_>) -> f64 {
        self.weight * f64::from(self.score(hypothesis))
    }
}
