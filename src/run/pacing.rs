//! Which frames of a source the tracker gets, and what rate of frames it can bear.
//!
//! In real time frame i arrives at i / rate on a virtual clock that starts when the target is given. A frame that
//! arrives while the tracker is busy waits, as in a camera's buffer of one frame; the next one to arrive takes its
//! place, and the frame that waited is skipped. What moves the clock is the measured time of each update.

use std::{fmt, num::NonZeroUsize};

/// Which frames the tracker gets. The others are filled by prediction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum Pace {
    /// All of them.
    #[default]
    EveryFrame,
    /// The first and every so many after it. The same at every run.
    Stride(NonZeroUsize),
    /// Those that the tracker is free for when frames arrive at a constant rate. It depends on measured times, so
    /// two runs differ.
    RealTime {
        /// The rate, frames per second, finite and above 0.
        frames_per_second: f64,
    },
}

impl fmt::Display for Pace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EveryFrame => f.write_str("every frame"),
            Self::Stride(stride) => write!(f, "stride {stride}"),
            Self::RealTime { frames_per_second } => write!(f, "real time at {frames_per_second} per second"),
        }
    }
}

impl Pace {
    /// Frames from one that may be tracked to the next.
    pub(super) fn stride(self) -> usize {
        match self {
            Self::Stride(stride) => stride.get(),
            Self::EveryFrame | Self::RealTime { .. } => 1,
        }
    }
}

/// Lets frames pass at a pace. Frames are counted from 0, the one that the target is given in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gate {
    pace: Pace,
    /// When the last update ends, seconds of the virtual clock.
    free_at: f64,
}

impl Gate {
    pub fn new(pace: Pace) -> Self {
        Self { pace, free_at: 0.0 }
    }

    /// Whether the tracker gets this frame.
    pub fn admits(&self, frame: usize) -> bool {
        match self.pace {
            Pace::EveryFrame => true,
            Pace::Stride(stride) => frame.is_multiple_of(stride.get()),
            // It can wait until the next one arrives.
            Pace::RealTime { frames_per_second } => self.free_at <= (frame + 1) as f64 / frames_per_second,
        }
    }

    /// Takes note that an admitted frame's update took so many seconds.
    pub fn updated(&mut self, frame: usize, seconds: f64) {
        if let Pace::RealTime { frames_per_second } = self.pace {
            self.free_at = self.free_at.max(frame as f64 / frames_per_second) + seconds;
        }
    }

    /// Whether what the last update found is still unknown when a frame that is skipped has to be answered for.
    pub fn answer_is_pending(&self) -> bool {
        // Only a busy tracker makes a live source skip.
        matches!(self.pace, Pace::RealTime { .. })
    }
}

/// The highest rate at which updates of these times, in seconds, one a frame, skip none in real time, at most that
/// of their mean time; `None` if there is none.
pub(super) fn sustained_frames_per_second(update_seconds: &[f64]) -> Option<f64> {
    const HALVINGS: usize = 40;
    if update_seconds.is_empty() {
        return None;
    }
    let mean = update_seconds.iter().sum::<f64>() / update_seconds.len() as f64;
    let slowest = update_seconds.iter().copied().fold(0.0, f64::max);
    // Periods: at the mean time of an update or later, and at the slowest update's time none is skipped for sure.
    let (mut skips, mut keeps_up) = (mean.max(1e-9), slowest.max(1e-9));
    if skips_none(update_seconds, skips) {
        return Some(1.0 / skips);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (skips + keeps_up);
        if skips_none(update_seconds, middle) { keeps_up = middle } else { skips = middle }
    }
    Some(1.0 / keeps_up)
}

fn skips_none(update_seconds: &[f64], period: f64) -> bool {
    let mut gate = Gate::new(Pace::RealTime { frames_per_second: 1.0 / period });
    update_seconds.iter().zip(1..).all(|(&seconds, frame)| {
        let admitted = gate.admits(frame);
        gate.updated(frame, seconds);
        admitted
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn admitted(pace: Pace, update_seconds: impl Fn(usize) -> f64) -> Vec<usize> {
        let mut gate = Gate::new(pace);
        let passes = |frame: &usize| {
            let admitted = gate.admits(*frame);
            if admitted {
                gate.updated(*frame, update_seconds(*frame));
            }
            admitted
        };
        (1..12).filter(passes).collect()
    }

    #[test]
    fn a_stride_counts_from_the_first_frame() {
        let every = |stride| Pace::Stride(NonZeroUsize::new(stride).unwrap());
        assert_eq!(admitted(every(3), |_| 9.0), [3, 6, 9]);
        assert_eq!(admitted(every(1), |_| 9.0), admitted(Pace::EveryFrame, |_| 9.0));
    }

    #[test]
    fn in_real_time_a_frame_waits_until_the_next_one_takes_its_place() {
        let pace = Pace::RealTime { frames_per_second: 10.0 };
        assert_eq!(admitted(pace, |_| 0.099).len(), 11, "fast enough");
        // Frame 1 arrives at 0.1 and is done at 0.44; 4, which replaced 2 and 3, is begun then and done at 0.78.
        assert_eq!(admitted(pace, |_| 0.34), [1, 4, 7, 11]);
        // One slow update of not quite two periods costs no frame.
        assert_eq!(admitted(pace, |frame| if frame == 3 { 0.19 } else { 0.05 }).len(), 11);
        assert_eq!(
            admitted(pace, |frame| if frame == 3 { 0.25 } else { 0.05 }),
            [1, 2, 3, 5, 6, 7, 8, 9, 10, 11]
        );
    }

    #[test]
    fn the_sustained_rate_skips_none_and_a_higher_one_does() {
        let alternating: Vec<f64> = (0..40).map(|i| if i % 4 == 3 { 0.030 } else { 0.010 }).collect();
        for (times, expected) in [
            (vec![0.01; 50], 100.0),
            (alternating, 1.0 / 0.015),
            // Frame 2 is started at 2 p and takes 0.5 s; frame 3 waits until 4 p at most.
            (vec![0.01, 0.5, 0.01, 0.01, 0.01], 2.0 / 0.5),
        ] {
            let rate = sustained_frames_per_second(&times).unwrap();
            assert!((rate / expected - 1.0).abs() < 1e-6, "{rate} {expected}");
            assert!(skips_none(&times, 1.000_001 / rate));
        }
        assert!(!skips_none(&[0.01, 0.5, 0.01, 0.01, 0.01], 0.249));
        assert_eq!(sustained_frames_per_second(&[]), None);
        assert!(sustained_frames_per_second(&[0.0, 0.0]).unwrap().is_finite());
    }
}
