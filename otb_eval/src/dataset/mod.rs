//! The truth that results are compared with: sequences on disk, of OTB or another benchmark, or the boxes of a JSON file.
//!
//! Boxes stay as they stand in the files, the first pixel being 1 and odd rows among them: no toolkit converts
//! them, and each has rules of its own for rows that are no boxes.

mod folder;
mod frames;
mod json;
mod roots;

use std::{
    collections::HashSet,
    ops::RangeInclusive,
    path::{Path, PathBuf},
};

use infopart::{
    geometry::Rect,
    sequence::{Benchmark, PolygonBox, SequenceError},
};
use thiserror::Error;

pub use frames::{FrameFiles, FrameFolder};

use crate::{
    catalogue,
    protocol::{HiddenFrames, Protocol, ProtocolError, starts_of},
    words::of_sequence,
};

/// A target whose true boxes are known.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The benchmark's name for it (`Jogging-1`), or the folder's own.
    pub name: String,
    /// The true boxes, a row a frame, as they stand in the file.
    pub truth: Vec<Rect>,
    /// Rows of the truth, counted from 0, on which the target is hidden, so that TRE starts on none of them.
    pub hidden: Vec<RangeInclusive<usize>>,
    /// Where its frames are; `None` if only its boxes are known.
    pub frames: Option<FrameFolder>,
    /// What its benchmark says of its frames besides the boxes.
    pub annotations: Annotations,
}

/// What a benchmark says of a target's frames besides its boxes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Annotations {
    /// The benchmark; `None` for OTB's layout and JSON files.
    pub benchmark: Option<Benchmark>,
    /// Whether the target is absent, for each row; empty if nothing of the kind is said.
    pub absent: Vec<bool>,
    /// GOT-10k's visible eighths, for each row; empty elsewhere.
    pub cover: Vec<u8>,
    /// Width and height of the frames, where the benchmark says them.
    pub resolution: Option<(usize, usize)>,
    /// Whether only the first box is known, since a server keeps the others: nothing can be scored here.
    pub first_only: bool,
}

/// Targets in the order of their discovery.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Dataset {
    /// The targets, no two of one name.
    pub targets: Vec<Target>,
}

/// Truth that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DatasetError {
    /// Nothing at a path.
    #[error("{path}: no such file or folder; give a data set's folder, one sequence, or OTB100.json", path = path.display())]
    Missing {
        /// The path as given.
        path: PathBuf,
    },
    /// A folder without sequences.
    #[error("{path}: no sequence there that is laid out as OTB's (img/ and groundtruth_rect.txt), UAV123's, LaSOT's, GOT-10k's, TrackingNet's, NfS's, VOT's, TLD's or TC128's are{}", deeper_ones(deeper), path = path.display())]
    NoSequences {
        /// The path as given.
        path: PathBuf,
        /// Folders in it that hold sequences.
        deeper: Vec<PathBuf>,
    },
    /// A file or folder that cannot be read.
    #[error("{path}: cannot be read: {source}; check its permissions", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A sequence that cannot be read; the others are.
    #[error("{name}: {}", of_sequence(source))]
    Sequence {
        /// The folder's name.
        name: String,
        /// What is wrong, and what to do.
        source: SequenceError,
    },
    /// A list that names sequences which are not there.
    #[error("{list}: {} of the sequences that it names are not there: {}; add them, or choose others with --sequences", names.len(), few(names), list = list.display())]
    Unlisted {
        /// The list.
        list: PathBuf,
        /// What is not there.
        names: Vec<String>,
    },
    /// A JSON file that is not a list of sequences.
    #[error("{path}: {problem}; give a JSON object of NAME: {{\"gt_rect\": [[x,y,w,h], ...]}}, as OTB100.json is", path = path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// Two targets of one name.
    #[error("{name}: found twice, the second time in {path}; give only one of them", path = path.display())]
    Twice {
        /// The target.
        name: String,
        /// Where it was found again.
        path: PathBuf,
    },
}

/// The first few names, and how many more there are.
fn few(names: &[String]) -> String {
    const NAMED: usize = 3;
    let named = names.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(NAMED) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

fn deeper_ones(folders: &[PathBuf]) -> String {
    let names: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!(". There are some in {}: give those", names.join(", "))
    }
}

impl Dataset {
    /// Reads folders of sequences, single ones and JSON files of boxes; VOT's polygons become boxes by their smallest and largest
    /// coordinates. Sequences that cannot be read are left out and told beside the others.
    ///
    /// # Errors
    /// [`DatasetError`] if a path itself is of no use.
    pub fn open(paths: &[PathBuf]) -> Result<(Self, Vec<DatasetError>), DatasetError> {
        Self::open_with(paths, PolygonBox::default())
    }

    /// As [`open`](Self::open), with another rule for VOT's polygons.
    ///
    /// # Errors
    /// [`DatasetError`] if a path itself is of no use.
    pub fn open_with(
        paths: &[PathBuf],
        polygons: PolygonBox,
    ) -> Result<(Self, Vec<DatasetError>), DatasetError> {
        let (mut dataset, mut problems, mut names) = (Self::default(), Vec::new(), HashSet::new());
        for path in paths {
            for target in read(path, polygons, &mut problems)? {
                if names.insert(target.name.clone()) {
                    dataset.targets.push(target);
                } else {
                    problems.push(DatasetError::Twice { name: target.name, path: path.clone() });
                }
            }
        }
        dataset.hide(&HiddenFrames::default());
        Ok((dataset, problems))
    }

    /// With these lists of hidden frames instead of the benchmark's.
    pub fn hide(&mut self, lists: &HiddenFrames) {
        self.targets.iter_mut().for_each(|target| target.hidden = lists.rows(&target.name));
    }

    /// The benchmark that all targets are of, if they are of one that has rules of its own.
    pub fn benchmark(&self) -> Option<Benchmark> {
        let first = self.targets.first()?.annotations.benchmark?;
        self.targets.iter().all(|target| target.annotations.benchmark == Some(first)).then_some(first)
    }

    /// The target of that name.
    pub fn target(&self, name: &str) -> Option<&Target> {
        self.targets.iter().find(|target| target.name == name)
    }
}

impl Target {
    /// Takes from a result the rows of frames that the benchmark leaves out (the first five of Tiger1), where it has them
    /// and the truth has not, and gives their number: got10k and VOT track all 354 frames, the benchmark 349.
    pub fn align(&self, rows: &mut Vec<Rect>) -> usize {
        let omitted = catalogue::find(&self.name).map_or(0, catalogue::Known::omitted_frames);
        if omitted == 0 || rows.len() != self.truth.len() + omitted {
            return 0;
        }
        rows.drain(..omitted);
        omitted
    }

    /// The label of each segment of a protocol and the row of the truth, counted from 0, where it starts.
    ///
    /// # Errors
    /// [`ProtocolError::TooShort`].
    pub fn starts(&self, protocol: Protocol) -> Result<Vec<(Option<String>, usize)>, ProtocolError> {
        starts_of(protocol, &self.truth, &self.hidden)
    }
}

fn read(
    path: &Path,
    polygons: PolygonBox,
    problems: &mut Vec<DatasetError>,
) -> Result<Vec<Target>, DatasetError> {
    let is_annotation = path.extension().is_some_and(|extension| extension == "txt");
    if path.is_dir() || (is_annotation && path.is_file()) {
        folder::read(path, polygons, problems)
    } else if path.is_file() {
        json::read(path)
    } else {
        Err(DatasetError::Missing { path: path.to_owned() })
    }
}

#[cfg(test)]
mod tests;
