//! The paper's Table III.

use crate::motion::FilterKind;

/// What the paper has for a video and a filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperRow {
    /// RMSE, pixels.
    pub rmse: f64,
    /// Overlap.
    pub overlap: f64,
    /// Accuracy.
    pub accuracy: f64,
}

/// EKF, UKF and PF of the videos that can be had.
const TABLE_III: [(&str, [[f64; 3]; 3]); 5] = [
    ("sample1", [[9.9426, 0.6688, 0.7500], [7.6325, 0.6493, 0.7379], [2.7864, 0.7717, 0.8690]]),
    ("sample2", [[5.1721, 0.8097, 0.8642], [4.1821, 0.8038, 0.8614], [2.1365, 0.8753, 0.9330]]),
    ("sample3", [[11.2638, 0.6870, 0.7851], [9.1636, 0.7242, 0.8224], [6.4488, 0.7938, 0.8817]]),
    ("view1", [[14.2602, 0.6169, 0.7054], [8.8915, 0.6669, 0.7638], [4.2151, 0.8102, 0.8917]]),
    ("atrium", [[7.3311, 0.6644, 0.7610], [5.7918, 0.6945, 0.7968], [4.9399, 0.7598, 0.8601]]),
];

/// What the paper has for the video whose name begins with one of its names (`view1_vtest.avi` is View1).
pub fn paper_row(video: &str, filter: FilterKind) -> Option<PaperRow> {
    let column = match filter {
        FilterKind::Kalman => return None,
        FilterKind::Ekf => 0,
        FilterKind::Ukf => 1,
        FilterKind::Pf => 2,
    };
    let video = video.to_ascii_lowercase();
    let (_, rows) = TABLE_III.iter().find(|(name, _)| video.starts_with(name))?;
    let [rmse, overlap, accuracy] = rows[column];
    Some(PaperRow { rmse, overlap, accuracy })
}
