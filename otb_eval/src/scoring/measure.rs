//! The measures that trackers are judged by, by name.

use std::str::FromStr;

use thiserror::Error;

use super::{Scores, Spread};
use crate::toolkits::Curves;

/// A number that a tracker is judged by; more is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Area under the success curve.
    Auc,
    /// Precision at 20 pixels.
    Precision,
    /// Success at an overlap of 0.5.
    Success,
    /// Normalised precision at 0.2 of the true box's sides, as toolkits print it.
    Normalised,
    /// Area under the normalised precision curve.
    NormalisedArea,
    /// Mean overlap.
    Overlap,
}

/// A measure that does not exist.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no measure `{word}`; choose one of: {}", Measure::ALL.map(Measure::name).join(", "))]
pub struct UnknownMeasure {
    /// The name as given.
    pub word: String,
}

impl Measure {
    /// All measures.
    pub const ALL: [Self; 6] =
        [Self::Auc, Self::Precision, Self::Success, Self::Normalised, Self::NormalisedArea, Self::Overlap];

    /// The name in flags.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auc => "auc",
            Self::Precision => "precision",
            Self::Success => "success",
            Self::Normalised => "normalised",
            Self::NormalisedArea => "normalised-area",
            Self::Overlap => "overlap",
        }
    }

    /// The name in tables.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Auc => "AUC",
            Self::Precision => "precision at 20 px",
            Self::Success => "success at 0.5",
            Self::Normalised => "normalised precision at 0.2",
            Self::NormalisedArea => "normalised precision, area",
            Self::Overlap => "mean overlap",
        }
    }

    /// Its value among scores; `None` where the toolkit has none.
    pub fn of(self, scores: &Scores) -> Option<Spread> {
        match self {
            Self::Auc => Some(scores.auc),
            Self::Precision => Some(scores.precision_20),
            Self::Success => Some(scores.success_50),
            Self::Normalised => scores.normalised_precision_20,
            Self::NormalisedArea => scores.normalised_precision_area,
            Self::Overlap => Some(scores.mean_overlap),
        }
    }

    /// Its value on curves.
    pub fn on(self, curves: &Curves) -> Option<f64> {
        match self {
            Self::Auc => Some(curves.auc()),
            Self::Precision => Some(curves.precision_at_20()),
            Self::Success => Some(curves.success_at_half()),
            Self::Normalised => curves.normalised_precision_at_02(),
            Self::NormalisedArea => curves.normalised_precision_area(),
            Self::Overlap => Some(curves.mean_overlap),
        }
    }
}

impl FromStr for Measure {
    type Err = UnknownMeasure;

    fn from_str(word: &str) -> Result<Self, UnknownMeasure> {
        Self::ALL
            .into_iter()
            .find(|measure| measure.name().eq_ignore_ascii_case(word))
            .ok_or_else(|| UnknownMeasure { word: word.to_owned() })
    }
}
