//! Whether a job's result is there and whole.

use std::{fs, io, path::Path};

use super::{ResultFile, file::seconds_beside};
use crate::{runner::Job, store::Record};

/// What there is of a job's result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Kept {
    /// Nothing.
    Absent,
    /// All of it.
    Whole,
    /// A file that is not the job's result; why not.
    Damaged(String),
}

/// Looks at all that there is of a job's result in a folder of results: that its boxes are rows of numbers, as many as the job has
/// frames, the first of them the box given, that the file is the one that was written, and that the times are as many.
pub fn kept(root: &Path, job: &Job) -> Kept {
    let path = root.join(job.result_path());
    match fs::metadata(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Kept::Absent,
        Err(error) => return Kept::Damaged(format!("it cannot be read: {error}")),
        Ok(_) => {}
    }
    match damage(&path, job) {
        None => Kept::Whole,
        Some(damage) => Kept::Damaged(damage),
    }
}

fn damage(path: &Path, job: &Job) -> Option<String> {
    let file = match ResultFile::read(path) {
        Ok(file) => file,
        Err(error) => return Some(error.to_string()),
    };
    if file.rows.len() != job.frames {
        return Some(format!("it has {} rows, not {}", file.rows.len(), job.frames));
    }
    if file.rows.first() != Some(&job.segment.first_box) {
        return Some("its first row is not the box that the tracker is given".to_owned());
    }
    if file.start.is_some_and(|start| start != job.segment.start) {
        return Some("its run starts on another frame".to_owned());
    }
    // Without a record nothing but the end of the last line tells that it was not cut in its last number.
    let is_recorded = Record::beside(path).is_ok_and(|record| record.is_some());
    if !is_recorded && !fs::read(path).is_ok_and(|bytes| bytes.ends_with(b"\n")) {
        return Some("its last line has no end".to_owned());
    }
    match seconds_beside(path) {
        Ok(Some(seconds)) if seconds.len() != job.frames => {
            Some(format!("there are {} times, not {}", seconds.len(), job.frames))
        }
        Ok(_) => None,
        Err(error) => Some(error.to_string()),
    }
}
