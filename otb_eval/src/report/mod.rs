//! The report: one HTML page that needs nothing but itself.
//!
//! [`Report`] says what is on the page; nothing here computes a score. The page reads and prints without JavaScript;
//! with it there are values under the pointer, sorting, filtering, downloads, every sequence over time, and trackers to switch on and off. The same model gives
//! the same bytes.

mod check;
mod figures;
mod page;
mod parts;
mod strips;
mod tables;

use infopart::geometry::Rect;
use thiserror::Error;

use crate::{
    plots::{Plot, PlotError},
    statistics::Interval,
};

/// All that a report shows. Lists of values for each tracker follow the order of `trackers`. What is empty is left
/// out of the page.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// What was evaluated, such as `InfoPart and ten trackers on TB-100`.
    pub title: String,
    /// One sentence under the title; may be empty.
    pub subtitle: String,
    /// When the report was made; `None` keeps the page free of what changes from run to run.
    pub made: Option<String>,
    /// Programs and data, with their versions.
    pub versions: Vec<(String, String)>,
    /// The trackers. A tracker's place here is its style in the plots and its colour everywhere.
    pub trackers: Vec<Tracker>,
    /// The commands that make the report again.
    pub commands: Vec<String>,
    /// Scores over all sequences, a table for each protocol or toolkit.
    pub overall: Vec<OverallTable>,
    /// Plots: a tab for each group.
    pub plots: Vec<PlotGroup>,
    /// Scores by attribute: a heat map for each chart.
    pub attributes: Vec<AttributeChart>,
    /// Scores by sequence, a table for each metric, of which one is shown.
    pub sequences: Vec<SequenceTable>,
    /// Frames with boxes, a strip for each sequence; empty for a small page.
    pub strips: Vec<Strip>,
    /// Overlap and centre error over time, for each sequence; may be empty.
    pub timelines: Vec<Timeline>,
    /// Jobs that failed.
    pub failures: Vec<Failure>,
    /// What was met in scoring: results that lack rows, that a toolkit would fail on, that were read otherwise.
    pub scoring: Vec<String>,
    /// What a reader must know to judge the numbers, such as which toolkit's rules hold.
    pub notes: Vec<String>,
}

/// A tracker and the parameters it ran with.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tracker {
    /// Its name.
    pub label: String,
    /// Names and values of its parameters.
    pub parameters: Vec<(String, String)>,
}

/// Plots that are shown together, such as those of one protocol.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotGroup {
    /// The tab's name, such as `OPE`.
    pub title: String,
    /// The plots. A curve's `style` is its tracker's place in [`Report::trackers`].
    pub plots: Vec<Plot>,
}

/// Scores over all sequences.
#[derive(Debug, Clone, PartialEq)]
pub struct OverallTable {
    /// What the scores belong to, such as `OPE, rules of the MATLAB toolkit`.
    pub title: String,
    /// The columns of scores, such as `AUC`.
    pub metrics: Vec<String>,
    /// A row for each tracker that has scores.
    pub rows: Vec<OverallRow>,
    /// Heading of the differences to the tracker that all are tested against; `None` if there is none.
    pub against: Option<String>,
}

/// A tracker's scores over all sequences.
#[derive(Debug, Clone, PartialEq)]
pub struct OverallRow {
    /// The tracker's place in [`Report::trackers`].
    pub tracker: usize,
    /// How many seeds it ran with.
    pub seeds: usize,
    /// A score for each of the table's metrics.
    pub scores: Vec<Option<Score>>,
    /// Speed, frames a second.
    pub fps: Option<f64>,
    /// How it differs from the tracker that all are tested against; `None` for that one itself.
    pub against: Option<Tested>,
}

/// How a tracker differs from another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tested {
    /// Mean difference over sequences.
    pub difference: f64,
    /// Its 95 % interval.
    pub interval: Interval,
    /// Probability of such a difference if they were alike.
    pub p: f64,
}

/// A score and how much it varies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Score {
    /// Mean over the seeds.
    pub mean: f64,
    /// Standard deviation over the seeds; `None` with one seed.
    pub spread: Option<f64>,
    /// 95 % interval over sequences.
    pub interval: Option<Interval>,
}

/// One metric's scores by sequence and tracker.
#[derive(Debug, Clone, PartialEq)]
pub struct SequenceTable {
    /// The metric, such as `AUC`; the tab's name.
    pub metric: String,
    /// The sequences with a score for each tracker; more is better.
    pub rows: Vec<SequenceRow>,
}

/// A sequence's scores.
#[derive(Debug, Clone, PartialEq)]
pub struct SequenceRow {
    /// Its name.
    pub sequence: String,
    /// A score for each tracker, `None` where there is none.
    pub scores: Vec<Option<f64>>,
}

/// Scores by attribute and tracker.
#[derive(Debug, Clone, PartialEq)]
pub struct AttributeChart {
    /// The metric and protocol, such as `AUC, OPE`; the tab's name.
    pub title: String,
    /// Where it is taken from which sequence has which attribute, such as `tb_100.txt`.
    pub source: String,
    /// The attributes.
    pub attributes: Vec<AttributeScores>,
}

/// An attribute's scores.
#[derive(Debug, Clone, PartialEq)]
pub struct AttributeScores {
    /// Its short name, such as `OCC`.
    pub attribute: String,
    /// How many sequences have it.
    pub sequences: usize,
    /// A score in [0, 1] for each tracker, `None` where there is none.
    pub scores: Vec<Option<f64>>,
}

/// Frames of one sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Strip {
    /// The sequence's name.
    pub sequence: String,
    /// Its frames, in order.
    pub frames: Vec<StripFrame>,
}

/// How well a sequence was followed over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Timeline {
    /// The sequence's name.
    pub sequence: String,
    /// Frames of the sequence.
    pub frames: usize,
    /// The values are of frames 1, 1 + `every`, 1 + 2 `every`, ...
    pub every: usize,
    /// Each tracker's overlaps, in [0, 1]; `None` where the target is absent, or there is no result.
    pub overlaps: Vec<Vec<Option<f64>>>,
    /// Each tracker's centre errors, pixels.
    pub errors: Vec<Vec<Option<f64>>>,
}

/// A frame with everyone's boxes.
#[derive(Debug, Clone, PartialEq)]
pub struct StripFrame {
    /// Its number, as shown.
    pub number: usize,
    /// The picture as a JPEG file's bytes; it may have fewer pixels than the frame.
    pub jpeg: Vec<u8>,
    /// The frame's width in pixels, the unit of the boxes.
    pub width: u32,
    /// The frame's height in pixels.
    pub height: u32,
    /// The true box; the first pixel is 0.
    pub truth: Option<Rect>,
    /// Each tracker's box; improper boxes are not drawn.
    pub boxes: Vec<Option<Rect>>,
}

/// A job that failed.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Tracker, sequence, seed.
    pub job: String,
    /// Why.
    pub reason: String,
}

/// Why a report cannot be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A plot that cannot be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// A list that does not fit the trackers or the metrics.
    #[error("report: {place} has {given} values; it must have one for each of the {expected} {what}")]
    Length {
        /// Where.
        place: String,
        /// How many values there are.
        given: usize,
        /// How many there must be.
        expected: usize,
        /// What there must be a value for.
        what: &'static str,
    },
    /// A tracker that is not in the list.
    #[error(
        "report: {place} names tracker {tracker}, but there are {trackers}, counted from 0; add it to them"
    )]
    Tracker {
        /// Where.
        place: String,
        /// The place that was given.
        tracker: usize,
        /// How many trackers there are.
        trackers: usize,
    },
    /// A picture that is no JPEG, or has no size.
    #[error("report: frame {number} of `{sequence}` is not a JPEG file of a frame with at least one pixel")]
    Picture {
        /// The sequence.
        sequence: String,
        /// The frame's number.
        number: usize,
    },
}

impl Report {
    /// The place of the panel that shows a sequence over time or its frames; `None` if nothing of it is shown.
    fn shown(&self, sequence: &str) -> Option<usize> {
        self.shown_sequences().iter().position(|name| *name == sequence)
    }

    /// The sequences that are shown, in their order.
    fn shown_sequences(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.timelines.iter().map(|one| one.sequence.as_str()).collect();
        let known: std::collections::HashSet<&str> = names.iter().copied().collect();
        names
            .extend(self.strips.iter().map(|one| one.sequence.as_str()).filter(|name| !known.contains(name)));
        names
    }

    /// The report as an HTML page.
    ///
    /// # Errors
    /// If a list of values does not fit the trackers, a plot cannot be drawn, or a picture is no JPEG.
    pub fn html(&self) -> Result<String, ReportError> {
        self.check()?;
        page::page(self)
    }
}
