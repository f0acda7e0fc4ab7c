//! The filters of the experiment, run over a run's measurements.

use std::{fmt, time::Instant};

use super::{Setup, Use, first_belief, noise::Seen, oscillator::Position, stream};
use crate::bayes::{
    Covariance, FilterError, State,
    extended::ExtendedKalmanFilter,
    gaussian::{Gaussian, GaussianNoise},
    model::Disturbed,
    particle::{ParticleFilter, ParticleFilterOptions},
    unscented::{MeasuredPoints, SigmaPoints, UnscentedKalmanFilter},
};

/// A filter to compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Filter {
    /// Extended Kalman filter.
    Extended,
    /// Unscented Kalman filter, n + beta = 3; its points redrawn for the measurement, or reused as in the paper.
    Unscented(MeasuredPoints),
    /// Particle filter with the transition as proposal, systematic resampling below half of N.
    Particle(usize),
}

impl fmt::Display for Filter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Extended => f.pad("EKF"),
            Self::Unscented(MeasuredPoints::Redrawn) => f.pad("UKF"),
            Self::Unscented(MeasuredPoints::Reused) => f.pad("UKF, reused"),
            Self::Particle(n) => f.pad(&format!("PF-{n}")),
        }
    }
}

/// What a filter believed at every sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Beliefs after each measurement.
    pub beliefs: Vec<Gaussian<2>>,
    /// Wall time of all steps.
    pub seconds: f64,
    /// Whether the filter broke down; its last belief then stands for the rest.
    pub failed: bool,
}

impl Filter {
    /// Filters `measured` on the calling thread. `index` tells the streams of several particle filters apart.
    pub fn track(self, setup: &Setup, measured: &[f64], seed: u64, run: usize, index: usize) -> Track {
        let mut beliefs = Vec::with_capacity(measured.len());
        let begin = Instant::now();
        let outcome = match self {
            Self::Extended => extended(setup, measured, &mut beliefs),
            Self::Unscented(points) => unscented(setup, measured, points, &mut beliefs),
            Self::Particle(n) => {
                particle(setup, measured, n, &mut stream(seed, run, Use::Particles(index)), &mut beliefs)
            }
        };
        let seconds = begin.elapsed().as_secs_f64();
        let last = beliefs.last().copied().unwrap_or_else(first_belief);
        beliefs.resize(measured.len(), last);
        Track { beliefs, seconds, failed: outcome.is_err() }
    }
}

fn extended(setup: &Setup, measured: &[f64], out: &mut Vec<Gaussian<2>>) -> Result<(), FilterError> {
    let (dynamics, process_noise) = (setup.dynamics(), setup.process_noise());
    let noise = GaussianNoise::diagonal(&State::<1>::new(setup.measurement_variance))?;
    let mut filter = ExtendedKalmanFilter::new(first_belief());
    for (k, &x) in measured.iter().enumerate() {
        if k > 0 {
            filter.predict(&dynamics, &process_noise)?;
        }
        filter.update(&Position, &noise, &State::<1>::new(x))?;
        out.push(*filter.belief());
    }
    Ok(())
}

fn unscented(
    setup: &Setup,
    measured: &[f64],
    points: MeasuredPoints,
    out: &mut Vec<Gaussian<2>>,
) -> Result<(), FilterError> {
    let (dynamics, process_noise) = (setup.dynamics(), setup.process_noise());
    let noise = GaussianNoise::diagonal(&State::<1>::new(setup.measurement_variance))?;
    let mut filter = UnscentedKalmanFilter::new(first_belief(), SigmaPoints::Auto, points)?;
    for (k, &x) in measured.iter().enumerate() {
        if k > 0 {
            filter.predict(&dynamics, &process_noise)?;
        }
        filter.update(&Position, &noise, &State::<1>::new(x))?;
        out.push(*filter.belief());
    }
    Ok(())
}

fn particle(
    setup: &Setup,
    measured: &[f64],
    particles: usize,
    rng: &mut impl rand::Rng,
    out: &mut Vec<Gaussian<2>>,
) -> Result<(), FilterError> {
    let (dynamics, process_noise, noise) =
        (setup.dynamics(), setup.process_noise(), setup.measurement_noise());
    let transition = Disturbed { dynamics: &dynamics, noise: &process_noise };
    let first = first_belief();
    let spread = GaussianNoise::new(first.covariance)?;
    let states = (0..particles).map(|_| first.mean + spread.sample(rng)).collect();
    let mut filter = ParticleFilter::try_new(states, ParticleFilterOptions::default())?.on_one_thread();
    for (k, &x) in measured.iter().enumerate() {
        if k > 0 {
            filter.predict(&transition, rng);
        }
        let found = filter.correct(&Seen { x, noise: &noise }, rng);
        out.push(finite(found.mean, found.covariance)?);
    }
    Ok(())
}

fn finite(mean: State<2>, covariance: Covariance<2>) -> Result<Gaussian<2>, FilterError> {
    if mean.iter().chain(covariance.iter()).all(|value| value.is_finite()) {
        Ok(Gaussian { mean, covariance })
    } else {
        Err(FilterError::NotFinite { what: "the particles' mean" })
    }
}
