//! Where the sequences of a data set's folder are: what `open` takes for each.
//!
//! 1. A list that the data set brings, `list.txt` or LaSOT's `testing_set.txt`, says which and in which order.
//! 2. Where the ground truth lies apart from the frames, its files are the sequences.
//! 3. Else every folder is one, and LaSOT's folders of a class hold folders of that name with a number.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use infopart::sequence::benchmark_sequences;

const LISTS: [&str; 2] = ["testing_set.txt", "list.txt"];

/// UAV20L has sequences of the names of UAV123's, over the same frames: its own folder of ground truth is given for it.
const ANOTHER_SET: &str = "UAV20L";

/// Sequences that a folder holds.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Inputs {
    pub(super) paths: Vec<PathBuf>,
    /// The list that is there, and what it names that is not.
    pub(super) unlisted: Option<(PathBuf, Vec<String>)>,
}

pub(super) fn inputs(path: &Path) -> io::Result<Inputs> {
    for name in LISTS {
        let list = path.join(name);
        if list.is_file() {
            let (paths, missing) = listed(path, &fs::read_to_string(&list)?);
            if !paths.is_empty() {
                return Ok(Inputs { paths, unlisted: (!missing.is_empty()).then_some((list, missing)) });
            }
        }
    }
    let apart = annotations_apart(path)?;
    if !apart.is_empty() {
        return Ok(Inputs { paths: apart, unlisted: None });
    }
    let mut paths = Vec::new();
    for folder in folders(path)? {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is_of_class = |folder: &PathBuf| {
            let numbered = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            numbered.strip_prefix(&name).is_some_and(|rest| rest.starts_with('-'))
        };
        paths.push(folder.clone());
        paths.extend(folders(&folder).unwrap_or_default().into_iter().filter(is_of_class));
    }
    Ok(Inputs { paths, unlisted: None })
}

/// Step 1: those that are there, and the names of the others.
fn listed(path: &Path, text: &str) -> (Vec<PathBuf>, Vec<String>) {
    let (mut paths, mut missing) = (Vec::new(), Vec::new());
    for name in text.lines().map(str::trim).filter(|name| !name.is_empty()) {
        let in_class = name.rsplit_once('-').map(|(class, _)| path.join(class).join(name));
        match [Some(path.join(name)), in_class].into_iter().flatten().find(|folder| folder.is_dir()) {
            Some(folder) => paths.push(folder),
            None => missing.push(name.to_owned()),
        }
    }
    (paths, missing)
}

/// Step 2.
fn annotations_apart(path: &Path) -> io::Result<Vec<PathBuf>> {
    let anno = path.join("anno");
    if path.join("data_seq").is_dir() && anno.is_dir() {
        let mut sets = folders(&anno)?;
        if sets.len() > 1 {
            sets.retain(|set| set.file_name().is_none_or(|name| name != ANOTHER_SET));
        }
        let mut files = Vec::new();
        for set in sets {
            files.extend(recognised(&set)?);
        }
        return Ok(files);
    }
    let has_frames = ["frames", "sequences"].iter().any(|frames| path.join(frames).is_dir());
    recognised(if has_frames && anno.is_dir() { &anno } else { path })
}

/// Files of a folder that are the ground truth of frames elsewhere.
fn recognised(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let is_truth = |file: &PathBuf| {
        file.extension().is_some_and(|extension| extension == "txt")
            && file.is_file()
            && benchmark_sequences(file).is_ok_and(|found| !found.is_empty())
    };
    Ok(entries(folder)?.into_iter().filter(is_truth).collect())
}

pub(super) fn folders(path: &Path) -> io::Result<Vec<PathBuf>> {
    Ok(entries(path)?.into_iter().filter(|entry| entry.is_dir()).collect())
}

/// Sorted, so that the order does not depend on the file system.
fn entries(path: &Path) -> io::Result<Vec<PathBuf>> {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(path)?.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<_>>()?;
    entries.sort();
    Ok(entries)
}
