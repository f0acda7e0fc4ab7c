//! What can be wrong with a MOTChallenge file.

use std::{io, path::PathBuf};

use thiserror::Error;

/// A file that cannot be used; the message names it and says what to do.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MotError {
    /// The file cannot be read.
    #[error("{path}: cannot be read: {source}; check the path and its permissions", path = path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A row cannot be used.
    #[error("{path}, line {line}: {problem}", path = path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// The row, counted from 1.
        line: usize,
        /// What is wrong with it.
        problem: RowProblem,
    },
    /// There is no row that counts.
    #[error("{path}: {what}", path = path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What is missing, and the remedy.
        what: &'static str,
    },
    /// Ground truth and results do not fit together.
    #[error("{path}: {what}", path = path.display())]
    Sequences {
        /// The file or folder.
        path: PathBuf,
        /// What is missing, and the remedy.
        what: String,
    },
}

/// What is wrong with a row, and what to do.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RowProblem {
    /// Too few fields.
    #[error("{found} fields where {needed} are needed; a row is FRAME,ID,X,Y,WIDTH,HEIGHT,CONFIDENCE,...")]
    TooFewFields {
        /// Fields in the row.
        found: usize,
        /// Fields needed.
        needed: usize,
    },
    /// A field is not a finite number.
    #[error("{field} is {text:?}, not a finite number; correct or remove the row")]
    NotANumber {
        /// The field's name.
        field: &'static str,
        /// What stands there.
        text: String,
    },
    /// A frame number that counts nothing.
    #[error("frame {text} is not a whole number from 1 on; MOTChallenge counts frames from 1")]
    Frame {
        /// What stands there.
        text: String,
    },
    /// An identity that names nothing.
    #[error(
        "identity {text} is not a whole number from 0 on; a file of tracks needs one in every row (detections have -1)"
    )]
    Identity {
        /// What stands there.
        text: String,
    },
    /// A box without area.
    #[error(
        "a box of {width} x {height} has no area; width and height must be above 0 (is the row X1,Y1,X2,Y2?)"
    )]
    Size {
        /// Its width.
        width: f64,
        /// Its height.
        height: f64,
    },
    /// A box that no picture holds.
    #[error(
        "a box of {width:?} x {height:?} at {x:?}, {y:?} fits no picture: coordinates must be within 10 million pixels and the area above 0; \
         correct or remove the row"
    )]
    Absurd {
        /// Its left edge.
        x: f64,
        /// Its top edge.
        y: f64,
        /// Its width.
        width: f64,
        /// Its height.
        height: f64,
    },
    /// An identity that is in two places at once.
    #[error(
        "identity {identity} is already in frame {frame}, at line {first_line}; remove one of the two rows"
    )]
    DuplicateIdentity {
        /// The identity.
        identity: u64,
        /// The frame.
        frame: u32,
        /// The line of the first.
        first_line: usize,
    },
    /// A frame that the sequence does not have.
    #[error("frame {frame} is beyond the {length} frames that seqinfo.ini gives; correct one of the two")]
    Beyond {
        /// The frame.
        frame: u32,
        /// Frames of the sequence.
        length: u32,
    },
    /// A frame number that goes back.
    #[error("frame {frame} comes after frame {previous}; put the rows in order: sort -s -t, -n -k1,1 FILE")]
    OutOfOrder {
        /// The frame.
        frame: u32,
        /// The frame of the row before.
        previous: u32,
    },
}
