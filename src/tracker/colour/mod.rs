//! The colour-histogram particle filter (Li Qian 2017, for ships).
//!
//! Steps:
//! 1. N particles around the target's first position,
//! 2. weights W_i = exp(10 <H, H_i>) of the 16-bin colour histograms H of the target and H_i of particle i, upper and
//!    lower half apart,
//! 3. position X = sum X_i W_i, the weights summing to 1,
//! 4. resampling,
//! 5. update X'' = X' + v + e with the mean velocity v so far,
//! 6. back to step 2 in the next frame.

mod appearance;
mod flock;
mod motion;
mod parameters;
mod target;
#[cfg(test)]
mod tests;

use crate::{
    frame::{FrameStamp, FrameView},
    geometry::Rect,
    parallel::Threads,
};

use super::{
    TrackError, Tracker,
    estimate::{BoxWarning, Estimate, StageTime, WeightedBox},
};

pub use flock::ColourFlock;
pub use parameters::{CheckedColourParameters, ColourParameters, ColourResampling, Halves, VelocityModel};

/// The colour tracker of one target: a [`ColourFlock`] of one.
pub struct ColourTracker {
    flock: ColourFlock,
}

impl ColourTracker {
    /// A tracker that works in the thread pool it is called from, or without the feature `threads` on the calling thread.
    pub fn new(parameters: CheckedColourParameters) -> Self {
        Self { flock: ColourFlock::new(parameters) }
    }

    /// A tracker that works in `pool`.
    #[cfg(feature = "threads")]
    pub fn with_pool(parameters: CheckedColourParameters, pool: std::sync::Arc<rayon::ThreadPool>) -> Self {
        Self::with_threads(parameters, Threads::Pool(pool))
    }

    /// A tracker that works where `threads` says.
    pub fn with_threads(parameters: CheckedColourParameters, threads: Threads) -> Self {
        Self { flock: ColourFlock::with_threads(parameters, threads) }
    }
}

impl Tracker for ColourTracker {
    fn name(&self) -> &str {
        "colour"
    }

    fn init(&mut self, frame: FrameView<'_>, box_in_frame: Rect) -> Result<Vec<BoxWarning>, TrackError> {
        Ok(self.flock.init(frame, &[box_in_frame])?.into_iter().flatten().collect())
    }

    fn update_at(&mut self, frame: FrameView<'_>, _stamp: FrameStamp) -> Result<Estimate, TrackError> {
        let estimates = self.flock.update(frame)?;
        estimates.into_iter().next().ok_or(TrackError::NotStarted)
    }

    fn estimate(&self) -> Option<&Estimate> {
        self.flock.estimates().next()
    }

    fn hypotheses(&self) -> Vec<WeightedBox> {
        self.flock.hypotheses(0)
    }

    fn stage_times(&self) -> &[StageTime] {
        self.flock.stage_times()
    }
}
