//! What a tracker says of a frame.

use std::{fmt, time::Duration};

use serde::{Deserialize, Serialize};

use crate::geometry::Rect;

/// How far a tracker trusts its box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Status {
    /// The target is seen.
    Tracking,
    /// The target may be hidden or confused; the model is not updated.
    Uncertain,
    /// The target is not seen; the box is the best guess.
    Lost,
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Tracking => "tracking",
            Self::Uncertain => "uncertain",
            Self::Lost => "lost",
        })
    }
}

/// What a tracker says of a frame. It always carries the best box, whatever the status.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Estimate {
    /// The whole target, in frame coordinates, unclipped.
    pub box_in_frame: Rect,
    /// The part that was tracked, in frame coordinates, unclipped.
    pub part_in_frame: Rect,
    /// How sure the tracker is that the box holds the target, in [0, 1].
    pub confidence: f64,
    /// The confidence in one word.
    pub status: Status,
    /// Effective sample size of the weighted particles before resampling, in [1, particles]; 0 in the first frame and for
    /// trackers without particles.
    pub effective_sample_size: f64,
    /// Covariance of the part's (x, y, w), square pixels, row by row; zero where unknown.
    pub covariance: [[f64; 3]; 3],
    /// What the confidence follows from; `None` in the first frame and for trackers that do not tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evidence: Option<Evidence>,
}

/// What InfoPart's confidence in an estimate follows from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// The classifier's score over its stumps, in [-1, 1]: 1 if every stump is certain of the target.
    pub mean_stump: f64,
    /// Squared distance of the part's HOG from the template's, in [0, 2].
    pub hog_distance: f64,
    /// How far the place filters' peaks stand above the rest of the window, in standard deviations of the rest; their mean,
    /// weighted as their responses are. `None` without the filters.
    pub peak_sharpness: Option<f64>,
    /// How much more the part is like what the target looked like than like others, in [0, 1].
    pub likeness: f64,
    /// How much the part looks like that place of the scene did when the target was elsewhere, a correlation in [0, 1]: scenery, or
    /// somebody who stands there. `None` without the filters.
    pub scenery: Option<f64>,
    /// The lowest log-odds, from -2 on, that a frame alone has given since the first, forgotten by 0.005 a frame: after a loss the
    /// target may be another. `None` without the filters.
    pub lowest_log_odds: Option<f64>,
}

impl Estimate {
    /// An estimate of which only the boxes, the confidence in [0, 1] and the status are known.
    pub fn new(box_in_frame: Rect, part_in_frame: Rect, confidence: f64, status: Status) -> Self {
        Self {
            box_in_frame,
            part_in_frame,
            confidence,
            status,
            effective_sample_size: 0.0,
            covariance: [[0.0; 3]; 3],
            evidence: None,
        }
    }
}

/// A hypothesis and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeightedBox {
    /// The whole target, in frame coordinates.
    pub box_in_frame: Rect,
    /// Normalised weight; all weights of a frame sum to 1.
    pub weight: f64,
}

/// What else the tracker looked at in a frame, for pictures.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Elsewhere {
    /// Whole boxes of places that look like the target and are not where it is taken to be, best first, in frame coordinates.
    pub competitors: Vec<Rect>,
    /// Windows in which a lost target was looked for, in frame coordinates.
    pub searched: Vec<Rect>,
    /// The whole box of who may be the lost target, but was not met often enough yet, in frame coordinates.
    pub suspect: Option<Rect>,
}

/// How long one stage of a frame took.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StageTime {
    /// The stage's name, such as `likelihood`.
    pub stage: &'static str,
    /// Wall time.
    pub time: Duration,
}

/// What is odd about a first box that is tracked all the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BoxWarning {
    /// A side is shorter than a few pixels: there is hardly anything to recognise.
    Tiny,
    /// Part of the box lies outside the frame; edge pixels are repeated there.
    PartlyOutside,
    /// The box covers the whole frame: there is no background to tell it from.
    CoversFrame,
}

impl fmt::Display for BoxWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Tiny => "the box is so small that there is hardly anything to recognise in it",
            Self::PartlyOutside => "the box lies partly outside the frame; edge pixels are repeated there",
            Self::CoversFrame => {
                "the box covers the whole frame, so there is no background to tell the target from"
            }
        })
    }
}
