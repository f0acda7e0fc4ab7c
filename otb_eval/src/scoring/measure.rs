//! The measures that trackers are judged by, by name.

use std::str::FromStr;

use thiserror::Error;

use super::{Scores, Spread};
use crate::toolkits::{Curves, Rules, Toolkit};

/// A number that a tracker is judged by; more is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Area under the success curve.
    Auc,
    /// Precision at 20 pixels.
    Precision,
    /// Success at an overlap of 0.5.
    Success,
    /// Success at an overlap of 0.75.
    Success75,
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
    pub const ALL: [Self; Self::COUNT] = [
        Self::Auc,
        Self::Precision,
        Self::Success,
        Self::Success75,
        Self::Normalised,
        Self::NormalisedArea,
        Self::Overlap,
    ];

    /// How many there are.
    pub const COUNT: usize = 7;

    /// The measures that users of a toolkit quote, the first of which ranks trackers.
    pub const fn quoted(toolkit: Toolkit) -> &'static [Self] {
        match toolkit {
            Toolkit::Matlab | Toolkit::Jwlim | Toolkit::Got10k => {
                &[Self::Auc, Self::Precision, Self::Success, Self::Overlap]
            }
            Toolkit::AverageOverlap => &[Self::Overlap, Self::Success, Self::Success75],
            Toolkit::Lasot => {
                &[Self::Auc, Self::Precision, Self::NormalisedArea, Self::Normalised, Self::Success]
            }
            Toolkit::Uav => &[Self::Auc, Self::Precision, Self::Success],
            _ => &[
                Self::Auc,
                Self::Precision,
                Self::Success,
                Self::Normalised,
                Self::NormalisedArea,
                Self::Overlap,
            ],
        }
    }

    /// The measures that two trackers are compared in, if no others are asked for.
    pub const fn compared(toolkit: Toolkit) -> &'static [Self] {
        match toolkit {
            Toolkit::AverageOverlap => Self::quoted(toolkit),
            Toolkit::Lasot => &[Self::Auc, Self::Precision, Self::NormalisedArea],
            _ => &[Self::Auc, Self::Precision],
        }
    }

    /// The name in flags.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auc => "auc",
            Self::Precision => "precision",
            Self::Success => "success",
            Self::Success75 => "success-75",
            Self::Normalised => "normalised",
            Self::NormalisedArea => "normalised-area",
            Self::Overlap => "overlap",
        }
    }

    /// The name in CSV and JSON.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Auc => "auc",
            Self::Precision => "precision_20",
            Self::Success => "success_50",
            Self::Success75 => "success_75",
            Self::Normalised => "normalised_precision_20",
            Self::NormalisedArea => "normalised_precision_area",
            Self::Overlap => "mean_overlap",
        }
    }

    /// The name in tables.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Auc => "AUC",
            Self::Precision => "precision at 20 px",
            Self::Success => "success at 0.5",
            Self::Success75 => "success at 0.75",
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
            Self::Success75 => Some(scores.success_75),
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
            Self::Success75 => Some(curves.success_at_three_quarters()),
            Self::Normalised => curves.normalised_precision_at_02(),
            Self::NormalisedArea => curves.normalised_precision_area(),
            Self::Overlap => Some(curves.mean_overlap),
        }
    }

    /// Its value on a sequence's curves, if the rules count that sequence in the mean.
    pub(super) fn counted(self, curves: &Curves, rules: &Rules) -> Option<f64> {
        let curve: &[f64] = match self {
            Self::Auc | Self::Success | Self::Success75 => &curves.success,
            Self::Precision => &curves.precision,
            Self::Normalised | Self::NormalisedArea => curves.normalised.as_ref()?,
            Self::Overlap => return Some(curves.mean_overlap),
        };
        self.on(curves).filter(|_| rules.counts(curve))
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
