//! How much more the colours inside a whole box are the target's own than those around it.

use crate::geometry::Rect;

use super::{Cue, Hypothesis, Parameters, WindowView};

/// The weight of the contrast; what it is read from belongs to the view.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Colour {
    weight: f64,
}

impl Colour {
    pub fn new(parameters: &Parameters) -> Self {
        Self { weight: parameters.colour_weight }
    }
}

impl Cue for Colour {
    fn over_window(&self, view: &WindowView, full: &Rect) -> f64 {
        self.weight * f64::from(view.foreground().contrast(*full))
    }

    fn log_likelihood(&self, hypothesis: &Hypothesis<'_>) -> f64 {
        hypothesis.view.map_or(0.0, |view| self.over_window(view, &hypothesis.full))
    }
}
