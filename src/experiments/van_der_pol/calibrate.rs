//! The measurement variance that goes with a process variance, so that the extended filter errs as in the paper.

use super::{ExperimentError, Filter, NoiseShape, Setup, compare};

/// RMSE of the extended Kalman filter in Table II of the paper.
pub const PUBLISHED_EKF_RMSE: f64 = 0.0328;

/// Halvings of the interval of logarithms of the variance.
const HALVINGS: usize = 30;
const SMALLEST: f64 = 1e-6;
const LARGEST: f64 = 10.0;

/// The r at which the mean RMSE of the extended filter over `runs` runs of Gaussian noise is [`PUBLISHED_EKF_RMSE`], by
/// bisection; every r sees the same random numbers.
///
/// # Errors
/// [`ExperimentError`] if there is none between 1e-6 and 10, or mu, q or `runs` is out of range.
pub fn calibrated(mu: f64, process_variance: f64, runs: usize, seed: u64) -> Result<f64, ExperimentError> {
    let rmse = |measurement_variance: f64| {
        let setup = Setup { mu, process_variance, measurement_variance, noise: NoiseShape::Gauss };
        Ok(compare(&setup, &[Filter::Extended], runs, seed)?.filters[0].rmse.mean)
    };
    if !(rmse(SMALLEST)? < PUBLISHED_EKF_RMSE && rmse(LARGEST)? > PUBLISHED_EKF_RMSE) {
        return Err(ExperimentError::NoCalibration { process_variance });
    }
    let (mut low, mut high) = (SMALLEST.ln(), LARGEST.ln());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if rmse(middle.exp())? < PUBLISHED_EKF_RMSE { low = middle } else { high = middle }
    }
    Ok((0.5 * (low + high)).exp())
}
