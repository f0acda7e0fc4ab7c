//! Means, their spread, how sure they are, and whether two trackers differ.

mod bootstrap;
mod signed_rank;

pub use bootstrap::{COVERAGE, Interval, RESAMPLES, intervals, intervals_of_sets};
pub use signed_rank::{holm, signed_rank};

/// The mean; 0 of nothing.
pub fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1);
    values.sum::<f64>() / count as f64
}

/// The sample standard deviation; `None` of fewer than two values.
pub fn deviation(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let mean = mean(values.iter().copied());
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}
