//! The folder of results: `RESULTS/PROTOCOL/TRACKER/seed_S/SEQ[_SEGMENT].txt`, times and a record beside, and `run.json`.

mod identity;
mod record;
mod whole;

use std::{
    fmt::Write as _,
    fs, io,
    path::{Path, PathBuf},
};

use thiserror::Error;

use crate::runner::{Conversation, Job, Recording};

pub use identity::{Identity, Machine};
pub use record::Record;
pub use whole::{remove_stale, write_whole};

/// Results that cannot be kept or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The file system refused.
    #[error("{path}: {source}; choose another folder, or make room", path = path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// Results of something else are there.
    #[error("{path}: the results there are of {what}; give another folder with --out, or remove that one", path = path.display())]
    OtherRun {
        /// The tracker's folder.
        path: PathBuf,
        /// In what they differ.
        what: String,
    },
    /// `run.json` is not what this program writes.
    #[error("{path}: {problem}; remove that folder, or give another", path = path.display())]
    BadRunFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// What stands beside a result is not what this program writes.
    #[error("{path}: is no record of a result; remove it and the result beside it, and make the result again", path = path.display())]
    BadRecord {
        /// The file.
        path: PathBuf,
    },
}

/// The folder of results.
#[derive(Debug, Clone)]
pub struct Store {
    root: PathBuf,
}

impl Store {
    /// The store in a folder, which need not exist yet.
    pub fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    /// Where it is.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Makes a tracker's folder its own: writes `run.json` where there is none, and checks it where there is one. What a
    /// killed run left half-written is removed.
    ///
    /// # Errors
    /// [`StoreError::OtherRun`] if results of other parameters, another version or other rules are there.
    pub fn claim(&self, identity: &Identity, machine: &Machine) -> Result<(), StoreError> {
        let folder = self.root.join(identity.protocol.name()).join(&identity.tracker);
        whole::create_folders(&folder).map_err(|source| StoreError::Io { path: folder.clone(), source })?;
        remove_stale(&folder).map_err(|source| StoreError::Io { path: folder.clone(), source })?;
        identity.claim(&folder, machine)
    }

    /// Keeps a job's boxes, times, confidences and record, the boxes last, since they say that the job is done.
    ///
    /// # Errors
    /// [`StoreError::Io`].
    pub fn keep(&self, job: &Job, recording: &Recording) -> Result<(), StoreError> {
        let (mut rows, mut seconds, mut confidences) = (String::new(), String::new(), String::new());
        for row in &recording.rows {
            // Writing to a String cannot fail.
            let _ = writeln!(rows, "{},{},{},{}", row.x, row.y, row.w, row.h);
        }
        for second in &recording.seconds {
            let _ = writeln!(seconds, "{second:.8}");
        }
        for confidence in &recording.confidences {
            let _ = writeln!(confidences, "{confidence}");
        }
        let record = Record::new(rows.as_bytes(), recording.rows.len(), Some(job.segment.start));
        self.write(&job.time_path(), &seconds)?;
        if let Some(Conversation { round_trips, lost_frames }) = &recording.external {
            let is_own = *round_trips != recording.seconds;
            let times = if is_own { "the tracker's own" } else { "round trips" };
            let text = serde_json::json!({
                "times": times, "lost_frames": lost_frames, "round_trip_seconds": round_trips,
            });
            self.write(&job.external_path(), &format!("{text}\n"))?;
        }
        if !confidences.is_empty() {
            self.write(&job.confidence_path(), &confidences)?;
        }
        self.write(&Record::path(&job.result_path()), &record.text())?;
        self.write(&job.result_path(), &rows)?;
        self.forget_failure(job)
    }

    /// Records that a job failed. The next run tries it again.
    ///
    /// # Errors
    /// [`StoreError::Io`].
    pub fn keep_failure(&self, job: &Job, reason: &str) -> Result<(), StoreError> {
        let text = format!("{}\n", serde_json::json!({ "job": job.id(), "reason": reason }));
        self.write(&job.failure_path(), &text)
    }

    fn forget_failure(&self, job: &Job) -> Result<(), StoreError> {
        let path = self.root.join(job.failure_path());
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => Err(StoreError::Io { path, source }),
            _ => Ok(()),
        }
    }

    fn write(&self, relative: &Path, text: &str) -> Result<(), StoreError> {
        let path = self.root.join(relative);
        write_whole(&path, text.as_bytes()).map_err(|source| StoreError::Io { path, source })
    }
}

#[cfg(test)]
mod tests;
