//! Experiment A of Nguyen and Dao, "Performance evaluation of tracking algorithms for moving objects": the state of a
//! Van der Pol oscillator, x'' - mu (1 - x^2) x' + x = 0, estimated from noisy measurements of x by the extended and the
//! unscented Kalman filter and by particle filters.
//!
//! The paper gives the oscillator, 101 samples and the filters' errors and times. The rest is the textbook set-up:
//! samples at t = 0, 0.05, ... 5, the truth integrated finely from x = 2, x' = 0, filters that take one Euler step of
//! 0.05 from sample to sample, add process noise of variance q a step to x and to x', and start from N((2, 0), 0.01 I).
//! Neither q nor the measurements' variance r is known; [`calibrated`] gives, for a q, the r at which the extended
//! filter errs as much as it did in the paper.

mod calibrate;
mod convergence;
mod filters;
mod monte_carlo;
mod noise;
mod oscillator;
mod plot;
mod statistic;

pub use calibrate::{PUBLISHED_EKF_RMSE, calibrated};
pub use convergence::{Convergence, ConvergencePoint, convergence};
pub use filters::{Filter, Track};
pub use monte_carlo::{Comparison, FilterScore, Gap, compare};
pub use noise::{MeasurementNoise, NoiseShape};
pub use oscillator::{EulerStep, Position, truth};
pub use plot::plot;
pub use statistic::Statistic;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use thiserror::Error;

use crate::bayes::{State, gaussian::Gaussian, gaussian::GaussianNoise};

/// Samples of a run.
pub const SAMPLES: usize = 101;
/// Seconds between samples, and the Euler step of the filters.
pub const TIME_STEP: f64 = 0.05;
/// x and x' at the first sample.
pub const START: [f64; 2] = [2.0, 0.0];
/// Variance of x and of x' in what the filters believe at first.
pub const START_VARIANCE: f64 = 0.01;
/// The largest mu of which one Euler step is a model at all.
pub const LARGEST_MU: f64 = 10.0;

/// What a run is made of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Setup {
    /// Strength of the non-linearity, in (0, [`LARGEST_MU`]].
    pub mu: f64,
    /// q: variance of the process noise that filters assume, of x and of x' a step, > 0.
    pub process_variance: f64,
    /// r: variance of the measurements of x, > 0.
    pub measurement_variance: f64,
    /// Distribution of the measurements' errors. The Kalman filters assume a Gaussian; particle filters know it.
    pub noise: NoiseShape,
}

/// Why an experiment cannot be run.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// mu out of range.
    #[error(
        "mu is {0}: give a number above 0 and at most {LARGEST_MU}, beyond which Euler steps of {TIME_STEP} s are unstable"
    )]
    Mu(f64),
    /// A variance that is not positive.
    #[error("the {what} variance is {value}: give a number above 0 and at most 1000")]
    Variance {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// Too few runs for an interval of confidence.
    #[error("{0} runs leave no interval of confidence: give at least 2")]
    TooFewRuns(usize),
    /// A particle filter without particles.
    #[error("a particle filter needs particles: give at least 1")]
    NoParticles,
    /// Too few sizes of particle filters for a slope.
    #[error("a slope needs two different numbers of particles, each below the reference's {reference}")]
    NoSlope {
        /// Particles of the reference.
        reference: usize,
    },
    /// No measurement variance at which the extended filter errs as in the paper.
    #[error(
        "with process variance {process_variance} no measurement variance gives the extended filter an RMSE of \
         {PUBLISHED_EKF_RMSE}: give another process variance, or the measurement variance itself"
    )]
    NoCalibration {
        /// q.
        process_variance: f64,
    },
}

impl Setup {
    /// An error unless every number is in its range.
    ///
    /// # Errors
    /// [`ExperimentError`], naming what is out of range.
    pub fn check(&self) -> Result<(), ExperimentError> {
        if !(self.mu > 0.0 && self.mu <= LARGEST_MU) {
            return Err(ExperimentError::Mu(self.mu));
        }
        for (what, value) in [("process", self.process_variance), ("measurement", self.measurement_variance)]
        {
            if !(value > 0.0 && value <= 1000.0) {
                return Err(ExperimentError::Variance { what, value });
            }
        }
        Ok(())
    }

    fn dynamics(&self) -> EulerStep {
        EulerStep { mu: self.mu, step: TIME_STEP }
    }

    fn process_noise(&self) -> GaussianNoise<2> {
        GaussianNoise::diagonal(&State::<2>::repeat(self.process_variance)).expect("a checked variance")
    }

    fn measurement_noise(&self) -> MeasurementNoise {
        MeasurementNoise::new(self.noise, self.measurement_variance)
    }

    /// The measurements of a run: `truth` plus noise.
    fn measure(&self, truth: &[State<2>], seed: u64, run: usize) -> Vec<f64> {
        let mut rng = stream(seed, run, Use::Measurements);
        let noise = self.measurement_noise();
        truth.iter().map(|state| state[0] + noise.sample(&mut rng)).collect()
    }
}

/// What every filter believes at first.
fn first_belief() -> Gaussian<2> {
    let covariance = nalgebra::Matrix2::identity() * START_VARIANCE;
    Gaussian { mean: State::from(START), covariance }
}

/// What randomness is used for.
#[derive(Debug, Clone, Copy)]
enum Use {
    Measurements,
    /// The particle filter of this index.
    Particles(usize),
}

/// The generator of one use in one run.
fn stream(seed: u64, run: usize, purpose: Use) -> ChaCha8Rng {
    let purpose = match purpose {
        Use::Measurements => 0,
        Use::Particles(index) => 1 + index as u64,
    };
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream((run as u64).wrapping_mul(256).wrapping_add(purpose));
    generator
}

#[cfg(test)]
mod tests;
