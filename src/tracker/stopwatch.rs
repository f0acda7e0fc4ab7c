//! Wall time of each stage of a frame.

use std::time::Instant;

use super::estimate::StageTime;

/// Stages of one frame, in the order they ended.
#[derive(Debug, Clone, Default)]
pub(super) struct Stopwatch {
    since: Option<Instant>,
    times: Vec<StageTime>,
}

impl Stopwatch {
    /// Forgets the last frame and starts the first stage.
    pub fn start(&mut self) {
        self.times.clear();
        self.since = now();
    }

    /// Ends a stage and starts the next.
    pub fn lap(&mut self, stage: &'static str) {
        let Some(now) = now() else { return };
        if let Some(since) = self.since.replace(now) {
            self.times.push(StageTime { stage, time: now - since });
        }
    }

    /// The stages so far.
    pub fn times(&self) -> &[StageTime] {
        &self.times
    }
}

/// Nothing where there is no clock: in WebAssembly without a system [`Instant::now`] panics.
fn now() -> Option<Instant> {
    (!cfg!(all(target_family = "wasm", target_os = "unknown"))).then(Instant::now)
}
