//! What could not be scored, and what to do about it.

use thiserror::Error;

use crate::{
    protocol::ProtocolError,
    results::ResultsError,
    toolkits::{Crash, Toolkit},
};

/// How much it matters that something is not as it should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Weight {
    /// Worth knowing.
    Note,
    /// A defect of results that others made, which the rules have an answer to.
    Defect,
    /// Something to put right.
    Problem,
}

/// A result that could not be scored, or not as it stands. Everything else is.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ScoreProblem {
    /// The data has no truth of a sequence.
    #[error("{sequence}: no ground truth of it; check the spelling, or add its folder with --data")]
    NoTruth {
        /// The sequence, or the file's stem.
        sequence: String,
    },
    /// The protocol has no segments on a sequence.
    #[error("{sequence}: {source}")]
    Protocol {
        /// The sequence.
        sequence: String,
        /// Why not.
        source: ProtocolError,
    },
    /// A sequence of which only the first box is known.
    #[error(
        "{sequence}: only its first box is known: the benchmark's server scores it; make what it takes with `otb_eval submit`"
    )]
    FirstOnly {
        /// The sequence.
        sequence: String,
    },
    /// A tracker has no result on a sequence.
    #[error("{tracker}, {stem}: no result (seed {seed}){}; run it, or leave the sequence out with --sequences", reason.as_ref().map(|reason| format!(": {reason}")).unwrap_or_default())]
    Missing {
        /// The tracker.
        tracker: String,
        /// `SEQ[_SEGMENT]`.
        stem: String,
        /// The seed, 0 in the flat layout.
        seed: u64,
        /// Why the job failed, if it did.
        reason: Option<String>,
    },
    /// A result file that cannot be read.
    #[error("{tracker}: {source}")]
    Unreadable {
        /// The tracker.
        tracker: String,
        /// The file and line, and what to do.
        source: ResultsError,
    },
    /// A result that has not a row a frame. It is scored all the same, as the toolkit does it.
    #[error(
        "{tracker}, {stem}: the result has {result} rows and the ground truth {truth}; it is scored under the rules of {toolkit}; track the sequence again, or accept this with --missing-rows"
    )]
    Lengths {
        /// The tracker.
        tracker: String,
        /// `SEQ[_SEGMENT]`.
        stem: String,
        /// Rows of the result.
        result: usize,
        /// Rows of the ground truth.
        truth: usize,
        /// Whether `run` made the result.
        is_own: bool,
        /// Whose rules.
        toolkit: Toolkit,
    },
    /// A result with rows of frames that the benchmark leaves out. Without them it is scored.
    #[error(
        "{tracker}, {stem}: the result has rows of all frames, of which the benchmark leaves the first {dropped} out: row {} is compared with the ground truth's first", dropped + 1
    )]
    Aligned {
        /// The tracker.
        tracker: String,
        /// `SEQ[_SEGMENT]`.
        stem: String,
        /// Rows left out.
        dropped: usize,
    },
    /// A result that is not plain rows of `x,y,w,h`, and has one meaning all the same.
    #[error("{tracker}, {stem}: read with {how}")]
    Read {
        /// The tracker.
        tracker: String,
        /// `SEQ[_SEGMENT]`.
        stem: String,
        /// What was understood.
        how: String,
    },
    /// A run of TRE of which nothing tells on which frame it starts, so that it cannot be scored.
    #[error("{tracker}, {stem}: {}", start_problem(*start, *rows, *truth))]
    Start {
        /// The tracker.
        tracker: String,
        /// `SEQ_SEGMENT`.
        stem: String,
        /// The row, counted from 0, where it says that it starts.
        start: Option<usize>,
        /// Rows of the result.
        rows: usize,
        /// Rows of the ground truth.
        truth: usize,
    },
    /// The toolkit itself would fail.
    #[error("{tracker}, {stem}: {source}")]
    Crash {
        /// The tracker.
        tracker: String,
        /// `SEQ[_SEGMENT]`.
        stem: String,
        /// Which toolkit, and on what.
        source: Crash,
    },
}

fn start_problem(start: Option<usize>, rows: usize, truth: usize) -> String {
    match start {
        Some(start) => format!(
            "the run starts in row {} of a ground truth of {truth} rows, so that it is of other data; give the data it was made on",
            start + 1
        ),
        None => format!(
            "the run has {rows} rows, which the benchmark's start does not leave of {truth}, and nothing tells where it starts; \
             convert it from the published JSON or .mat files with this version, which keeps the starts"
        ),
    }
}

impl ScoreProblem {
    /// How much it matters.
    pub fn weight(&self) -> Weight {
        match self {
            Self::Aligned { .. } | Self::Read { .. } => Weight::Note,
            Self::Lengths { is_own: false, .. } | Self::Crash { .. } => Weight::Defect,
            _ => Weight::Problem,
        }
    }

    /// Whether it is only about a result's length, and the result is scored.
    pub fn is_length(&self) -> bool {
        matches!(self, Self::Lengths { .. })
    }

    /// The sequence that has no ground truth, or the `SEQ[_SEGMENT]` that it is about; `None` for other problems.
    pub fn subject(&self) -> Option<&str> {
        match self {
            Self::NoTruth { sequence } | Self::FirstOnly { sequence } => Some(sequence),
            Self::Missing { stem, .. }
            | Self::Start { stem, .. }
            | Self::Lengths { stem, .. }
            | Self::Aligned { stem, .. }
            | Self::Read { stem, .. }
            | Self::Crash { stem, .. } => Some(stem),
            _ => None,
        }
    }

    /// Whether it is the toolkit's own failure, which it would show its user as well.
    pub fn is_crash(&self) -> bool {
        matches!(self, Self::Crash { .. })
    }
}
