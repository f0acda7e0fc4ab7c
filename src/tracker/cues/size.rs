//! A correlation filter on the whole box, over size.

use crate::{
    correlation::scale::{ScaleFilter, ScaleOptions},
    geometry::Rect,
};

use super::{Cue, Hypothesis, Parameters, WindowView};

/// The filter and its weight.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Size {
    filter: ScaleFilter,
    weight: f64,
}

impl Size {
    pub fn new(parameters: &Parameters, full: &Rect) -> Self {
        let options = ScaleOptions {
            sizes: parameters.scale_sizes | 1,
            ratio: parameters.scale_ratio,
            rate: parameters.scale_rate as f32,
        };
        Self { filter: ScaleFilter::new(options, full.h / full.w), weight: parameters.scale_weight }
    }
}

impl Cue for Size {
    fn look_closer(&mut self, view: &WindowView, found: Rect) {
        self.filter.look(view.integrals(), found);
    }

    fn log_likelihood(&self, hypothesis: &Hypothesis<'_>) -> f64 {
        self.weight * f64::from(self.filter.at(hypothesis.full.w))
    }

    fn learn(&mut self, view: &WindowView, full: Rect) {
        self.filter.learn(view.integrals(), full);
    }
}
