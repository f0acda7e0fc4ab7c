//! MOTChallenge text: `FRAME,ID,X,Y,WIDTH,HEIGHT,CONFIDENCE,...`, a row a box. Frames and pixels count from 1.

use std::{fmt::Write as _, path::Path};

use infopart::geometry::Rect;

mod error;
mod read;
mod sequence_info;
#[cfg(test)]
mod tests;

pub use error::{MotError, RowProblem};
pub use read::{read_annotations, read_detections, read_ground_truth, read_tracks};
pub use sequence_info::sequence_length;

/// Where one object is in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackRow {
    /// The frame, counted from 1.
    pub frame: u32,
    /// The object.
    pub identity: u64,
    /// Its box as the file has it: the first pixel is 1.
    pub box_in_file: Rect,
    /// The file's confidence, or 1.
    pub confidence: f64,
}

/// A row of ground truth, whether it counts or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Annotation {
    /// The row; its confidence says whether it counts.
    pub row: TrackRow,
    /// The eighth field, from MOT16 on: 1 is a pedestrian.
    pub class: Option<u32>,
}

impl Annotation {
    /// Whether the row counts: its confidence is not 0; -1 is none.
    pub fn is_counted(&self) -> bool {
        self.row.confidence.trunc() != 0.0
    }
}

/// Something that a detector saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// The frame, counted from 1.
    pub frame: u32,
    /// Its box as the file has it: the first pixel is 1.
    pub box_in_file: Rect,
    /// The detector's confidence, or 1.
    pub confidence: f64,
    /// The eighth field, if it names a class; -1 is none.
    pub class: Option<u32>,
}

/// A row as SORT and its descendants write it: boxes to a hundredth of a pixel, the confidence and `-1,-1,-1` behind them.
pub fn row_text(row: &TrackRow) -> String {
    row_text_of_class(row, None)
}

/// The same with a class in the eighth field, if there is one.
pub fn row_text_of_class(row: &TrackRow, class: Option<u32>) -> String {
    let Rect { x, y, w, h } = row.box_in_file;
    let mut text = format!("{},{},", row.frame, row.identity);
    // Writing to a String cannot fail.
    let _ = write!(text, "{x:.2},{y:.2},{w:.2},{h:.2},{},", row.confidence);
    let _ = match class {
        Some(class) => writeln!(text, "{class},-1,-1"),
        None => writeln!(text, "-1,-1,-1"),
    };
    text
}

/// What a sequence is called: SEQ of `SEQ/gt/gt.txt`, `SEQ/det/det.txt` and `SEQ/ANY/result.txt`, else the file's stem.
pub fn sequence_name(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().and_then(Path::parent).and_then(Path::file_name);
    match (stem.as_str(), folder) {
        ("gt" | "det" | "result", Some(folder)) => folder.to_string_lossy().into_owned(),
        _ => stem,
    }
}
