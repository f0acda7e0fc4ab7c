//! Sequences on disk, in OTB's layout or another benchmark's.

use std::path::{Path, PathBuf};

use infopart::{
    geometry::{Origin, Rect},
    sequence::{
        BenchmarkSequence, BenchmarkTruth, OtbTarget, PolygonBox, SequenceError, benchmark_sequences,
        otb_targets, read_boxes,
    },
};

use super::{
    Annotations, DatasetError, FrameFolder, Target,
    roots::{Inputs, folders, inputs},
};
use crate::catalogue;

/// The targets of one sequence, or of all sequences in a folder.
pub(super) fn read(
    path: &Path,
    polygons: PolygonBox,
    problems: &mut Vec<DatasetError>,
) -> Result<Vec<Target>, DatasetError> {
    let own = targets_of(path, polygons, problems);
    if !own.is_empty() {
        return Ok(own);
    }
    let io_error = |source| DatasetError::Io { path: path.to_owned(), source };
    let Inputs { paths, unlisted } = inputs(path).map_err(io_error)?;
    let found: Vec<Target> = paths.iter().flat_map(|input| targets_of(input, polygons, problems)).collect();
    if found.is_empty() && problems.is_empty() {
        return Err(DatasetError::NoSequences { path: path.to_owned(), deeper: deeper(path) });
    }
    if let Some((list, names)) = unlisted {
        problems.push(DatasetError::Unlisted { list, names });
    }
    Ok(found)
}

/// Folders in a folder that hold sequences, where it holds none itself: it is one level too high.
fn deeper(path: &Path) -> Vec<PathBuf> {
    let is_sequence = |input: &PathBuf| {
        otb_targets(input).is_ok_and(|targets| !targets.is_empty())
            || benchmark_sequences(input).is_ok_and(|found| !found.is_empty())
    };
    let holds = |folder: &PathBuf| inputs(folder).is_ok_and(|inputs| inputs.paths.iter().any(is_sequence));
    folders(path).unwrap_or_default().into_iter().filter(holds).collect()
}

fn targets_of(path: &Path, polygons: PolygonBox, problems: &mut Vec<DatasetError>) -> Vec<Target> {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let mut targets = Vec::new();
    let mut keep = |name: String, target: Result<Target, SequenceError>| match target {
        Ok(target) => targets.push(target),
        Err(source) => problems.push(DatasetError::Sequence { name, source }),
    };
    let of_otb = if path.is_dir() { otb_targets(path) } else { Ok(Vec::new()) };
    match of_otb {
        Err(source) => problems.push(DatasetError::Sequence { name, source }),
        Ok(found) if !found.is_empty() => {
            for one in found {
                let truth = read_boxes(&one.ground_truth);
                keep(one.name.clone(), truth.map(|truth| of_otb_folder(path, one, truth)));
            }
        }
        Ok(_) => match benchmark_sequences(path) {
            Err(source) => problems.push(DatasetError::Sequence { name, source }),
            Ok(found) => {
                for one in found {
                    let truth = one.truth(polygons);
                    keep(one.name.clone(), truth.map(|truth| of_benchmark(one, truth)));
                }
            }
        },
    }
    targets
}

fn of_otb_folder(folder: &Path, found: OtbTarget, mut truth: Vec<Rect>) -> Target {
    let known = catalogue::find(&found.name);
    let omitted = cut(known, &mut truth);
    Target {
        name: known.map_or(found.name, |known| known.name.to_owned()),
        truth,
        hidden: Vec::new(),
        frames: Some(FrameFolder {
            path: folder.to_owned(),
            target: found.number,
            first_frame: omitted + 1,
            origin: Origin::One,
            ground_truth: found.ground_truth,
        }),
        annotations: Annotations::default(),
    }
}

fn of_benchmark(found: BenchmarkSequence, truth: BenchmarkTruth) -> Target {
    Target {
        name: found.name,
        truth: truth.rows,
        hidden: Vec::new(),
        frames: Some(FrameFolder {
            path: found.input,
            target: found.number,
            first_frame: 1,
            origin: found.benchmark.origin(),
            ground_truth: found.ground_truth,
        }),
        annotations: Annotations {
            benchmark: Some(found.benchmark),
            absent: truth.absent,
            cover: truth.cover,
            resolution: truth.resolution,
            first_only: truth.first_only,
        },
    }
}

/// The benchmark leaves out the first frames of Tiger1; a truth that still has their rows is cut here, and their number
/// given.
pub(super) fn cut(known: Option<&catalogue::Known>, truth: &mut Vec<Rect>) -> usize {
    let omitted = known.map_or(0, |known| truth.len().saturating_sub(known.rows).min(known.omitted_frames()));
    truth.drain(..omitted);
    omitted
}
