//! OTB folders on disk.

use std::{
    fs,
    path::{Path, PathBuf},
};

use infopart::sequence::{OtbTarget, otb_targets, read_boxes};

use super::{DatasetError, FrameFolder, Target};
use crate::catalogue;

/// The targets of a sequence's folder, or of every such folder in a folder.
pub(super) fn read(path: &Path, problems: &mut Vec<DatasetError>) -> Result<Vec<Target>, DatasetError> {
    let own = targets_of(path, problems);
    if !own.is_empty() {
        return Ok(own);
    }
    let found: Vec<Target> =
        subfolders(path)?.iter().flat_map(|folder| targets_of(folder, problems)).collect();
    if found.is_empty() && problems.is_empty() {
        return Err(DatasetError::NoSequences { path: path.to_owned(), deeper: deeper(path) });
    }
    Ok(found)
}

/// Folders in a folder that hold sequences, where it holds none itself: it is one level too high.
fn deeper(path: &Path) -> Vec<PathBuf> {
    let holds = |folder: &PathBuf| {
        let sequences = subfolders(folder).unwrap_or_default();
        sequences.iter().any(|sequence| otb_targets(sequence).is_ok_and(|targets| !targets.is_empty()))
    };
    subfolders(path).unwrap_or_default().into_iter().filter(holds).collect()
}

/// Sorted, so that the order does not depend on the file system.
fn subfolders(path: &Path) -> Result<Vec<PathBuf>, DatasetError> {
    let io_error = |source| DatasetError::Io { path: path.to_owned(), source };
    let mut folders = Vec::new();
    for entry in fs::read_dir(path).map_err(io_error)? {
        let entry = entry.map_err(io_error)?.path();
        if entry.is_dir() {
            folders.push(entry);
        }
    }
    folders.sort();
    Ok(folders)
}

fn targets_of(folder: &Path, problems: &mut Vec<DatasetError>) -> Vec<Target> {
    let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy().into_owned();
    let mut targets = Vec::new();
    match otb_targets(folder) {
        Err(source) => problems.push(DatasetError::Sequence { name, source }),
        Ok(found) => {
            for one in found {
                match read_boxes(&one.ground_truth) {
                    Ok(truth) => targets.push(target(folder, one, truth)),
                    Err(source) => problems.push(DatasetError::Sequence { name: one.name, source }),
                }
            }
        }
    }
    targets
}

fn target(folder: &Path, found: OtbTarget, mut truth: Vec<infopart::geometry::Rect>) -> Target {
    let known = catalogue::find(&found.name);
    let omitted = cut(known, &mut truth);
    Target {
        name: known.map_or(found.name, |known| known.name.to_owned()),
        truth,
        hidden: Vec::new(),
        frames: Some(FrameFolder { path: folder.to_owned(), target: found.number, first_frame: omitted + 1 }),
    }
}

/// The benchmark leaves out the first frames of Tiger1; a truth that still has their rows is cut here, and their number
/// given.
pub(super) fn cut(known: Option<&catalogue::Known>, truth: &mut Vec<infopart::geometry::Rect>) -> usize {
    let omitted = known.map_or(0, |known| truth.len().saturating_sub(known.rows).min(known.omitted_frames()));
    truth.drain(..omitted);
    omitted
}
