//! What a target looks like: the histograms of its halves, and how well a box fits them.

use crate::{
    bayes::Observation,
    features::colour_histogram::{Histogram, HistogramIntegrals, Normalisation},
    geometry::Rect,
    tracker::motion::{PartState, box_of},
};

use super::parameters::{ColourParameters, Halves};

/// The reference histograms H: upper half and lower half, or the whole target twice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Appearance {
    halves: Halves,
    reference: [Histogram; 2],
}

impl Appearance {
    pub fn of(integrals: &HistogramIntegrals, target: &Rect, halves: Halves) -> Self {
        Self { halves, reference: histograms(integrals, target, halves) }
    }

    /// <H, H_i> of a box, both halves taken together, in [0, 1].
    pub fn similarity(
        &self,
        integrals: &HistogramIntegrals,
        target: &Rect,
        normalisation: Normalisation,
    ) -> f64 {
        let [upper, lower] = &self.reference;
        let of = |reference: &Histogram, area: &Rect| {
            reference.inner_product(&integrals.histogram(area), normalisation)
        };
        match self.halves {
            Halves::Whole => of(upper, target),
            Halves::Product => of(upper, &upper_half(target)) * of(lower, &lower_half(target)),
            Halves::Mean => (of(upper, &upper_half(target)) + of(lower, &lower_half(target))) / 2.0,
        }
    }

    /// The correlation of two targets: the mean of their halves' inner products, in [0, 1].
    pub fn correlation(&self, other: &Self) -> f64 {
        let products = self.reference.iter().zip(&other.reference);
        products.map(|(a, b)| a.inner_product(b, Normalisation::L2)).sum::<f64>() / 2.0
    }

    /// Moves the references towards what is in the box.
    pub fn age_towards(&mut self, integrals: &HistogramIntegrals, target: &Rect, rate: f64) {
        let current = histograms(integrals, target, self.halves);
        for (reference, current) in self.reference.iter_mut().zip(&current) {
            reference.age_towards(current, rate);
        }
    }
}

fn histograms(integrals: &HistogramIntegrals, target: &Rect, halves: Halves) -> [Histogram; 2] {
    if halves == Halves::Whole {
        return [integrals.histogram(target); 2];
    }
    [upper_half(target), lower_half(target)].map(|half| integrals.histogram(&half))
}

fn upper_half(target: &Rect) -> Rect {
    Rect { h: target.h / 2.0, ..*target }
}

fn lower_half(target: &Rect) -> Rect {
    Rect { y: target.y + target.h / 2.0, h: target.h / 2.0, ..*target }
}

/// The weights' logarithms, 10 <H, H_i>, in one frame.
pub(super) struct FrameObservation<'a> {
    pub integrals: &'a HistogramIntegrals,
    pub appearance: &'a Appearance,
    pub parameters: &'a ColourParameters,
    /// h / w.
    pub aspect: f64,
}

impl Observation<3> for FrameObservation<'_> {
    fn log_likelihood(&self, state: &PartState) -> f64 {
        let target = box_of(state, self.aspect);
        let similarity = self.appearance.similarity(self.integrals, &target, self.parameters.normalisation);
        self.parameters.similarity_weight * similarity
    }
}
