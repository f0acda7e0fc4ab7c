//! Where a tracker starts: once from the first frame, from twenty frames, or from twelve wrong boxes.

mod hidden;
mod spatial;
mod temporal;

use std::{fmt, ops::RangeInclusive, str::FromStr};

use infopart::geometry::Rect;
use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use hidden::{HiddenError, HiddenFrames};
pub use spatial::{SHIFTS, Shift, ShiftRules, unscaled};
pub use temporal::{RUNS, starts};

/// How often and from where a tracker is started on a sequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Protocol {
    /// One-pass evaluation: once, from the true box of the first frame.
    Ope,
    /// Temporal robustness evaluation: from twenty frames, each time to the end.
    Tre,
    /// Spatial robustness evaluation: from the first frame with twelve shifted or scaled boxes.
    Sre,
}

impl Protocol {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Ope, Self::Tre, Self::Sre];

    /// The name in flags and folders.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ope => "ope",
            Self::Tre => "tre",
            Self::Sre => "sre",
        }
    }

    /// The name in titles.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Ope => "OPE",
            Self::Tre => "TRE",
            Self::Sre => "SRE",
        }
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Protocol {
    type Err = ProtocolError;

    fn from_str(word: &str) -> Result<Self, ProtocolError> {
        Self::ALL
            .into_iter()
            .find(|protocol| protocol.name().eq_ignore_ascii_case(word))
            .ok_or_else(|| ProtocolError::Unknown { word: word.to_owned() })
    }
}

/// One start of a tracker on a sequence; it runs from there to the last frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// What its files are called after the sequence: nothing in OPE, `01` to `20` in TRE, the shift's name in SRE.
    pub label: Option<String>,
    /// Row of the truth, counted from 0, of the first frame.
    pub start: usize,
    /// The box the tracker is given, in the coordinates of the truth's file.
    pub first_box: Rect,
}

/// Starts that cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ProtocolError {
    /// No such protocol.
    #[error("there is no protocol `{word}`; choose one of: ope, tre, sre")]
    Unknown {
        /// The name as given.
        word: String,
    },
    /// The truth has no row that a tracker can start on.
    #[error("the ground truth has no usable box in its first row; a tracker cannot start there")]
    NoFirstBox,
    /// Too few frames with a box for twenty starts.
    #[error("only {frames} frames have a usable box, and a run of TRE has at least {least}; use --protocol ope", least = temporal::SHORTEST)]
    TooShort {
        /// Frames with a usable box.
        frames: usize,
    },
}

/// The starts of a protocol on a sequence. `frame_size` is the frame's width and height in pixels, to which SRE
/// clips its boxes, by the rules of `shift_rules`; TRE starts on none of the rows of `hidden`.
///
/// # Errors
/// [`ProtocolError`] if the truth has no box to start on, or too few for TRE.
pub fn segments(
    protocol: Protocol,
    truth: &[Rect],
    hidden: &[RangeInclusive<usize>],
    frame_size: (usize, usize),
    shift_rules: ShiftRules,
) -> Result<Vec<Segment>, ProtocolError> {
    let usable = |start: usize| truth.get(start).copied().filter(Rect::is_proper);
    let segment = |(index, (label, start)): (usize, (Option<String>, usize))| {
        let true_box = usable(start).ok_or(ProtocolError::NoFirstBox)?;
        let first_box = match protocol {
            Protocol::Sre => SHIFTS[index].apply(true_box, frame_size, shift_rules),
            Protocol::Ope | Protocol::Tre => true_box,
        };
        Ok(Segment { label, start, first_box })
    };
    starts_of(protocol, truth, hidden)?.into_iter().enumerate().map(segment).collect()
}

/// The label of each segment of a protocol and the row of the truth, counted from 0, where it starts: what scoring
/// needs.
///
/// # Errors
/// [`ProtocolError::TooShort`].
pub fn starts_of(
    protocol: Protocol,
    truth: &[Rect],
    hidden: &[RangeInclusive<usize>],
) -> Result<Vec<(Option<String>, usize)>, ProtocolError> {
    let numbered = |(index, start): (usize, usize)| (Some(format!("{:02}", index + 1)), start);
    Ok(match protocol {
        Protocol::Ope => vec![(None, 0)],
        Protocol::Tre => starts(truth, hidden)?.into_iter().enumerate().map(numbered).collect(),
        Protocol::Sre => SHIFTS.iter().map(|shift| (Some(shift.name().to_owned()), 0)).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn protocols_are_named_in_any_case_and_refused_with_a_list() {
        assert_eq!("TRE".parse(), Ok(Protocol::Tre));
        let message = "vot".parse::<Protocol>().unwrap_err().to_string();
        assert!(message.contains("`vot`") && message.contains("ope, tre, sre"), "{message}");
    }

    #[test]
    fn one_pass_starts_on_the_first_box_and_needs_one() {
        let truth = [Rect::new(3.0, 4.0, 5.0, 6.0); 2];
        let segments = segments(Protocol::Ope, &truth, &[], (20, 20), ShiftRules::Matlab).unwrap();
        assert_eq!(segments, [Segment { label: None, start: 0, first_box: truth[0] }]);
        let absent = [Rect::new(f64::NAN, 0.0, 0.0, 0.0)];
        assert_eq!(
            super::segments(Protocol::Sre, &absent, &[], (20, 20), ShiftRules::Matlab),
            Err(ProtocolError::NoFirstBox)
        );
    }
}
