//! Means with their interval of confidence.

use serde::Serialize;

/// A mean over runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Statistic {
    /// Mean.
    pub mean: f64,
    /// Half of the interval of 95 % confidence: 1.96 standard errors.
    pub half_width: f64,
}

impl Statistic {
    /// Of at least two values, summed in their order.
    pub fn of(values: impl ExactSizeIterator<Item = f64> + Clone) -> Self {
        let n = values.len() as f64;
        let mean = values.clone().sum::<f64>() / n;
        let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
        Self { mean, half_width: 1.96 * (variance / n).sqrt() }
    }

    /// +1 if the whole interval is above 0, -1 if it is below, 0 if 0 is in it.
    pub fn sign(&self) -> i8 {
        if self.mean > self.half_width {
            1
        } else if self.mean < -self.half_width {
            -1
        } else {
            0
        }
    }
}
