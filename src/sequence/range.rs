//! The frames that --start and --end leave.

use std::ops::Range;

use super::{OpenOptions, SequenceError};

/// The first and last frame to deliver, counted from 1 and checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FrameRange {
    pub(super) start: usize,
    pub(super) end: Option<usize>,
}

impl FrameRange {
    pub(super) fn of(options: &OpenOptions) -> Result<Self, SequenceError> {
        let start = options.start.unwrap_or(1);
        if start == 0 {
            return Err(SequenceError::FrameZero { flag: "--start" });
        }
        match options.end {
            Some(0) => Err(SequenceError::FrameZero { flag: "--end" }),
            Some(end) if end < start => Err(SequenceError::EndBeforeStart { start, end }),
            end => Ok(Self { start, end }),
        }
    }

    /// The positions (from 0) of the wanted among `frames` frames; an end behind the last frame means the last.
    pub(super) fn positions(self, frames: usize, input: &str) -> Result<Range<usize>, SequenceError> {
        if self.start > frames {
            return Err(SequenceError::StartBeyondEnd { input: input.to_owned(), start: self.start, frames });
        }
        Ok(self.start - 1..self.end.map_or(frames, |end| end.min(frames)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(start: Option<usize>, end: Option<usize>) -> Result<FrameRange, SequenceError> {
        FrameRange::of(&OpenOptions { start, end, ..OpenOptions::default() })
    }

    #[test]
    fn both_ends_are_counted_from_one_and_included() {
        assert_eq!(range(None, None).unwrap().positions(5, "x").unwrap(), 0..5);
        assert_eq!(range(Some(2), Some(4)).unwrap().positions(5, "x").unwrap(), 1..4);
        assert_eq!(range(Some(5), Some(9)).unwrap().positions(5, "x").unwrap(), 4..5);
    }

    #[test]
    fn impossible_ranges_name_their_flag() {
        assert!(range(Some(0), None).unwrap_err().to_string().starts_with("--start 0"));
        assert!(range(None, Some(0)).unwrap_err().to_string().starts_with("--end 0"));
        assert!(range(Some(3), Some(2)).unwrap_err().to_string().contains("--end 2 lies before --start 3"));
        let beyond = range(Some(6), None).unwrap().positions(5, "seq").unwrap_err().to_string();
        assert!(beyond.contains("--start 6: seq has only 5 frames"), "{beyond}");
    }
}
