//! Step 2: folders that mean to be sequences and give no target.

use std::{
    fs,
    path::{Path, PathBuf},
};

use infopart::sequence::{benchmark_sequences, otb_targets};

use super::file_name;

/// Whether a folder has something of a sequence.
pub(super) fn is_sequence(folder: &Path) -> bool {
    folder.join("img").is_dir() || !annotations(folder).is_empty()
}

/// The ground truth files of a folder, empty ones among them, sorted.
pub(super) fn annotations(folder: &Path) -> Vec<PathBuf> {
    let is_annotation = |path: &PathBuf| {
        let name = file_name(path);
        name.starts_with("groundtruth_rect") && name.ends_with(".txt")
    };
    entries(folder).into_iter().filter(is_annotation).collect()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// What is wrong with the folder, or with those in it, that give no target.
pub(super) fn without_targets(path: &Path) -> Vec<String> {
    if is_sequence(path) {
        return without_target(path).into_iter().collect();
    }
    entries(path)
        .iter()
        .filter(|folder| folder.is_dir() && is_sequence(folder))
        .filter_map(|folder| without_target(folder))
        .collect()
}

fn without_target(folder: &Path) -> Option<String> {
    // One that cannot be read is told by whoever reads it.
    let is_known = otb_targets(folder).map_or(true, |targets| !targets.is_empty())
        || benchmark_sequences(folder).map_or(true, |found| !found.is_empty());
    if is_known {
        return None;
    }
    let at = folder.display();
    Some(if !folder.join("img").is_dir() {
        format!("{at}: ground truth but no images; put the frames into {at}/img")
    } else if annotations(folder).is_empty() {
        format!("{at}: images but no ground truth; add groundtruth_rect.txt, a row x,y,w,h a frame")
    } else {
        format!("{at}: the ground truth is empty; write a row x,y,w,h a frame into groundtruth_rect.txt")
    })
}
