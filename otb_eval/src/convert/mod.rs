//! Results in the layouts of other toolkits, read and written.
//!
//! Steps:
//! 1. read a layout into tracks: one tracker's boxes on one segment of one sequence,
//! 2. write the tracks in another layout, the sequences in its spelling.
//!
//! Boxes keep every digit in every layout: the toolkits write fewer, but all of them read floating-point numbers.

mod jwlim;
mod text;

use std::{
    fmt, io,
    path::{Path, PathBuf},
    str::FromStr,
};

use infopart::geometry::Rect;
use thiserror::Error;

use crate::{
    catalogue::{self, Dialect},
    protocol::Protocol,
    results::ResultsError,
};

/// How results lie in folders and files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// `PROTOCOL/TRACKER/seed_S/SEQ[_SEGMENT].txt`, as `otb_eval run` writes, with times, confidences and a record of each.
    Run,
    /// `TRACKER/SEQ.txt` with `SEQ_time.txt` and `SEQ_confidence.txt` beside.
    Flat,
    /// `TRACKER/SEQ.txt`, commas, no times.
    Pysot,
    /// `OTB2015/TRACKER/SEQ.txt`, commas, with `times/SEQ_time.txt`.
    Got10k,
    /// `TRACKER/SEQ/SEQ_00K.txt`, as the GOT-10k toolkit has them for GOT-10k itself, with `SEQ/SEQ_time.txt`.
    Got10kSet,
    /// `TRACKER/PARAM[_RRR]/SEQ.txt`, tabs, with `SEQ_time.txt` and `SEQ_object_presence_scores.txt` beside.
    Pytracking,
    /// `OPE/TRACKER/SEQ.json`, and `TRE`, `SRE`: a list of segments with frames per second.
    Jwlim,
}

impl Layout {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Run, Self::Flat, Self::Pysot, Self::Got10k, Self::Got10kSet, Self::Pytracking, Self::Jwlim];

    /// The name in flags.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Flat => "flat",
            Self::Pysot => "pysot",
            Self::Got10k => "got10k",
            Self::Got10kSet => "got10k-set",
            Self::Pytracking => "pytracking",
            Self::Jwlim => "jwlim",
        }
    }

    /// Whether it has a place for TRE and SRE.
    pub const fn has_segments(self) -> bool {
        matches!(self, Self::Run | Self::Jwlim)
    }

    /// What it looks like.
    const fn shape(self) -> &'static str {
        match self {
            Self::Run => "PROTOCOL/TRACKER/seed_S/SEQ.txt",
            Self::Flat | Self::Pysot => "TRACKER/SEQ.txt",
            Self::Got10k => "OTB2015/TRACKER/SEQ.txt",
            Self::Got10kSet => "TRACKER/SEQ/SEQ_001.txt",
            Self::Pytracking => "TRACKER/PARAM/SEQ.txt",
            Self::Jwlim => "OPE/TRACKER/SEQ.json",
        }
    }

    fn spelled(self, sequence: &str) -> String {
        let dialect = match self {
            Self::Got10k => Dialect::Got10k,
            Self::Pytracking => Dialect::Pytracking,
            _ => Dialect::Benchmark,
        };
        catalogue::find(sequence).map_or_else(|| sequence.to_owned(), |known| known.spelling(dialect))
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Layout {
    type Err = ConvertError;

    fn from_str(word: &str) -> Result<Self, ConvertError> {
        Self::ALL
            .into_iter()
            .find(|layout| layout.name().eq_ignore_ascii_case(word))
            .ok_or_else(|| ConvertError::Unknown { word: word.to_owned() })
    }
}

impl ConvertError {
    /// Whether it is only worth knowing, and nothing is left out.
    pub fn is_note(&self) -> bool {
        matches!(self, Self::Read { .. })
    }
}

/// One tracker's result on one segment of one sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The tracker.
    pub tracker: String,
    /// The protocol.
    pub protocol: Protocol,
    /// The seed; 0 where the layout knows none.
    pub seed: u64,
    /// The sequence, in the benchmark's spelling if it is one of TB-100.
    pub sequence: String,
    /// Nothing in OPE, `01` to `20` in TRE, the shift's name in SRE.
    pub label: Option<String>,
    /// The row of the truth, counted from 0, that a run of TRE starts on, if the layout tells.
    pub start: Option<usize>,
    /// A row a frame, as they stand in the file.
    pub rows: Vec<Rect>,
    /// The seconds of each frame, if they are known; from a layout that knows frames per second alone, their mean.
    pub seconds: Option<Vec<f64>>,
    /// How sure the tracker was in each frame, if that is known; NaN where nothing is said.
    pub confidences: Option<Vec<f64>>,
}

/// Results that cannot be converted.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// No such layout.
    #[error("there is no layout `{word}`; choose one of: {}", Layout::ALL.map(Layout::name).join(", "))]
    Unknown {
        /// The name as given.
        word: String,
    },
    /// Nothing in that layout.
    #[error("{path}: no results there in the layout of {layout}, {shape}; give the folder that holds them, or another --from", path = path.display(), shape = layout.shape())]
    Nothing {
        /// The path as given.
        path: PathBuf,
        /// The layout.
        layout: Layout,
    },
    /// Results that cannot be read.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A file that is not in its layout.
    #[error("{path}: {problem}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// A file that was read, and is not as its layout has it.
    #[error("{path}: read with {how}", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What was understood.
        how: String,
    },
    /// A protocol that the layout has no place for.
    #[error(
        "the layout of {layout} has no place for {protocol}; convert to run or jwlim, or only the others with --protocol ope"
    )]
    NoPlace {
        /// The layout.
        layout: Layout,
        /// The protocol.
        protocol: Protocol,
    },
    /// A tracker whose folder is there already.
    #[error("{path}: is there already; remove it, or choose another folder to write to", path = path.display())]
    Exists {
        /// The tracker's folder.
        path: PathBuf,
    },
    /// The file system refused.
    #[error("{path}: {source}; choose another folder, or make room", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// Step 1: the tracks of a layout, and what could not be read of it.
///
/// # Errors
/// [`ConvertError`] if there is nothing in that layout.
pub fn read(layout: Layout, path: &Path) -> Result<(Vec<Track>, Vec<ConvertError>), ConvertError> {
    let mut problems = Vec::new();
    let tracks = match layout {
        Layout::Jwlim => jwlim::read(path, &mut problems)?,
        _ => text::read(layout, path, &mut problems)?,
    };
    if tracks.is_empty() && problems.is_empty() {
        return Err(ConvertError::Nothing { path: path.to_owned(), layout });
    }
    Ok((tracks, problems))
}

/// Step 2: writes tracks in a layout, every file whole, and gives the number of files with boxes. Where a layout knows
/// no seeds, a tracker with several becomes several trackers, `TRACKER_seed_S`.
///
/// # Errors
/// [`ConvertError::NoPlace`], [`ConvertError::Exists`], both before anything is written; [`ConvertError::Io`].
pub fn write(layout: Layout, path: &Path, tracks: &[Track]) -> Result<usize, ConvertError> {
    if let Some(track) = tracks.iter().find(|track| track.protocol != Protocol::Ope && !layout.has_segments())
    {
        return Err(ConvertError::NoPlace { layout, protocol: track.protocol });
    }
    let files = match layout {
        Layout::Jwlim => jwlim::files(tracks),
        _ => text::files(layout, tracks),
    };
    for file in &files {
        let folder = path.join(&file.tracker_folder);
        if folder.exists() {
            return Err(ConvertError::Exists { path: folder });
        }
    }
    for file in &files {
        let at = path.join(&file.path);
        crate::store::write_whole(&at, file.text.as_bytes())
            .map_err(|source| ConvertError::Io { path: at, source })?;
    }
    Ok(files.iter().filter(|file| file.has_boxes).count())
}

/// A file to write, its paths below the folder of results.
struct OutputFile {
    tracker_folder: PathBuf,
    path: PathBuf,
    text: String,
    has_boxes: bool,
}

/// The tracker's name in a layout that knows no seeds.
fn name_with_seed(track: &Track, tracks: &[Track]) -> String {
    let is_other = |other: &Track| other.tracker == track.tracker && other.seed != track.seed;
    if tracks.iter().any(is_other) {
        format!("{}_seed_{}", track.tracker, track.seed)
    } else {
        track.tracker.clone()
    }
}

/// The benchmark's name for a sequence in any toolkit's spelling, or its own.
fn in_the_benchmarks_spelling(name: &str) -> String {
    catalogue::find(name).map_or_else(|| name.to_owned(), |known| known.name.to_owned())
}

#[cfg(test)]
mod tests;
