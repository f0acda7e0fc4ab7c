//! Archives that the servers of GOT-10k and TrackingNet take for results on their test sets.
//!
//! | server | in the archive | rows |
//! |---|---|---|
//! | GOT-10k | `SEQ/SEQ_001.txt`, up to three repetitions, and `SEQ/SEQ_time.txt`, a column a repetition | `x,y,w,h`, 4 decimals |
//! | TrackingNet | `SEQ.txt` | `x,y,w,h`, 2 decimals |
//!
//! An archive is made only if it is whole: every sequence with a row a frame, all of them boxes.

use std::{
    fmt::Write as _,
    io::{Cursor, Write as _},
    str::FromStr,
};

use infopart::{geometry::Rect, sequence::Benchmark};
use thiserror::Error;
use zip::{CompressionMethod, ZipWriter, result::ZipError, write::SimpleFileOptions};

use crate::{
    dataset::{Dataset, Target},
    results::{ResultsError, SeedResults, TrackerResults},
};

/// Repetitions that GOT-10k's server takes.
const REPETITIONS: usize = 3;

/// Whose server.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Server {
    /// GOT-10k's.
    Got10k,
    /// TrackingNet's.
    TrackingNet,
}

impl Server {
    /// The name in flags.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Got10k => "got10k",
            Self::TrackingNet => "trackingnet",
        }
    }

    /// The server of a benchmark, if it has one that is known here.
    pub const fn of(benchmark: Option<Benchmark>) -> Option<Self> {
        match benchmark {
            Some(Benchmark::Got10k) => Some(Self::Got10k),
            Some(Benchmark::TrackingNet) => Some(Self::TrackingNet),
            _ => None,
        }
    }

    /// Sequences of its test set.
    pub const fn sequences(self) -> usize {
        match self {
            Self::Got10k => 180,
            Self::TrackingNet => 511,
        }
    }
}

impl FromStr for Server {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let all = [Self::Got10k, Self::TrackingNet];
        let found = all.into_iter().find(|server| server.name().eq_ignore_ascii_case(word));
        found.ok_or_else(|| "give got10k or trackingnet".to_owned())
    }
}

/// What keeps an archive from being whole.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SubmissionProblem {
    /// No result.
    #[error("{sequence}: no result (seed {seed}); run the tracker on it")]
    Missing {
        /// The sequence.
        sequence: String,
        /// The seed.
        seed: u64,
    },
    /// A result that cannot be read.
    #[error(transparent)]
    Unreadable(#[from] ResultsError),
    /// Not a row a frame.
    #[error(
        "{sequence}: the result has {rows} rows and the sequence {frames} frames; run the tracker on it again"
    )]
    Length {
        /// The sequence.
        sequence: String,
        /// Rows of the result.
        rows: usize,
        /// Frames.
        frames: usize,
    },
    /// A row that is no box.
    #[error("{sequence}: row {row} is no box, which the server refuses; write the last box there")]
    NoBox {
        /// The sequence.
        sequence: String,
        /// The row, counted from 1.
        row: usize,
    },
    /// No times, or not one a frame.
    #[error(
        "{sequence}: the server wants the seconds of each frame, which are not there for all; run the tracker with `otb_eval run`, or put SEQ_time.txt beside the result"
    )]
    Times {
        /// The sequence.
        sequence: String,
    },
    /// The archive cannot be made.
    #[error("the archive cannot be made: {0}")]
    Archive(#[from] ZipError),
}

/// The bytes of the archive, or everything that keeps it from being whole.
///
/// # Errors
/// All [`SubmissionProblem`]s.
pub fn archive(
    server: Server,
    dataset: &Dataset,
    tracker: &TrackerResults,
) -> Result<Vec<u8>, Vec<SubmissionProblem>> {
    let (mut files, mut problems) = (Vec::new(), Vec::new());
    let seeds = match server {
        Server::Got10k => &tracker.seeds[..tracker.seeds.len().min(REPETITIONS)],
        Server::TrackingNet => &tracker.seeds[..tracker.seeds.len().min(1)],
    };
    for target in &dataset.targets {
        match files_of(server, target, seeds) {
            Ok(of_target) => files.extend(of_target),
            Err(problem) => problems.push(problem),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    zipped(&files).map_err(|error| vec![error.into()])
}

type File = (String, String);

fn files_of(server: Server, target: &Target, seeds: &[SeedResults]) -> Result<Vec<File>, SubmissionProblem> {
    let name = &target.name;
    let (mut files, mut times) = (Vec::new(), Vec::new());
    for (place, seed) in seeds.iter().enumerate() {
        let rows = rows_of(target, seed)?;
        match server {
            Server::TrackingNet => files.push((format!("{name}.txt"), text_of(&rows, 2))),
            Server::Got10k => {
                files.push((format!("{name}/{name}_{:03}.txt", place + 1), text_of(&rows, 4)));
                let seconds = seed.read_seconds(name, None).transpose()?.unwrap_or_default();
                if seconds.len() != rows.len() {
                    return Err(SubmissionProblem::Times { sequence: name.clone() });
                }
                times.push(seconds);
            }
        }
    }
    if server == Server::Got10k {
        let frames = times.first().map_or(0, Vec::len);
        let line = |frame: usize| {
            let columns: Vec<String> = times.iter().map(|column| format!("{:.8}", column[frame])).collect();
            columns.join(",") + "\n"
        };
        files.push((format!("{name}/{name}_time.txt"), (0..frames).map(line).collect()));
    }
    Ok(files)
}

fn rows_of(target: &Target, seed: &SeedResults) -> Result<Vec<Rect>, SubmissionProblem> {
    let sequence = || target.name.clone();
    let missing = || SubmissionProblem::Missing { sequence: sequence(), seed: seed.seed };
    let mut file = seed.read(&target.name, None).ok_or_else(missing)??;
    if file.first_is_given
        && let (Some(first), Some(given)) = (file.rows.first_mut(), target.truth.first())
    {
        *first = *given;
    }
    let (rows, frames) = (file.rows.len(), target.truth.len());
    if rows != frames {
        return Err(SubmissionProblem::Length { sequence: sequence(), rows, frames });
    }
    match file.rows.iter().position(|row| !row.is_proper()) {
        Some(index) => Err(SubmissionProblem::NoBox { sequence: sequence(), row: index + 1 }),
        None => Ok(file.rows),
    }
}

fn text_of(rows: &[Rect], decimals: usize) -> String {
    let mut text = String::new();
    for Rect { x, y, w, h } in rows {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{x:.decimals$},{y:.decimals$},{w:.decimals$},{h:.decimals$}");
    }
    text
}

/// The same files give the same bytes: nothing in it says when it was made.
fn zipped(files: &[File]) -> Result<Vec<u8>, ZipError> {
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in files {
        archive.start_file(name.as_str(), options)?;
        archive.write_all(text.as_bytes())?;
    }
    Ok(archive.finish()?.into_inner())
}
