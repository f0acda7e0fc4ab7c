//! Frames of each sequence with every tracker's box, for the report.

use std::io::Cursor;

use image::{RgbImage, codecs::jpeg::JpegEncoder, imageops};
use infopart::{
    frame::PixelFormat,
    geometry::Rect,
    sequence::{OpenOptions, SequenceError, SourceFrame, open},
};
use thiserror::Error;

use super::timelines::{boxes_of, telling};
use crate::{
    dataset::{Dataset, FrameFolder, Target},
    report::{Strip, StripFrame},
    results::Results,
    scoring::Table,
    words::of_sequence,
};

/// Pictures are scaled down to this width, pixels.
const WIDTH: u32 = 360;
const JPEG_QUALITY: u8 = 78;

/// Frames that cannot be shown.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StripProblem {
    /// The frames of a sequence cannot be read.
    #[error("{sequence}: {}", of_sequence(source))]
    Frames {
        /// The sequence.
        sequence: String,
        /// What is wrong, and what to do.
        source: SequenceError,
    },
    /// A frame cannot be made a JPEG.
    #[error("{sequence}: a frame cannot be shown: {source}; leave frames out with --no-frames")]
    Picture {
        /// The sequence.
        sequence: String,
        /// The encoder's reason.
        source: image::ImageError,
    },
}

/// A strip for each sequence of the table whose frames are there: `count` frames, those first in which trackers begin to fail, with the
/// boxes of each tracker's first seed. What cannot be shown is told beside.
pub fn strips(
    dataset: &Dataset,
    results: &Results,
    table: &Table,
    count: usize,
) -> (Vec<Strip>, Vec<StripProblem>) {
    let (mut strips, mut problems) = (Vec::new(), Vec::new());
    for name in &table.sequences {
        let Some(target) = dataset.target(name) else { continue };
        let Some(folder) = &target.frames else { continue };
        match strip(target, folder, results, count) {
            Ok(strip) => strips.push(strip),
            Err(problem) => problems.push(problem),
        }
    }
    (strips, problems)
}

fn strip(
    target: &Target,
    folder: &FrameFolder,
    results: &Results,
    count: usize,
) -> Result<Strip, StripProblem> {
    let rows = boxes_of(target, results);
    let mut frames = Vec::new();
    for index in telling(target, &rows, count) {
        let sequence = || target.name.clone();
        let Some(frame) = frame_at(folder, index)
            .map_err(|source| StripProblem::Frames { sequence: sequence(), source })?
        else {
            continue;
        };
        let jpeg =
            jpeg_of(&frame).map_err(|source| StripProblem::Picture { sequence: sequence(), source })?;
        let in_frame =
            |row: Option<&Rect>| row.filter(|row| row.is_proper()).map(|row| folder.origin.to_frame(*row));
        frames.push(StripFrame {
            number: index + 1,
            jpeg,
            width: frame.frame.width() as u32,
            height: frame.frame.height() as u32,
            truth: in_frame(target.truth.get(index)),
            boxes: rows.iter().map(|rows| in_frame(rows.get(index))).collect(),
        });
    }
    Ok(Strip { sequence: target.name.clone(), frames })
}

fn frame_at(folder: &FrameFolder, row: usize) -> Result<Option<SourceFrame>, SequenceError> {
    let options = OpenOptions {
        target: folder.target,
        start: Some(folder.first_frame + row),
        ..OpenOptions::default()
    };
    open(&folder.path.to_string_lossy(), &options)?.source.next_frame()
}

fn jpeg_of(frame: &SourceFrame) -> Result<Vec<u8>, image::ImageError> {
    let view = frame.frame.view();
    let (width, height) = (view.width() as u32, view.height() as u32);
    let picture = RgbImage::from_fn(width, height, |x, y| {
        let row = view.row(y as usize);
        image::Rgb(match view.format() {
            PixelFormat::Gray => [row[x as usize]; 3],
            _ => [0, 1, 2].map(|channel| row[3 * x as usize + channel]),
        })
    });
    let scaled = if width > WIDTH {
        imageops::resize(&picture, WIDTH, (height * WIDTH / width).max(1), imageops::FilterType::Triangle)
    } else {
        picture
    };
    let mut bytes = Cursor::new(Vec::new());
    JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY).encode_image(&scaled)?;
    Ok(bytes.into_inner())
}
