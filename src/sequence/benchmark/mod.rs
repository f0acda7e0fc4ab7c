//! Single sequences in the layouts of the benchmarks that single-object trackers are evaluated on.
//!
//! A sequence is recognised by what its folder holds, never by a name. Where the ground truth lies apart from the frames, as in UAV123,
//! TrackingNet and Need for Speed, the file of the ground truth leads to the frames as well as they lead to it.
//!
//! | layout | frames | ground truth |
//! |---|---|---|
//! | OTB | `NAME/img/` | `NAME/groundtruth_rect[.K].txt` |
//! | Temple Color 128 | `NAME/img/`, of which `NAME_frames.txt` are meant | `NAME/NAME_gt.txt` |
//! | LaSOT | `NAME/img/` | `NAME/groundtruth.txt`, `full_occlusion.txt`, `out_of_view.txt` |
//! | GOT-10k | `NAME/` | `NAME/groundtruth.txt`, `absence.label`, `cover.label` |
//! | VOT | `NAME/color/` or `NAME/` | `NAME/groundtruth.txt`: boxes, polygons or masks |
//! | TLD | `NAME/`, or a video in it | `NAME/gt.txt`: corners |
//! | UAV123, UAV20L | `data_seq/SET/FOLDER/`, of which a range may be meant | `anno/SET/NAME.txt` |
//! | TrackingNet | `frames/NAME/` | `anno/NAME.txt` |
//! | Need for Speed | `sequences/NAME/`, or `NAME/30/NAME/` | `anno/nfs_NAME.txt`, or `NAME/30/NAME.txt` |

mod recognise;
mod rows;
mod truth;

use std::{
    ops::Range,
    path::{Path, PathBuf},
};

use super::{
    OpenOptions, Sequence, SequenceError,
    images::{ImageFiles, images_in},
    range::FrameRange,
    video::{VideoFile, VideoInput},
};
use crate::geometry::{Origin, Rect};

pub use rows::PolygonBox;

/// A benchmark whose sequences have a layout of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Benchmark {
    /// Temple Color 128.
    TempleColor,
    /// LaSOT.
    Lasot,
    /// GOT-10k.
    Got10k,
    /// VOT, short term and long term.
    Vot,
    /// TLD.
    Tld,
    /// UAV123, UAV123 at 10 frames a second, and UAV20L.
    Uav,
    /// TrackingNet.
    TrackingNet,
    /// Need for Speed.
    NeedForSpeed,
}

impl Benchmark {
    /// Its name.
    pub const fn title(self) -> &'static str {
        match self {
            Self::TempleColor => "Temple Color 128",
            Self::Lasot => "LaSOT",
            Self::Got10k => "GOT-10k",
            Self::Vot => "VOT",
            Self::Tld => "TLD",
            Self::Uav => "UAV123",
            Self::TrackingNet => "TrackingNet",
            Self::NeedForSpeed => "Need for Speed",
        }
    }

    /// The number of the first pixel in its boxes.
    pub const fn origin(self) -> Origin {
        match self {
            Self::TempleColor | Self::Lasot | Self::Uav => Origin::One,
            _ => Origin::Zero,
        }
    }
}

/// A sequence of a benchmark: where everything of it is. Its frames and rows are read when they are asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct BenchmarkSequence {
    /// The benchmark.
    pub benchmark: Benchmark,
    /// Its name, such as `person12_2`.
    pub name: String,
    /// K of `NAME_K`, if several of the same frames are told apart so.
    pub number: Option<usize>,
    /// The file of the ground truth.
    pub ground_truth: PathBuf,
    /// Where its frames are.
    pub frames: FramePlace,
    /// What [`open`](super::open) takes for it: its folder, or the file of the ground truth where that lies apart.
    pub input: PathBuf,
}

/// Where a sequence's frames are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FramePlace {
    /// Images of a folder.
    Folder(PathBuf),
    /// A video.
    Video(PathBuf),
}

/// What is known of a target in each frame.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct BenchmarkTruth {
    /// A row a frame as it stands in the file, as x, y, w, h; NaN in frames of which nothing is known.
    pub rows: Vec<Rect>,
    /// Whether the benchmark says that the target is absent there; empty if it says nothing of the kind.
    pub absent: Vec<bool>,
    /// GOT-10k's visible eighths of the target in each frame, 0 to 8; empty elsewhere.
    pub cover: Vec<u8>,
    /// Width and height of its frames as GOT-10k's `meta_info.ini` has them.
    pub resolution: Option<(usize, usize)>,
    /// Whether only the first box is known, as in test sets that a server keeps.
    pub first_only: bool,
}

/// The sequences of which a path is the folder, the frames, or the ground truth: several if they share frames; none if it is nothing
/// of the kind. OTB's folders are [`otb_targets`](super::otb_targets).
///
/// # Errors
/// [`SequenceError::Io`] if a folder cannot be read.
pub fn benchmark_sequences(path: &Path) -> Result<Vec<BenchmarkSequence>, SequenceError> {
    recognise::sequences(path)
}

impl BenchmarkSequence {
    /// All images of its folder, in the order of their numbers; none of a video.
    ///
    /// # Errors
    /// [`SequenceError::Io`].
    pub fn images(&self) -> Result<Vec<PathBuf>, SequenceError> {
        match &self.frames {
            FramePlace::Folder(folder) => images_in(folder),
            FramePlace::Video(_) => Ok(Vec::new()),
        }
    }

    /// Places among the images, counted from 0, that `rows` rows of ground truth belong to; `None` if the piece begins behind
    /// the last image.
    pub fn covered(&self, images: &[PathBuf], rows: usize) -> Option<Range<usize>> {
        let first = recognise::first_frame(self, images)?;
        Some(first..(first + rows).min(images.len()))
    }

    /// Reads its ground truth.
    ///
    /// # Errors
    /// [`SequenceError`], naming the file and line.
    pub fn truth(&self, polygons: PolygonBox) -> Result<BenchmarkTruth, SequenceError> {
        truth::read(self, polygons)
    }

    /// Makes its frames and ground truth ready.
    pub(super) fn open(&self, options: &OpenOptions) -> Result<Sequence, SequenceError> {
        let range = FrameRange::of(options)?;
        let origin = options.origin.unwrap_or(self.benchmark.origin());
        let truth = self.truth(PolygonBox::MinMax)?;
        let present = |(index, row): (usize, Rect)| {
            let is_there = row.is_proper() && !truth.absent.get(index).copied().unwrap_or(false);
            is_there.then(|| origin.to_frame(row))
        };
        let boxes: Vec<Option<Rect>> = truth.rows.iter().copied().enumerate().map(present).collect();
        let (source, first): (Box<dyn super::FrameSource>, usize) = match &self.frames {
            FramePlace::Video(video) => {
                let source = VideoFile::open(VideoInput::File(video.clone()), range, options.wait)?;
                (Box::new(source), range.start - 1)
            }
            FramePlace::Folder(folder) => {
                let images = self.images()?;
                let covered = self.covered(&images, boxes.len()).filter(|covered| !covered.is_empty());
                let covered = covered.ok_or_else(|| SequenceError::NoImages { path: folder.clone() })?;
                let images = &images[covered];
                let positions = range.positions(images.len(), &self.input.display().to_string())?;
                (Box::new(ImageFiles::new(images[positions.clone()].to_vec(), range.start)), positions.start)
            }
        };
        let wanted = options.end.unwrap_or(usize::MAX).saturating_sub(first);
        Ok(Sequence {
            name: self.name.clone(),
            ground_truth: boxes.into_iter().skip(first).take(wanted).collect(),
            ground_truth_row: Some((self.ground_truth.clone(), first + 1)),
            source,
            origin,
        })
    }
}

/// The one of several sequences of the same frames that is meant.
pub(super) fn chosen<'a>(
    sequences: &'a [BenchmarkSequence],
    input: &str,
    target: Option<usize>,
) -> Result<&'a BenchmarkSequence, SequenceError> {
    let numbers: Vec<usize> = sequences.iter().filter_map(|one| one.number).collect();
    let path = PathBuf::from(input);
    match (target, sequences) {
        (None, [one]) => Ok(one),
        (None, _) => Err(SequenceError::SeveralTargets { path, targets: numbers }),
        (Some(target), _) if numbers.is_empty() => {
            Err(SequenceError::TargetWithoutChoice { input: input.to_owned(), target })
        }
        (Some(target), _) => sequences
            .iter()
            .find(|one| one.number == Some(target))
            .ok_or(SequenceError::NoSuchTarget { path, target, targets: numbers }),
    }
}

#[cfg(test)]
mod tests;
