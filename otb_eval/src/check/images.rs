//! Step 3: the images of a folder.

use std::{
    collections::HashMap,
    path::{Path, PathBuf},
};

use infopart::sequence::{SequenceError, decode_image, probe_image};
use rayon::prelude::*;
use serde::Serialize;

use super::{Finding, file_name};
use crate::{
    catalogue,
    dataset::{FrameFiles, FrameFolder, Target},
    words::of_sequence,
};

/// Damaged images that are named; of more only the number is told.
const NAMED: usize = 5;

/// The images of a target's folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ImageSummary {
    /// Images in the folder.
    pub count: usize,
    /// The file of the first frame of the ground truth.
    pub first: Option<String>,
    /// The file of its last frame.
    pub last: Option<String>,
    /// Width and height of the first image, pixels.
    pub size: Option<(usize, usize)>,
}

/// Images looked through so far: targets may share a folder.
pub(super) struct Images {
    decode: bool,
    probed: HashMap<PathBuf, Vec<Probe>>,
}

type Probe = Result<(usize, usize), String>;

impl Images {
    pub(super) fn new(decode: bool) -> Self {
        Self { decode, probed: HashMap::new() }
    }

    pub(super) fn summary(
        &mut self,
        target: &Target,
        frames: &FrameFolder,
        findings: &mut Vec<Finding>,
    ) -> ImageSummary {
        let omitted = frames.first_frame - 1;
        let rows = target.truth.len() + omitted;
        let nothing = ImageSummary { count: 0, first: None, last: None, size: None };
        let (all, covered) = match frames.files(rows) {
            Ok(FrameFiles::Images { all, covered }) => (all, covered),
            Ok(FrameFiles::Video(video)) => {
                let text =
                    format!("its frames are in a video, {}, which is not looked through", file_name(&video));
                findings.push(Finding::oddity(text));
                return nothing;
            }
            Err(error) => {
                findings.push(Finding::damage(of_sequence(&error)));
                return nothing;
            }
        };
        let folder = all.first().and_then(|image| image.parent()).map_or(frames.path.clone(), Path::to_owned);
        let probes = self.probed(&folder, &all);
        let size = probes.iter().find_map(|probe| probe.as_ref().ok().copied());
        damaged(&all, probes, size, findings);
        counts(&target.name, rows, &all, &covered, findings);
        gaps(&covered, findings);
        let used = covered.get(omitted..rows.min(covered.len())).unwrap_or_default();
        let name = |path: Option<&PathBuf>| path.map(|path| file_name(path));
        ImageSummary { count: all.len(), first: name(used.first()), last: name(used.last()), size }
    }

    fn probed(&mut self, folder: &Path, images: &[PathBuf]) -> &[Probe] {
        let decode = self.decode;
        let told = |error: SequenceError| match error {
            SequenceError::BadImage { reason, .. } => reason,
            other => of_sequence(&other),
        };
        let probe = |path: &PathBuf| {
            if decode {
                decode_image(path).map(|frame| (frame.width(), frame.height())).map_err(told)
            } else {
                probe_image(path).map_err(told)
            }
        };
        self.probed.entry(folder.to_owned()).or_insert_with(|| images.par_iter().map(probe).collect())
    }
}

fn damaged(images: &[PathBuf], probes: &[Probe], size: Option<(usize, usize)>, findings: &mut Vec<Finding>) {
    let mut bad = Vec::new();
    for (path, probe) in images.iter().zip(probes) {
        match probe {
            Err(reason) => bad.push(format!("{}: cannot be decoded: {reason}", path.display())),
            Ok(found) if Some(*found) != size => bad.push(format!(
                "{}: {}x{} instead of {}",
                path.display(),
                found.0,
                found.1,
                size.map_or_else(String::new, |(width, height)| format!("{width}x{height}"))
            )),
            Ok(_) => {}
        }
    }
    let more = bad.len().saturating_sub(NAMED);
    findings.extend(bad.into_iter().take(NAMED).map(|text| Finding::damage(text + "; replace the file")));
    if more > 0 {
        findings.push(Finding::damage(format!("{more} more images like these")));
    }
}

/// Step 4, frames against rows.
fn counts(name: &str, rows: usize, all: &[PathBuf], covered: &[PathBuf], findings: &mut Vec<Finding>) {
    let (images, numbers) = (all.len(), numbers_of(covered));
    if covered.len() < images {
        findings.push(Finding::oddity(format!(
            "{images} images but {rows} rows: the rows are of frames {}",
            range(&numbers)
        )));
    } else if rows > images {
        findings.push(Finding::damage(format!(
            "{rows} rows but {images} images; add the missing images, or remove the rows that have none"
        )));
    } else if rows < images {
        findings.push(Finding::damage(format!(
            "{images} images but {rows} rows, which are taken to be of the first {rows}; remove the other images, or \
             write NaN,NaN,NaN,NaN where the target is absent"
        )));
    } else if let Some(known) = catalogue::find(name)
        && let Some(&first) = numbers.first()
        && known.first_frame - known.omitted_frames() != first
    {
        findings.push(Finding::oddity(format!(
            "its frames begin at {first}, not at {} as the benchmark's do: a trimmed or renumbered copy",
            known.first_frame - known.omitted_frames()
        )));
    } else if numbers.first().is_some_and(|&first| first > 1) {
        findings.push(Finding::oddity(format!("the rows are of frames {}", range(&numbers))));
    }
}

fn gaps(covered: &[PathBuf], findings: &mut Vec<Finding>) {
    let numbers = numbers_of(covered);
    let gap = numbers.windows(2).find(|pair| pair[1] != pair[0] + 1);
    if let Some(pair) = gap {
        let text = format!("the numbers of its images jump from {} to {}", pair[0], pair[1]);
        findings.push(Finding::oddity(text));
    }
}

/// The numbers in the images' names; nothing if one has none.
fn numbers_of(images: &[PathBuf]) -> Vec<usize> {
    let number = |path: &PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let digits = stem.trim_start_matches(|letter: char| !letter.is_ascii_digit());
        digits.parse::<usize>().ok()
    };
    images.iter().map(number).collect::<Option<Vec<usize>>>().unwrap_or_default()
}

fn range(numbers: &[usize]) -> String {
    match (numbers.first(), numbers.last()) {
        (Some(first), Some(last)) => format!("{first} to {last}"),
        _ => "without numbers".to_owned(),
    }
}
