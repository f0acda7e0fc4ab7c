//! The evaluators in use, each with its own rules: what they agree on stands in one function, what they differ in is data.
//!
//! The sources of the rules are the toolkits' programs as they were in late 2026: the MATLAB benchmark (`genPerfMat.m`,
//! `calcSeqErrRobust.m`, `calcRectInt.m`, `plotDrawSave.m`), its Python port by J. Lim, pysot-toolkit, the copy of it in
//! STVIR/pysot, got10k and pytracking.

mod crash;
mod curves;
mod evaluate;
mod explain;
mod reasons;
mod rules;
mod thresholds;

use std::{fmt, str::FromStr};

use infopart::sequence::Benchmark;
use serde::Serialize;
use thiserror::Error;

pub use crash::Crash;
pub use curves::{Curves, Hits};
pub use evaluate::{FrameNotes, evaluate, evaluate_with};
pub use reasons::{Reason, reasons};
pub use rules::{
    Denominator, FirstFrame, InvalidError, Lengths, LostBoxes, Normalisation, OverlapFormula, Rules, Validity,
};
pub use thresholds::{ARANGE, MATLAB, NORMALISED_THRESHOLDS, TWENTIETHS};

/// An evaluator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Toolkit {
    /// None of them: rows as they stand, over the frames that both files have, and never a failure.
    Plain,
    /// The MATLAB benchmark, versions 1.0 and 1.1.
    Matlab,
    /// The Python benchmark, tracker_benchmark by J. Lim.
    Jwlim,
    /// pysot-toolkit.
    Pysot,
    /// The toolkit inside STVIR/pysot.
    Stvir,
    /// The GOT-10k toolkit's OTB experiment.
    Got10k,
    /// pytracking's analysis.
    Pytracking,
    /// LaSOT's rules, as pytracking has them: a hidden target is a miss.
    Lasot,
    /// UAV123's rules, as pytracking has them: a frame without a box is a hit in precision.
    Uav,
    /// GOT-10k's rules: average overlap over all frames in which the target can be seen.
    AverageOverlap,
}

/// A toolkit that does not exist.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no toolkit `{word}`; choose one of: {}, all", Toolkit::ALL.map(Toolkit::name).join(", "))]
pub struct UnknownToolkit {
    /// The name as given.
    pub word: String,
}

impl Toolkit {
    /// All, the plain rules first.
    pub const ALL: [Self; 10] = [
        Self::Plain,
        Self::Matlab,
        Self::Jwlim,
        Self::Pysot,
        Self::Stvir,
        Self::Got10k,
        Self::Pytracking,
        Self::Lasot,
        Self::Uav,
        Self::AverageOverlap,
    ];

    /// Those for OTB, the plain rules first.
    pub const OTB: [Self; 7] =
        [Self::Plain, Self::Matlab, Self::Jwlim, Self::Pysot, Self::Stvir, Self::Got10k, Self::Pytracking];

    /// The six that others wrote for OTB.
    pub const SIX: [Self; 6] =
        [Self::Matlab, Self::Jwlim, Self::Pysot, Self::Stvir, Self::Got10k, Self::Pytracking];

    /// The rules that users of a benchmark score by; `None` is OTB's layout.
    pub const fn of(benchmark: Option<Benchmark>) -> Self {
        match benchmark {
            Some(Benchmark::Lasot) => Self::Lasot,
            Some(Benchmark::Uav) => Self::Uav,
            Some(Benchmark::Got10k) => Self::AverageOverlap,
            Some(Benchmark::NeedForSpeed | Benchmark::TrackingNet) => Self::Pytracking,
            _ => Self::Plain,
        }
    }

    /// The name in flags.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Matlab => "matlab",
            Self::Jwlim => "jwlim",
            Self::Pysot => "pysot",
            Self::Stvir => "stvir",
            Self::Got10k => "got10k",
            Self::Pytracking => "pytracking",
            Self::Lasot => "lasot",
            Self::Uav => "uav123",
            Self::AverageOverlap => "got10k-ao",
        }
    }

    /// What it is.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Plain => "no toolkit's special rules",
            Self::Matlab => "the MATLAB benchmark, versions 1.0 and 1.1",
            Self::Jwlim => "the Python benchmark (tracker_benchmark)",
            Self::Pysot => "pysot-toolkit",
            Self::Stvir => "the toolkit inside STVIR/pysot",
            Self::Got10k => "the GOT-10k toolkit's OTB experiment",
            Self::Pytracking => "pytracking's analysis",
            Self::Lasot => "LaSOT's rules, as pytracking has them",
            Self::Uav => "UAV123's rules, as pytracking has them",
            Self::AverageOverlap => "GOT-10k's own rules: AO and SR",
        }
    }
}

impl fmt::Display for Toolkit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Toolkit {
    type Err = UnknownToolkit;

    fn from_str(word: &str) -> Result<Self, UnknownToolkit> {
        Self::ALL
            .into_iter()
            .find(|toolkit| toolkit.name().eq_ignore_ascii_case(word))
            .ok_or_else(|| UnknownToolkit { word: word.to_owned() })
    }
}

#[cfg(test)]
mod tests;
