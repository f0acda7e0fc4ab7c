//! Why toolkits differ on a result.

use std::fmt;

use infopart::geometry::Rect;

/// Something in a pair of files that toolkits treat differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// The first row is not the truth's; three toolkits overwrite it.
    FirstRow,
    /// Rows of the truth without four positive numbers, which some take for invalid.
    NotPositive(usize),
    /// Rows of the truth with a NaN.
    NanTruth(usize),
    /// Rows of the result that are no boxes, which some replace by the box before.
    LostBoxes(usize),
    /// Rows that the result lacks.
    Shorter(usize),
    /// Rows that the result has too many.
    Longer(usize),
}

impl Reason {
    /// How many rows it is about.
    pub fn rows(self) -> usize {
        match self {
            Self::FirstRow => 1,
            Self::NotPositive(rows)
            | Self::NanTruth(rows)
            | Self::LostBoxes(rows)
            | Self::Shorter(rows)
            | Self::Longer(rows) => rows,
        }
    }
}

impl Reason {
    /// The same reason for another number of rows.
    pub fn with_rows(self, rows: usize) -> Self {
        match self {
            Self::FirstRow => Self::FirstRow,
            Self::NotPositive(_) => Self::NotPositive(rows),
            Self::NanTruth(_) => Self::NanTruth(rows),
            Self::LostBoxes(_) => Self::LostBoxes(rows),
            Self::Shorter(_) => Self::Shorter(rows),
            Self::Longer(_) => Self::Longer(rows),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = |count: usize| if count == 1 { "1 row".to_owned() } else { format!("{count} rows") };
        match *self {
            Self::FirstRow => f.write_str(
                "the first row is not the ground truth's (overwritten by matlab, jwlim, got10k, pytracking)",
            ),
            Self::NotPositive(count) => write!(
                f,
                "{} of the ground truth without four positive numbers (always a miss in success, a hit in precision of matlab, jwlim, pysot; others differ)",
                rows(count)
            ),
            Self::NanTruth(count) => {
                write!(
                    f,
                    "{} of the ground truth with NaN (a hit in precision of some, a miss of others)",
                    rows(count)
                )
            }
            Self::LostBoxes(count) => write!(
                f,
                "{} of the result without a box (carried forward by matlab, zeros also by pytracking)",
                rows(count)
            ),
            Self::Shorter(count) => write!(
                f,
                "the result lacks {} (matlab, pysot, stvir fail; got10k and plain drop them; pytracking misses them; jwlim divides by fewer)",
                rows(count)
            ),
            Self::Longer(count) => {
                write!(f, "the result has {} too many (matlab, jwlim, pysot, stvir fail)", rows(count))
            }
        }
    }
}

/// What is in these files that toolkits treat differently; nothing where they all agree.
pub fn reasons(truth: &[Rect], result: &[Rect]) -> Vec<Reason> {
    let count = |rows: &[Rect], is_odd: fn(&Rect) -> bool| rows.iter().filter(|row| is_odd(row)).count();
    let nan = |row: &Rect| [row.x, row.y, row.w, row.h].iter().any(|number| number.is_nan());
    let not_positive = |row: &Rect| [row.x, row.y, row.w, row.h].iter().any(|&number| number <= 0.0);
    let mut found = Vec::new();
    if let (Some(first), Some(true_first)) = (result.first(), truth.first())
        && first != true_first
    {
        found.push(Reason::FirstRow);
    }
    let lengths = (truth.len(), result.len());
    found.extend([
        Reason::NotPositive(count(truth, not_positive)),
        Reason::NanTruth(count(truth, nan)),
        Reason::LostBoxes(count(result, |row| !row.is_proper())),
        Reason::Shorter(lengths.0.saturating_sub(lengths.1)),
        Reason::Longer(lengths.1.saturating_sub(lengths.0)),
    ]);
    found.retain(|reason| reason.rows() > 0);
    found
}
