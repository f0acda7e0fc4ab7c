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
    fn track(&mut self, leg: &Leg) -> Result<Pass, PassError> {
        let first = self.frames.view(leg.from).map_err(PassError::Frame)?;
        let mut ongoing = OngoingPass::begin(leg, first, (self.tracker)())?;
        for _ in 0..leg.count {
            let view = self.frames.view(ongoing.next_frame()?).map_err(PassError::Frame)?;
            ongoing.see(view)?;
            if (self.watch)().is_break() {
                return Err(PassError::Interrupted);
            }
        }
        Ok(ongoing.into_pass())
    }
}

/// A pass to be tracked.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Leg {
    /// The key frame, counted from 0.
    pub from: usize,
    /// The box there, frame coordinates.
    pub start: Rect,
    /// Which way.
    pub direction: Direction,
    /// How many frames after the key frame are to be seen; all of them are frames of the video.
    pub count: usize,
}

/// A pass under way, for whoever is handed one frame after the other and does not have them by number.
pub struct OngoingPass {
    pass: Pass,
    tracker: Box<dyn Tracker>,
}

impl OngoingPass {
    /// Starts `tracker` on `view`, the leg's key frame.
    ///
    /// # Errors
    /// [`PassError::Track`] if the tracker refuses the box.
    pub fn begin(leg: &Leg, view: FrameView<'_>, mut tracker: Box<dyn Tracker>) -> Result<Self, PassError> {
        let Leg { from, start, direction, count } = *leg;
        let refused = |source| PassError::Track { number: from + 1, source };
        tracker.init(view, start).map_err(refused)?;
        let pass = Pass { from, start, direction, sightings: Vec::with_capacity(count) };
        Ok(Self { pass, tracker })
    }

    /// The number, counted from 0, of the frame that is to be seen next.
    ///
    /// # Errors
    /// [`PassError::Frame`] once a backward pass has seen the first frame.
    pub fn next_frame(&self) -> Result<usize, PassError> {
        let distance = self.pass.sightings.len() + 1;
        match self.pass.direction {
            Direction::Forward => Ok(self.pass.from + distance),
            Direction::Backward => self
                .pass
                .from
                .checked_sub(distance)
                .ok_or_else(|| PassError::Frame("there is no frame before the first".into())),
        }
    }

    /// Tracks into `view`, the pixels of the [next frame](Self::next_frame).
    ///
    /// # Errors
    /// [`PassError`]; the pass then stays as it was.
    pub fn see(&mut self, view: FrameView<'_>) -> Result<Sighting, PassError> {
        let index = self.next_frame()?;
        let stamp = FrameStamp { index: Some(index as u64), time: None };
        let refused = |source| PassError::Track { number: index + 1, source };
        let found = self.tracker.update_at(view, stamp).map_err(refused)?;
        let sighting = Sighting { box_in_frame: found.box_in_frame, confidence: found.confidence };
        self.pass.sightings.push(sighting);
        Ok(sighting)
    }

    /// What was seen until now.
    pub fn into_pass(self) -> Pass {
        self.pass
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
    /// What the pass of `leg` sees; tracked only if it is not known. A pass that was interrupted leaves nothing.
    ///
    /// # Errors
    /// [`PassError`].
    ///
    /// # Panics
    /// Never, as long as all of the leg's frames are frames of the video: otherwise as its `view` does.
    pub fn sightings(&mut self, finder: &mut Pathfinder<'_>, leg: &Leg) -> Result<&[Sighting], PassError> {
        let at = match self.position(leg.from, leg.start, leg.direction) {
            Some(at) if self.known[at].sightings.len() >= leg.count => at,
            _ if leg.count == 0 => return Ok(&[]),
            _ => self.insert(finder.track(leg)?),
        };
        self.used.resize(self.known.len(), false);
        self.used[at] = true;
        Ok(&self.known[at].sightings[..leg.count])
    }

    /// Remembers a pass, instead of a shorter one from the same box the same way; gives its position.
    pub fn insert(&mut self, pass: Pass) -> usize {
        match self.position(pass.from, pass.start, pass.direction) {
            Some(at) => {
                if self.known[at].sightings.len() < pass.sightings.len() {
                    self.known[at] = pass;
                }
                at
            }
            None => {
                self.known.push(pass);
                self.known.len() - 1
            }
        }
    }

    /// Remembers a pass instead of any other from the same box the same way, also if that is longer.
    pub fn replace(&mut self, pass: Pass) {
        match self.position(pass.from, pass.start, pass.direction) {
            Some(at) => self.known[at] = pass,
            None => self.known.push(pass),
        }
    }

    /// What is known of the leg's pass, also if it is less than the leg, up to the leg's length.
    pub fn known(&self, leg: &Leg) -> &[Sighting] {
        match self.position(leg.from, leg.start, leg.direction) {
            Some(at) => {
                let seen = &self.known[at].sightings;
                &seen[..leg.count.min(seen.len())]
            }
            None => &[],
        }
    }

    fn position(&self, from: usize, start: Rect, direction: Direction) -> Option<usize> {
        let same = |pass: &Pass| (pass.from, pass.start, pass.direction) == (from, start, direction);
        self.known.iter().position(same)
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
