//! Predicting all tracks, and how long that takes.

use std::time::{Duration, Instant};

use infopart::bayes::FilterError;

/// Predicts tracks and keeps the time.
#[derive(Debug, Default)]
pub(crate) struct PredictionClock {
    predictions: u64,
    time: Duration,
}

impl PredictionClock {
    /// Predicts every track by one frame. One whose filter broke can predict nothing more, and is dropped.
    pub(crate) fn predict<T>(
        &mut self,
        tracks: &mut Vec<T>,
        mut predict: impl FnMut(&mut T) -> Result<(), FilterError>,
    ) {
        let start = Instant::now();
        self.predictions += tracks.len() as u64;
        tracks.retain_mut(|track| predict(track).is_ok());
        self.time += start.elapsed();
    }

    /// Mean time of predicting one track by one frame; `None` before the first.
    pub(crate) fn mean(&self) -> Option<Duration> {
        (self.predictions > 0).then(|| self.time.div_f64(self.predictions as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_that_cannot_be_predicted_goes_and_counts() {
        let mut clock = PredictionClock::default();
        assert_eq!(clock.mean(), None);
        let mut tracks = vec![1, 2, 3];
        clock.predict(&mut tracks, |track| match track {
            2 => Err(FilterError::SingularInnovation),
            _ => Ok(()),
        });
        assert_eq!((tracks, clock.predictions), (vec![1, 3], 3));
        assert!(clock.mean().is_some());
    }
}
