//! What is known of TB-100 (Wu, Lim, Yang 2015): its 100 targets, their lists, attributes and names in every toolkit.

mod attribute;
mod lists;
mod spelling;
mod table;

use thiserror::Error;

pub use attribute::{Attribute, AttributeSet, AttributeSource};
pub use lists::{SequenceList, select};
pub use spelling::{Dialect, find};
pub use table::all;

/// A target of TB-100.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Known {
    /// The name in the benchmark's lists, such as `Jogging-1`.
    pub name: &'static str,
    /// The folder of its frames, such as `Jogging`.
    pub folder: &'static str,
    /// K of `groundtruth_rect.K.txt`; `None` for the plain `groundtruth_rect.txt`.
    pub target: Option<usize>,
    /// The number in the name of the first frame's file.
    pub first_frame: usize,
    /// The number in the name of the last frame's file.
    pub last_frame: usize,
    /// Digits of the numbers in the files' names.
    pub digits: usize,
    /// Rows of ground truth, a frame each.
    pub rows: usize,
    /// Whether it is in TB-50.
    pub in_tb50: bool,
    /// Whether it is among the 51 of the benchmark's first version.
    pub in_cvpr13: bool,
    /// Whether the target is a person.
    pub is_person: bool,
    in_tb100_txt: AttributeSet,
    in_json: AttributeSet,
}

impl Known {
    /// Its attributes as a source has them; on 14 targets the sources differ.
    pub fn attributes(&self, source: AttributeSource) -> AttributeSet {
        match source {
            AttributeSource::Tb100Txt => self.in_tb100_txt,
            AttributeSource::Json => self.in_json,
        }
    }

    /// Frames at the beginning of its folder that the benchmark leaves out although they have rows: five of Tiger1, of
    /// which some toolkits know nothing.
    pub fn omitted_frames(&self) -> usize {
        if self.name == "Tiger1" { 5 } else { 0 }
    }
}

/// A word that names nothing.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CatalogueError {
    /// No such attribute.
    #[error("there is no attribute `{word}`; choose from: {}", Attribute::ALL.map(Attribute::code).join(", "))]
    Attribute {
        /// The word as given.
        word: String,
    },
    /// No such source of attributes.
    #[error("there is no source of attributes `{word}`; choose one of: tb100, json")]
    Source {
        /// The word as given.
        word: String,
    },
    /// No such list.
    #[error("there is no list `{word}`; choose one of: {}", SequenceList::ALL.map(SequenceList::name).join(", "))]
    List {
        /// The word as given.
        word: String,
    },
    /// A list of sequences without any.
    #[error("`{words}` names no sequence; give names or lists, separated by commas")]
    NoSequence {
        /// The words as given.
        words: String,
    },
}

#[cfg(test)]
mod tests;
