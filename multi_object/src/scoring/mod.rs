//! How good a result is: CLEAR-MOT, identity scores and HOTA, as py-motmetrics or TrackEval would say.
//!
//! ```
//! use infopart::geometry::Rect;
//! use multi_object::{motchallenge::TrackRow, scoring::{Counts, Rules}};
//!
//! let row = |frame, identity| TrackRow { frame, identity, box_in_file: Rect::new(9.0, 9.0, 20.0, 40.0), confidence: 1.0 };
//! // One object over two frames; the result changes its name on the way.
//! let counts = Counts::of(&[row(1, 5), row(2, 5)], &[row(1, 1), row(2, 2)], Rules::Motmetrics);
//! assert_eq!(counts.scores().switches, 1);
//! assert_eq!(counts.scores().mota, Some(0.5));
//! ```

use crate::motchallenge::TrackRow;

mod benchmark;
mod clear_motmetrics;
mod clear_trackeval;
mod hota;
mod identity;
mod rules;
mod scores;
#[cfg(test)]
mod tests;
mod timeline;

pub use benchmark::Benchmark;
pub use rules::Rules;
pub use scores::Scores;
pub use timeline::{FrameOverlaps, Timeline};

/// What is counted in a sequence. The counts of several sequences add up to those of all together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Counts {
    rules: Rules,
    frames: usize,
    objects: usize,
    truth_boxes: usize,
    result_boxes: usize,
    matches: usize,
    misses: usize,
    false_positives: usize,
    switches: usize,
    fragments: usize,
    mostly_tracked: usize,
    partially_tracked: usize,
    mostly_lost: usize,
    transfers: usize,
    ascents: usize,
    migrations: usize,
    /// Sum of 1 - overlap over the matches.
    distance_sum: f64,
    identity_true_positives: usize,
    hota: [hota::AtThreshold; hota::THRESHOLDS],
}

impl Counts {
    /// Counts one sequence. Each identity is at most once in a frame, as the readers of
    /// [`motchallenge`](crate::motchallenge) see to.
    pub fn of(truth: &[TrackRow], result: &[TrackRow], rules: Rules) -> Self {
        let timeline = Timeline::new(truth, result);
        let clear = match rules {
            Rules::Motmetrics => clear_motmetrics::count(&timeline),
            Rules::Trackeval => clear_trackeval::count(&timeline),
        };
        Self {
            rules,
            objects: timeline.frames_of_truth.len(),
            truth_boxes: timeline.truth_boxes(),
            result_boxes: timeline.result_boxes(),
            identity_true_positives: identity::true_positives(&timeline),
            hota: hota::count(&timeline),
            ..clear
        }
    }

    /// The same of a sequence that has so many frames, whether there is a box in the last or not; TrackEval is told a length,
    /// py-motmetrics's rules count the frames that have a box.
    pub fn of_length(self, frames: u32) -> Self {
        match self.rules {
            Rules::Motmetrics => self,
            Rules::Trackeval => Self { frames: frames as usize, ..self },
        }
    }

    /// Adds another sequence's counts.
    pub fn add(&mut self, other: &Self) {
        self.frames += other.frames;
        self.objects += other.objects;
        self.truth_boxes += other.truth_boxes;
        self.result_boxes += other.result_boxes;
        self.matches += other.matches;
        self.misses += other.misses;
        self.false_positives += other.false_positives;
        self.switches += other.switches;
        self.fragments += other.fragments;
        self.mostly_tracked += other.mostly_tracked;
        self.partially_tracked += other.partially_tracked;
        self.mostly_lost += other.mostly_lost;
        self.transfers += other.transfers;
        self.ascents += other.ascents;
        self.migrations += other.migrations;
        self.distance_sum += other.distance_sum;
        self.identity_true_positives += other.identity_true_positives;
        for (sum, more) in self.hota.iter_mut().zip(&other.hota) {
            sum.true_positives += more.true_positives;
            sum.misses += more.misses;
            sum.false_positives += more.false_positives;
            sum.association_sum += more.association_sum;
        }
    }

    /// The counts of several sequences together; `None` if there is none.
    pub fn total<'a>(of_sequences: impl IntoIterator<Item = &'a Self>) -> Option<Self> {
        let mut sequences = of_sequences.into_iter();
        let first = sequences.next()?.clone();
        Some(sequences.fold(first, |mut sum, more| {
            sum.add(more);
            sum
        }))
    }

    /// The scores that these counts give.
    pub fn scores(&self) -> Scores {
        scores::of(self)
    }
}
