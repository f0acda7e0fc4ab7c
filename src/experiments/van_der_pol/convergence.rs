//! How fast a particle filter comes near the exact posterior mean as its particles grow: against a filter of very many
//! particles, not against the truth, from which the exact mean itself differs.

use rayon::prelude::*;
use serde::Serialize;

use super::{ExperimentError, Filter, Setup, truth};

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Convergence {
    /// What the runs were made of.
    pub setup: Setup,
    /// Runs, each with measurements of its own.
    pub runs: usize,
    /// Seed of all random streams.
    pub seed: u64,
    /// Particles of the reference.
    pub reference: usize,
    /// A point for each number of particles.
    pub points: Vec<ConvergencePoint>,
    /// Slope of the least-squares line of ln difference over ln particles: -1/2 in theory.
    pub slope: f64,
}

/// The difference at one number of particles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ConvergencePoint {
    /// Particles.
    pub particles: usize,
    /// Root of the mean squared difference of the estimate of x from the reference's, over samples and runs.
    pub rms_difference: f64,
}

/// Compares filters of each of `sizes` particles with one of `reference` particles.
///
/// # Errors
/// [`ExperimentError`] if the set-up is out of range, or the sizes leave no slope.
pub fn convergence(
    setup: &Setup,
    sizes: &[usize],
    reference: usize,
    runs: usize,
    seed: u64,
) -> Result<Convergence, ExperimentError> {
    setup.check()?;
    let distinct = sizes.iter().any(|&size| size != sizes[0]);
    if !distinct || sizes.iter().any(|&size| size == 0 || size >= reference) {
        return Err(ExperimentError::NoSlope { reference });
    }
    if runs == 0 {
        return Err(ExperimentError::TooFewRuns(runs));
    }
    let truth = truth(setup.mu);
    // Sums of squared differences: [run][size].
    let sums: Vec<Vec<f64>> = (0..runs)
        .into_par_iter()
        .map(|run| {
            let measured = setup.measure(&truth, seed, run);
            let track = |particles: usize, index: usize| {
                Filter::Particle(particles).track(setup, &measured, seed, run, index).beliefs
            };
            let exact = track(reference, 0);
            let squared = |(index, &size): (usize, &usize)| -> f64 {
                let found = track(size, index + 1);
                found.iter().zip(&exact).map(|(a, b)| (a.mean[0] - b.mean[0]).powi(2)).sum()
            };
            sizes.iter().enumerate().map(squared).collect()
        })
        .collect();
    let samples = (runs * truth.len()) as f64;
    let point = |(index, &particles): (usize, &usize)| {
        let sum: f64 = sums.iter().map(|run| run[index]).sum();
        ConvergencePoint { particles, rms_difference: (sum / samples).sqrt() }
    };
    let points: Vec<ConvergencePoint> = sizes.iter().enumerate().map(point).collect();
    let slope = slope(&points);
    Ok(Convergence { setup: *setup, runs, seed, reference, points, slope })
}

/// Least squares over logarithms.
fn slope(points: &[ConvergencePoint]) -> f64 {
    let logs = || points.iter().map(|p| ((p.particles as f64).ln(), p.rms_difference.ln()));
    let n = points.len() as f64;
    let (mean_x, mean_y) = (logs().map(|l| l.0).sum::<f64>() / n, logs().map(|l| l.1).sum::<f64>() / n);
    let covariance: f64 = logs().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    covariance / logs().map(|(x, _)| (x - mean_x).powi(2)).sum::<f64>()
}
