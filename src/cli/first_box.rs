//! The first box: where it comes from, and what is said if the tracker refuses it, in the user's own numbers.

use anyhow::Result;
use infopart::{
    geometry::{Origin, Rect},
    program::BadInput,
    run::{RunError, RunFailure},
    sequence::Sequence,
    tracker::TrackError,
};

/// The target's box in the first frame.
pub struct FirstBox {
    pub in_frame: Rect,
    /// With the input's origin.
    pub as_given: Rect,
    origin: Origin,
    /// The flag, or the file and its row.
    given_in: String,
}

impl FirstBox {
    /// The box of --init, or else the ground truth's.
    pub fn find(init: Option<Rect>, input: &str, sequence: &Sequence) -> Result<Self> {
        let origin = sequence.origin;
        if let Some(as_given) = init {
            let in_frame = origin.to_frame(as_given);
            return Ok(Self { in_frame, as_given, origin, given_in: "--init".to_owned() });
        }
        let Some(first) = sequence.ground_truth.first() else {
            return Err(missing(input, "there is no ground truth to take the first box from", ""));
        };
        let in_frame = first.ok_or_else(|| {
            let or_later = ", or begin at a later frame with --start N";
            missing(input, "the ground truth has no box in the first frame", or_later)
        })?;
        let given_in = match &sequence.ground_truth_row {
            Some((path, row)) => format!("{}, row {row}:", path.display()),
            None => format!("{input}, ground truth:"),
        };
        Ok(Self { in_frame, as_given: as_in_file(origin, in_frame), origin, given_in })
    }

    /// What to tell if the run ended because the tracker refused this box; `None` if it ended for another reason.
    pub fn refusal(&self, error: &RunError) -> Option<BadInput> {
        let RunFailure::Track { frame, source } = &*error.failure else { return None };
        if error.frames_done > 0 {
            return None;
        }
        let Rect { x, y, w, h } = self.as_given;
        let given = format!("{} {x},{y},{w},{h}", self.given_in);
        match source {
            TrackError::BoxOutside { width, height, .. } => {
                let first = if self.origin == Origin::One { 1 } else { 0 };
                Some(BadInput(format!(
                    "{given}: the box has no pixel inside the {width}x{height} {frame}, whose first pixel is \
                     {first},{first} (--origin {first}); give a box that touches the frame"
                )))
            }
            TrackError::BadBox { .. } => Some(BadInput(format!(
                "{given}: the box cannot be tracked in {frame}; give finite numbers of at most 1e9 and a positive \
                 width and height"
            ))),
            _ => None,
        }
    }
}

fn missing(input: &str, problem: &str, other_remedy: &str) -> anyhow::Error {
    BadInput(format!(
        "{input}: {problem}; give the target's box in the first frame with --init X,Y,W,H{other_remedy}"
    ))
    .into()
}

/// The box as the ground truth's file has it. Subtracting the origin and adding it again costs a last digit; the
/// nearest short decimal that means the same box gives it back.
fn as_in_file(origin: Origin, in_frame: Rect) -> Rect {
    let written = origin.from_frame(in_frame);
    let short = |value: f64| (value * 1e9).round() / 1e9;
    let rounded = Rect { x: short(written.x), y: short(written.y), ..written };
    if origin.to_frame(rounded) == in_frame { rounded } else { written }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_truth_with_fractions_comes_back_as_it_was_written() {
        for value in [0.1, 205.0, 0.7, 198.39, 1.0 / 3.0] {
            let in_frame = Origin::One.to_frame(Rect::new(value, value, 5.0, 6.0));
            let back = as_in_file(Origin::One, in_frame);
            assert!((back.x - value).abs() < 1e-12);
            if value != 1.0 / 3.0 {
                assert_eq!((back.x, back.y), (value, value));
            }
        }
    }
}
