//! MOTChallenge text: `FRAME,ID,X,Y,WIDTH,HEIGHT,CONFIDENCE,...`, a row a box. Frames and pixels count from 1.

use std::{fmt::Write as _, path::Path};

use infopart::geometry::Rect;

mod error;
mod read;
#[cfg(test)]
mod tests;

pub use error::{MotError, RowProblem};
pub use read::{read_detections, read_ground_truth, read_tracks};

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

/// Something that a detector saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// The frame, counted from 1.
    pub frame: u32,
    /// Its box as the file has it: the first pixel is 1.
    pub box_in_file: Rect,
    /// The detector's confidence, or 1.
    pub confidence: f64,
}

/// A row as SORT and its descendants write it: boxes to a hundredth of a pixel, `1,-1,-1,-1` behind them.
pub fn row_text(row: &TrackRow) -> String {
    let Rect { x, y, w, h } = row.box_in_file;
    let mut text = format!("{},{},", row.frame, row.identity);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{x:.2},{y:.2},{w:.2},{h:.2},{},-1,-1,-1", row.confidence);
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
