//! Where a toolkit itself would fail.

use thiserror::Error;

use super::Toolkit;

/// A failure that a toolkit's own user would see. Other toolkits may score the same files.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Crash {
    /// The files do not have as many rows.
    #[error(
        "{toolkit} would fail: the result has {result} rows and the ground truth {truth}; track the sequence again, or score with --toolkit plain or got10k, which drop the rest"
    )]
    Lengths {
        /// The toolkit.
        toolkit: Toolkit,
        /// Rows of the result.
        result: usize,
        /// Rows of the ground truth.
        truth: usize,
    },
    /// A box that the toolkit refuses.
    #[error(
        "{toolkit} would fail: row {row} of the result has a NaN or a negative side; write the last box instead, or score with --toolkit plain"
    )]
    BadBox {
        /// The toolkit.
        toolkit: Toolkit,
        /// The row, counted from 1.
        row: usize,
    },
    /// A ground truth that the toolkit refuses.
    #[error("{toolkit} would fail: row {row} of the ground truth has a NaN; score with --toolkit plain")]
    NanTruth {
        /// The toolkit.
        toolkit: Toolkit,
        /// The row, counted from 1.
        row: usize,
    },
    /// Two boxes without area.
    #[error(
        "{toolkit} would divide by zero: row {row} of both result and ground truth has no area; score with --toolkit plain"
    )]
    NoArea {
        /// The toolkit.
        toolkit: Toolkit,
        /// The row, counted from 1.
        row: usize,
    },
    /// Numbers that the toolkit's reader cannot tell apart.
    #[error(
        "{toolkit} would fail: it reads numbers separated by {takes}, not {found}; write them with `otb_eval convert`, or score with --toolkit plain"
    )]
    Separators {
        /// The toolkit.
        toolkit: Toolkit,
        /// What it takes.
        takes: &'static str,
        /// What stands there.
        found: &'static str,
    },
}

impl Crash {
    /// The toolkit that fails.
    pub const fn toolkit(&self) -> Toolkit {
        match self {
            Self::Lengths { toolkit, .. }
            | Self::BadBox { toolkit, .. }
            | Self::NanTruth { toolkit, .. }
            | Self::NoArea { toolkit, .. }
            | Self::Separators { toolkit, .. } => *toolkit,
        }
    }

    /// What a toolkit fails on, without the place.
    pub const fn cause(&self) -> &'static str {
        match self {
            Self::Lengths { .. } => "the result has not as many rows as the ground truth",
            Self::BadBox { .. } => "a box of the result has a NaN or a negative side",
            Self::NanTruth { .. } => "a NaN in the ground truth",
            Self::NoArea { .. } => "result and ground truth have no area in the same frame",
            Self::Separators { .. } => "its reader cannot tell the result's numbers apart",
        }
    }
}
