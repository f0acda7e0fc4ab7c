//! Reads what trackers reported: the layout that `run` writes, and the flat `RESULTS/TRACKER/SEQ.txt` that others use.

mod file;
mod index;
mod kept;
mod rows;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use thiserror::Error;

use crate::{
    protocol::Protocol,
    runner::stem,
    store::{Identity, Machine, Record, StoreError},
    words::printable,
};

pub use file::{ResultFile, Separators};
pub(crate) use index::listed_as;
pub use kept::{Kept, kept};

/// Results that cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// Nothing at a path.
    #[error("{path}: no such folder; give the folder of results, RESULTS/TRACKER/SEQ.txt or what `otb_eval run` wrote", path = path.display())]
    Missing {
        /// The path as given.
        path: PathBuf,
    },
    /// A folder without results.
    #[error("{path}: no results there; they are RESULTS/TRACKER/SEQ.txt or what `otb_eval run` wrote{}", deeper_ones(deeper), path = path.display())]
    Nothing {
        /// The path as given.
        path: PathBuf,
        /// Folders in it that hold results.
        deeper: Vec<PathBuf>,
    },
    /// No results of a protocol.
    #[error("{path}: no results of {protocol} there, but of: {there}; choose one with --protocol", path = path.display())]
    NoProtocol {
        /// The path as given.
        path: PathBuf,
        /// The protocol asked for.
        protocol: Protocol,
        /// The protocols that are there.
        there: String,
    },
    /// No such tracker.
    #[error("there are no results of the tracker `{name}`, but of: {there}; check the spelling")]
    NoTracker {
        /// The tracker asked for.
        name: String,
        /// The trackers that are there.
        there: String,
    },
    /// The file system refused.
    #[error("{path}: cannot be read: {source}; check its permissions", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A row that is no box.
    #[error("{path}, line {line}: `{}` {problem}; write x,y,w,h there", printable(text), path = path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The line as it stands, or its beginning.
        text: String,
        /// What is wrong with it.
        problem: String,
    },
    /// A file without rows.
    #[error("{path}: the file is empty; run the tracker on the sequence again, or remove the file", path = path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A file that is not the one that was written.
    #[error("{path}: it is not the file that was written, by its checksum in {record}; make the result again, or remove that record if the change is meant", path = path.display(), record = record.display())]
    Altered {
        /// The file.
        path: PathBuf,
        /// The record beside it.
        record: PathBuf,
    },
    /// A line of times that is no number.
    #[error("{path}, line {line}: `{}` is no time; write the seconds of a frame a line", printable(text), path = path.display())]
    Time {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The line as it stands.
        text: String,
    },
    /// A line of confidences that is no number.
    #[error("{path}, line {line}: `{}` is no confidence; write a number a line", printable(text), path = path.display())]
    Confidence {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The line as it stands.
        text: String,
    },
    /// `run.json` cannot be read.
    #[error(transparent)]
    Run(#[from] StoreError),
}

fn deeper_ones(folders: &[PathBuf]) -> String {
    let names: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!(". There are some in {}: give that folder", names.join(", "))
    }
}

/// All results in a folder.
#[derive(Debug, Clone, Default)]
pub struct Results {
    /// Trackers in the order of their names.
    pub trackers: Vec<TrackerResults>,
}

/// One tracker's results under one protocol.
#[derive(Debug, Clone)]
pub struct TrackerResults {
    /// The tracker's name.
    pub name: String,
    /// What made them, if `run` did.
    pub run: Option<(Identity, Machine)>,
    /// Its seeds in ascending order; one of number 0 in the flat layout.
    pub seeds: Vec<SeedResults>,
}

/// The results of one seed.
#[derive(Debug, Clone)]
pub struct SeedResults {
    /// The seed; 0 in the flat layout, which knows none.
    pub seed: u64,
    /// Result files by the stem `SEQ[_SEGMENT]`, the sequence in the benchmark's spelling.
    files: BTreeMap<String, Listed>,
    /// Failed jobs by stem, with the reason.
    failures: BTreeMap<String, String>,
}

/// A result file and what the folder has beside it.
#[derive(Debug, Clone)]
struct Listed {
    path: PathBuf,
    has_record: bool,
    /// The file of seconds, and which of its columns.
    times: Option<(PathBuf, usize)>,
    confidences: Option<PathBuf>,
}

impl Results {
    /// Finds the results of a protocol. The flat layout holds one-pass results.
    ///
    /// # Errors
    /// [`ResultsError`] if there are none.
    pub fn open(path: &Path, protocol: Protocol) -> Result<Self, ResultsError> {
        index::results_in(path, protocol)
    }

    /// The protocols of which there are results, [`Protocol::Ope`] alone in the flat layout.
    ///
    /// # Errors
    /// [`ResultsError::Missing`].
    pub fn protocols(path: &Path) -> Result<Vec<Protocol>, ResultsError> {
        index::protocols_in(path)
    }

    /// Folders of flat results, `TRACKER/SEQ.txt`, beside those of `run`, which are left alone; none in the flat layout.
    ///
    /// # Errors
    /// [`ResultsError`] if the folder cannot be read.
    pub fn ignored(path: &Path) -> Result<Vec<String>, ResultsError> {
        index::ignored_in(path)
    }

    /// Folders in a folder that hold results themselves: where nothing in it fits the data, it is one level too high.
    pub fn deeper(path: &Path) -> Vec<PathBuf> {
        index::deeper(path)
    }

    /// With exactly the trackers of these names, in this order: one that has no results has no seeds.
    pub fn with_trackers(mut self, names: &[String]) -> Self {
        let mut trackers = Vec::new();
        for name in names {
            let there = self.trackers.iter().position(|tracker| tracker.name == *name);
            trackers.push(match there {
                Some(position) => self.trackers.remove(position),
                None => TrackerResults { name: name.clone(), run: None, seeds: Vec::new() },
            });
        }
        Self { trackers }
    }

    /// Keeps only the trackers of these names, in this order.
    ///
    /// # Errors
    /// [`ResultsError::NoTracker`].
    pub fn only(mut self, names: &[String]) -> Result<Self, ResultsError> {
        let mut trackers = Vec::new();
        for name in names {
            match self.trackers.iter().position(|tracker| tracker.name == *name) {
                Some(position) => trackers.push(self.trackers.remove(position)),
                None => {
                    let there = self.trackers.iter().chain(&trackers).map(|tracker| tracker.name.as_str());
                    let mut there: Vec<&str> = there.collect();
                    there.sort_unstable();
                    let there = there.join(", ");
                    return Err(ResultsError::NoTracker { name: name.clone(), there });
                }
            }
        }
        Ok(Self { trackers })
    }
}

impl SeedResults {
    /// Reads the result of a sequence's segment; `None` if there is none.
    ///
    /// # Errors
    /// [`ResultsError`], naming the file and line.
    pub fn read(&self, sequence: &str, label: Option<&str>) -> Option<Result<ResultFile, ResultsError>> {
        let read = |Listed { path, has_record, .. }: &Listed| {
            let record = if *has_record { Record::beside(path)? } else { None };
            ResultFile::with_record(path, record)
        };
        self.files.get(&listed_as(&stem(sequence, label))).map(read)
    }

    /// Reads the seconds that each frame of a segment took, `init` first; `None` if that is not known.
    ///
    /// # Errors
    /// [`ResultsError`], naming the file and line.
    pub fn read_seconds(
        &self,
        sequence: &str,
        label: Option<&str>,
    ) -> Option<Result<Vec<f64>, ResultsError>> {
        let (path, column) = self.files.get(&listed_as(&stem(sequence, label)))?.times.as_ref()?;
        Some(file::read_seconds(path, *column))
    }

    /// Reads how sure the tracker was in each frame of a segment; `None` if that is not known. A NaN is a frame of which nothing is
    /// said.
    ///
    /// # Errors
    /// [`ResultsError`], naming the file and line.
    pub fn read_confidences(
        &self,
        sequence: &str,
        label: Option<&str>,
    ) -> Option<Result<Vec<f64>, ResultsError>> {
        let path = self.files.get(&listed_as(&stem(sequence, label)))?.confidences.as_ref()?;
        Some(file::read_confidences(path))
    }

    /// Stems `SEQ[_SEGMENT]` of all results.
    pub fn stems(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// The labels `01`, `02`, ... of the segments of a sequence that there are results of.
    pub fn numbers<'a>(&'a self, sequence: &'a str) -> impl Iterator<Item = &'a str> {
        self.files.keys().filter_map(move |stem| {
            let label = stem.strip_prefix(sequence)?.strip_prefix('_')?;
            (label.len() == 2 && label.bytes().all(|byte| byte.is_ascii_digit())).then_some(label)
        })
    }

    /// Jobs that failed, by stem, with the reason.
    pub fn failures(&self) -> impl Iterator<Item = (&str, &str)> {
        self.failures.iter().map(|(stem, reason)| (stem.as_str(), reason.as_str()))
    }
}

#[cfg(test)]
mod tests;
