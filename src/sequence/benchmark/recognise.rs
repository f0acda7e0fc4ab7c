//! What a folder or a file of ground truth is.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{
    super::{
        SequenceError,
        images::{file_name, folder_name, images_in},
        natural::number_in_name,
    },
    Benchmark, BenchmarkSequence, FramePlace,
};

/// Parts of folders that UAV123 counts as sequences: name, folder, first and last frame.
const UAV_PARTS: &str = include_str!("uav123.tsv");

const VIDEOS: [&str; 4] = ["mpg", "mpeg", "avi", "mp4"];

pub(super) fn sequences(path: &Path) -> Result<Vec<BenchmarkSequence>, SequenceError> {
    if path.is_file() {
        return Ok(of_annotation(path).into_iter().collect());
    }
    if !path.is_dir() {
        return Ok(Vec::new());
    }
    let whole = folder_of_everything(path)?;
    Ok(match whole {
        Some(whole) => vec![whole],
        None => with_annotation_apart(path)?,
    })
}

/// Folders that hold frames and ground truth.
fn folder_of_everything(path: &Path) -> Result<Option<BenchmarkSequence>, SequenceError> {
    let name = folder_name(path);
    let sequence = |benchmark, truth: PathBuf, frames| {
        let (name, input) = (name.clone(), path.to_owned());
        Some(BenchmarkSequence { benchmark, name, number: None, ground_truth: truth, frames, input })
    };
    let truth = path.join("groundtruth.txt");
    let images = path.join("img");
    if images.is_dir() {
        if truth.is_file() {
            return Ok(sequence(Benchmark::Lasot, truth, FramePlace::Folder(images)));
        }
        let own = entries(path)?.into_iter().find(|file| file_name(file).ends_with("_gt.txt"));
        return Ok(own.and_then(|truth| sequence(Benchmark::TempleColor, truth, FramePlace::Folder(images))));
    }
    if truth.is_file() {
        let colour = path.join("color");
        if colour.is_dir() {
            return Ok(sequence(Benchmark::Vot, truth, FramePlace::Folder(colour)));
        }
        if images_in(path)?.is_empty() {
            return Ok(None);
        }
        let benchmark = if is_vot(path, &truth)? { Benchmark::Vot } else { Benchmark::Got10k };
        return Ok(sequence(benchmark, truth, FramePlace::Folder(path.to_owned())));
    }
    let corners = path.join("gt.txt");
    if corners.is_file() {
        let is_video = |file: &PathBuf| {
            let extension = file.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
            VIDEOS.contains(&extension.as_str())
        };
        let frames = if images_in(path)?.is_empty() {
            entries(path)?.into_iter().find(is_video).map(FramePlace::Video)
        } else {
            Some(FramePlace::Folder(path.to_owned()))
        };
        return Ok(frames.and_then(|frames| sequence(Benchmark::Tld, corners, frames)));
    }
    let slow = path.join("30");
    let truth = slow.join(format!("{name}.txt"));
    let frames = slow.join(&name);
    if truth.is_file() && frames.is_dir() {
        return Ok(sequence(Benchmark::NeedForSpeed, truth, FramePlace::Folder(frames)));
    }
    Ok(None)
}

/// VOT has frames beside the ground truth too, but with a description, tags, or rows that are no boxes.
fn is_vot(path: &Path, truth: &Path) -> Result<bool, SequenceError> {
    if path.join("absence.label").is_file() || path.join("meta_info.ini").is_file() {
        return Ok(false);
    }
    if path.join("sequence").is_file() || entries(path)?.iter().any(|file| file_name(file).ends_with(".tag"))
    {
        return Ok(true);
    }
    let io_error = |source| SequenceError::Io { path: truth.to_owned(), source };
    let bytes = fs::read(truth).map_err(io_error)?;
    let text = String::from_utf8_lossy(&bytes);
    let first = text.lines().next().unwrap_or_default();
    Ok(first.starts_with('m') || first.split([',', '\t', ' ']).filter(|word| !word.is_empty()).count() > 4)
}

/// Folders of frames whose ground truth lies apart.
fn with_annotation_apart(path: &Path) -> Result<Vec<BenchmarkSequence>, SequenceError> {
    let Some(path) = std::path::absolute(path).ok().and_then(|path| path.canonicalize().ok()) else {
        return Ok(Vec::new());
    };
    let (Some(set), name) = (path.parent(), folder_name(&path)) else { return Ok(Vec::new()) };
    let above = |levels: usize| path.ancestors().nth(levels).map(Path::to_owned).unwrap_or_default();
    let beside = path.with_extension("txt");
    let candidates = [
        // NAME/30/NAME beside NAME/30/NAME.txt.
        beside,
        // sequences/NAME.
        above(2).join(format!("anno/nfs_{name}.txt")),
        // frames/NAME.
        above(2).join(format!("anno/{name}.txt")),
        // data_seq/SET/NAME.
        above(3).join("anno").join(folder_name(set)).join(format!("{name}.txt")),
    ];
    let is_of_these = |found: &BenchmarkSequence| matches!(&found.frames, FramePlace::Folder(folder) if folder.canonicalize().is_ok_and(|folder| folder == path));
    let there = candidates.iter().filter(|file| file.is_file());
    let found = there.filter_map(|file| of_annotation(file)).find(is_of_these);
    if let Some(found) = found {
        return Ok(vec![found]);
    }
    let annotations = above(3).join("anno").join(folder_name(set));
    if !annotations.is_dir() {
        return Ok(Vec::new());
    }
    let is_part = |file: &PathBuf| {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let number = stem.strip_prefix(&name).and_then(|rest| rest.strip_prefix('_'));
        number.is_some_and(|number| !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()))
    };
    Ok(entries(&annotations)?
        .iter()
        .filter(|file| is_part(file))
        .filter_map(|file| of_annotation(file))
        .collect())
}

/// What a file of ground truth that lies apart from its frames belongs to; `None` if there are no frames for it.
fn of_annotation(file: &Path) -> Option<BenchmarkSequence> {
    if file.extension().is_none_or(|extension| extension != "txt") {
        return None;
    }
    let resolved = file.canonicalize().ok()?;
    let stem = resolved.file_stem()?.to_str()?.to_owned();
    let folder = resolved.parent()?;
    let sequence = |benchmark, name: &str, number, frames: PathBuf| {
        let (ground_truth, input) = (file.to_owned(), file.to_owned());
        let frames = FramePlace::Folder(frames);
        frames_exist(&frames).then(|| BenchmarkSequence {
            benchmark,
            name: name.to_owned(),
            number,
            ground_truth,
            frames,
            input,
        })
    };
    // NAME/30/NAME.txt beside NAME/30/NAME/; rows of boxes there may be anybody's results on a folder of images.
    let beside = sequence(Benchmark::NeedForSpeed, &stem, None, folder.join(&stem));
    if let Some(found) = beside.filter(|_| has_track_rows(file)) {
        return Some(found);
    }
    let is_anno = |folder: &Path| folder.file_name().is_some_and(|name| name == "anno");
    if is_anno(folder) {
        let root = folder.parent()?;
        let name = stem.strip_prefix("nfs_").unwrap_or(&stem);
        return sequence(Benchmark::NeedForSpeed, name, None, root.join("sequences").join(name))
            .or_else(|| sequence(Benchmark::TrackingNet, &stem, None, root.join("frames").join(&stem)));
    }
    let anno = folder.parent().filter(|anno| is_anno(anno))?;
    let frames = anno.parent()?.join("data_seq");
    let sets = [folder_name(folder), "UAV123".to_owned(), "UAV123_10fps".to_owned()];
    let (base, number) = match stem.rsplit_once('_') {
        Some((base, digits)) => (base, digits.parse::<usize>().ok()),
        None => (stem.as_str(), None),
    };
    sets.iter().find_map(|set| {
        let whole = sequence(Benchmark::Uav, &stem, None, frames.join(set).join(&stem));
        whole.or_else(|| sequence(Benchmark::Uav, &stem, Some(number?), frames.join(set).join(base)))
    })
}

/// Whether a file's rows are those of Need for Speed at 240 frames a second.
pub(super) fn has_track_rows(file: &Path) -> bool {
    let text = fs::read(file).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    text.lines().next().is_some_and(|line| line.split_whitespace().count() >= 7)
}

fn frames_exist(frames: &FramePlace) -> bool {
    matches!(frames, FramePlace::Folder(folder) if folder.is_dir())
}

/// The place, counted from 0, of a sequence's first frame among the images of its folder.
pub(super) fn first_frame(sequence: &BenchmarkSequence, images: &[PathBuf]) -> Option<usize> {
    let number = match sequence.benchmark {
        Benchmark::Uav => first_of_part(sequence),
        Benchmark::TempleColor => first_of_range(sequence),
        _ => None,
    };
    let Some(number) = number else { return Some(0) };
    let is_first = |path: &PathBuf| {
        number_in_name(&path.file_stem().unwrap_or_default().to_string_lossy()) == Some(number)
    };
    images.iter().position(is_first)
}

/// The number of the frame that a part of a folder of UAV123 begins with; at 10 frames a second, every third frame is there.
fn first_of_part(sequence: &BenchmarkSequence) -> Option<usize> {
    let first = UAV_PARTS.lines().find_map(|line| {
        let [name, _, first, _] = line.split('\t').collect::<Vec<_>>()[..] else { return None };
        if name == sequence.name { first.parse::<usize>().ok() } else { None }
    })?;
    let FramePlace::Folder(folder) = &sequence.frames else { return None };
    let is_slow = folder.parent().is_some_and(|set| folder_name(set).contains("10fps"));
    Some(if is_slow { (first - 1) / 3 + 1 } else { first })
}

/// The first of the two numbers in Temple Color's `NAME_frames.txt`.
fn first_of_range(sequence: &BenchmarkSequence) -> Option<usize> {
    let name = file_name(&sequence.ground_truth).replace("_gt.txt", "_frames.txt");
    let text = fs::read_to_string(sequence.ground_truth.with_file_name(name)).ok()?;
    text.split(|letter: char| !letter.is_ascii_digit()).find_map(|number| number.parse().ok())
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, SequenceError> {
    let io_error = |source| SequenceError::Io { path: folder.to_owned(), source };
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(io_error)? {
        paths.push(entry.map_err(io_error)?.path());
    }
    paths.sort();
    Ok(paths)
}
