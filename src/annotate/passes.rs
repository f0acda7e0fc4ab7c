//! Passes: the tracker from a key frame forward or backward, and what was tracked before, so that it is not tracked again.

use std::{error::Error, ops::ControlFlow};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::{
    frame::{FrameStamp, FrameView},
    geometry::Rect,
    tracker::{TrackError, Tracker},
};

/// Frames that are had by number, in any order.
pub trait Frames {
    /// The frame of that number, counted from 0.
    ///
    /// # Errors
    /// What the source says, naming the file or frame and what to do.
    fn view(&mut self, index: usize) -> Result<FrameView<'_>, Box<dyn Error + Send + Sync>>;
}

/// Which way a pass goes through the video.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Towards later frames.
    Forward,
    /// Towards earlier frames.
    Backward,
}

/// What a pass saw in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 5]", into = "[f64; 5]")]
pub struct Sighting {
    /// The object's box, frame coordinates.
    pub box_in_frame: Rect,
    /// The tracker's confidence in it, in [0, 1].
    pub confidence: f64,
}

impl From<[f64; 5]> for Sighting {
    fn from([x, y, w, h, confidence]: [f64; 5]) -> Self {
        Self { box_in_frame: Rect::new(x, y, w, h), confidence }
    }
}

impl From<Sighting> for [f64; 5] {
    fn from(Sighting { box_in_frame: Rect { x, y, w, h }, confidence }: Sighting) -> Self {
        [x, y, w, h, confidence]
    }
}

/// The tracker's way from a key frame on. It follows from the frame, the box and the tracker's parameters alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// The key frame, counted from 0.
    pub from: usize,
    /// The box there, frame coordinates.
    pub start: Rect,
    /// Which way.
    pub direction: Direction,
    /// What was seen in the frames after it, in the order of the pass.
    pub sightings: Vec<Sighting>,
}

/// Why a pass ended early.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PassError {
    /// A frame could not be had.
    #[error("{0}")]
    Frame(Box<dyn Error + Send + Sync>),
    /// The tracker refused a frame or the key frame's box.
    #[error("frame {number}: {source}")]
    Track {
        /// The frame, counted from 1.
        number: usize,
        /// The tracker's reason.
        source: TrackError,
    },
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// What tracks, and over what.
pub struct Pathfinder<'a> {
    /// The video.
    pub frames: &'a mut dyn Frames,
    /// Makes a tracker for a pass; every one must track alike.
    pub tracker: &'a mut dyn FnMut() -> Box<dyn Tracker>,
    /// Called after each tracked frame; says whether to go on.
    pub watch: &'a mut dyn FnMut() -> ControlFlow<()>,
}

impl Pathfinder<'_> {
    fn track(&mut self, pass: &mut Pass, count: usize) -> Result<(), PassError> {
        let number = |index: usize| index + 1;
        let mut tracker = (self.tracker)();
        pass.sightings.clear();
        let first = self.frames.view(pass.from).map_err(PassError::Frame)?;
        let refused = |index, source| PassError::Track { number: number(index), source };
        tracker.init(first, pass.start).map_err(|error| refused(pass.from, error))?;
        for distance in 1..=count {
            let index = match pass.direction {
                Direction::Forward => pass.from + distance,
                Direction::Backward => pass.from - distance,
            };
            let view = self.frames.view(index).map_err(PassError::Frame)?;
            let stamp = FrameStamp { index: Some(index as u64), time: None };
            let found = tracker.update_at(view, stamp).map_err(|error| refused(index, error))?;
            pass.sightings.push(Sighting { box_in_frame: found.box_in_frame, confidence: found.confidence });
            if (self.watch)().is_break() {
                return Err(PassError::Interrupted);
            }
        }
        Ok(())
    }
}

/// Passes that were tracked. A longer one serves for a shorter.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Passes {
    known: Vec<Pass>,
    #[serde(skip)]
    used: Vec<bool>,
}

impl Passes {
    /// What a pass from `start` in frame `from` sees in the next `count` frames that way; tracked only if it is not known. A pass
    /// that was interrupted leaves nothing.
    ///
    /// # Errors
    /// [`PassError`].
    ///
    /// # Panics
    /// Never, as long as `from + count` (or `from - count`) is a frame of the video: otherwise as its `view` does.
    pub fn sightings(
        &mut self,
        finder: &mut Pathfinder<'_>,
        from: usize,
        start: Rect,
        direction: Direction,
        count: usize,
    ) -> Result<&[Sighting], PassError> {
        if count == 0 {
            return Ok(&[]);
        }
        self.used.resize(self.known.len(), false);
        let same = |pass: &Pass| (pass.from, pass.start, pass.direction) == (from, start, direction);
        let at = match self.known.iter().position(same) {
            Some(at) if self.known[at].sightings.len() >= count => at,
            found => {
                let mut pass = Pass { from, start, direction, sightings: Vec::with_capacity(count) };
                finder.track(&mut pass, count)?;
                match found {
                    Some(at) => {
                        self.known[at] = pass;
                        at
                    }
                    None => {
                        self.known.push(pass);
                        self.used.push(false);
                        self.known.len() - 1
                    }
                }
            }
        };
        self.used[at] = true;
        Ok(&self.known[at].sightings[..count])
    }

    /// Forgets what was not asked for since the last call: passes from key frames that are no more.
    pub fn forget_unused(&mut self) {
        self.used.resize(self.known.len(), false);
        let mut used = self.used.iter();
        self.known.retain(|_| used.next().copied().unwrap_or(false));
        self.used.clear();
    }

    /// The passes that are known.
    pub fn iter(&self) -> impl Iterator<Item = &Pass> {
        self.known.iter()
    }
}
