//! What is in data, and what is odd about it: for whoever wants to know before a run, or why numbers differ.
//!
//! Steps, for each path given:
//! 1. read its targets as every command does; what cannot be read is damage,
//! 2. look for folders that mean to be sequences and give no target,
//! 3. look through the images of each folder once, in parallel,
//! 4. compare rows with images, rows with the catalogue, and labels with what the boxes say.

mod attributes;
mod folder;
mod images;
mod names;
mod truth;

use std::{
    collections::{BTreeMap, HashSet},
    path::{Path, PathBuf},
};

use serde::Serialize;

use crate::{
    catalogue::SequenceList,
    dataset::{Dataset, DatasetError, Target},
};

pub use attributes::{Measured, measure};
pub use images::ImageSummary;

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing; every command copes with it.
    Oddity,
    /// The data is broken: put it right before a run.
    Damage,
}

/// Something found in a target's data.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// What it is, and for damage what to do.
    pub text: String,
}

impl Finding {
    fn oddity(text: impl Into<String>) -> Self {
        Self { severity: Severity::Oddity, text: text.into() }
    }

    fn damage(text: impl Into<String>) -> Self {
        Self { severity: Severity::Damage, text: text.into() }
    }
}

/// A target and what was found.
#[derive(Debug, Clone, Serialize)]
pub struct CheckedTarget {
    /// The benchmark's name for it, or the folder's own.
    pub name: String,
    /// Its folder or file of ground truth; `None` if only its boxes are known.
    pub folder: Option<PathBuf>,
    /// Which of the folder's targets, if they are numbered.
    pub target: Option<usize>,
    /// Rows of ground truth that count.
    pub rows: usize,
    /// Its images; `None` if only its boxes are known.
    pub images: Option<ImageSummary>,
    /// How the rows are written: what separates numbers, and line ends.
    pub written: Option<String>,
    /// The named lists that it is in.
    pub lists: Vec<&'static str>,
    /// Its name in each toolkit, if it is one of TB-100.
    pub spellings: BTreeMap<&'static str, String>,
    /// Its attributes in each source, if it is one of TB-100.
    pub attributes: BTreeMap<&'static str, String>,
    /// What the boxes say of three attributes; `None` without two usable boxes.
    pub measured: Option<Measured>,
    /// What was found.
    pub findings: Vec<Finding>,
}

/// How much of a named list is there.
#[derive(Debug, Clone, Serialize)]
pub struct ListCoverage {
    /// The list.
    pub list: &'static str,
    /// Its sequences.
    pub sequences: usize,
    /// Those that are not there.
    pub missing: Vec<&'static str>,
}

/// Everything found.
#[derive(Debug, Clone, Serialize)]
pub struct CheckReport {
    /// The targets, in the order of the data.
    pub targets: Vec<CheckedTarget>,
    /// The named lists of which something is there.
    pub lists: Vec<ListCoverage>,
    /// Paths, folders and files that give no target.
    pub unreadable: Vec<String>,
}

impl CheckReport {
    /// Damage, each with the target it was found in.
    pub fn damage(&self) -> impl Iterator<Item = (&str, &str)> {
        self.targets.iter().flat_map(|target| {
            let damaged = target.findings.iter().filter(|finding| finding.severity == Severity::Damage);
            damaged.map(|finding| (target.name.as_str(), finding.text.as_str()))
        })
    }
}

/// Checks folders of OTB sequences, single ones, and JSON files of boxes. With `decode`, every image is decoded; else
/// only headers are read and cut files found. `progress` is told the number of targets done, of all, before each.
pub fn check(paths: &[PathBuf], decode: bool, mut progress: impl FnMut(usize, usize)) -> CheckReport {
    let (mut targets, mut unreadable, mut names) = (Vec::new(), Vec::new(), HashSet::new());
    for path in paths {
        match Dataset::open(std::slice::from_ref(path)) {
            Err(DatasetError::NoSequences { .. }) if folder::is_sequence(path) => {}
            Err(error) => unreadable.push(error.to_string()),
            Ok((dataset, problems)) => {
                unreadable.extend(problems.iter().map(ToString::to_string));
                for target in dataset.targets {
                    if names.insert(target.name.clone()) {
                        targets.push(target);
                    } else {
                        let error = DatasetError::Twice { name: target.name, path: path.clone() };
                        unreadable.push(error.to_string());
                    }
                }
            }
        }
        unreadable.extend(folder::without_targets(path));
    }
    let mut images = images::Images::new(decode);
    let total = targets.len();
    let mut checked = Vec::new();
    for (done, target) in targets.iter().enumerate() {
        progress(done, total);
        checked.push(checked_target(target, &mut images));
    }
    CheckReport { lists: coverage(&names), targets: checked, unreadable }
}

fn checked_target(target: &Target, images: &mut images::Images) -> CheckedTarget {
    let mut findings = Vec::new();
    let frames = target.frames.as_ref();
    let written = frames.and_then(|frames| truth::written(frames, &mut findings));
    let summary = frames.map(|frames| images.summary(target, frames, &mut findings));
    truth::rows(target, summary.as_ref().map(|images| images.count), &mut findings);
    names::known(target, &mut findings);
    let measured = measure(&target.truth);
    attributes::contradictions(&target.name, measured.as_ref(), &mut findings);
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    CheckedTarget {
        name: target.name.clone(),
        folder: frames.map(|frames| frames.path.clone()),
        target: frames.and_then(|frames| frames.target),
        rows: target.truth.len(),
        images: summary,
        written,
        lists: names::lists(&target.name),
        spellings: names::spellings(&target.name),
        attributes: attributes::labels(&target.name),
        measured,
        findings,
    }
}

/// The lists of which some sequence is there.
fn coverage(names: &HashSet<String>) -> Vec<ListCoverage> {
    let of = |list: SequenceList| {
        let sequences = list.sequences();
        let missing: Vec<&str> = sequences.iter().copied().filter(|name| !names.contains(*name)).collect();
        (missing.len() < sequences.len()).then_some(ListCoverage {
            list: list.name(),
            sequences: sequences.len(),
            missing,
        })
    };
    SequenceList::ALL.into_iter().filter_map(of).collect()
}

/// A file's name, for messages.
fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests;
