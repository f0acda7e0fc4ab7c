//! Filters compared over many runs, each of which gives every filter the same measurements.

use rayon::prelude::*;
use serde::Serialize;

use super::{ExperimentError, Filter, SAMPLES, Setup, Statistic, Track, truth};
use crate::bayes::State;

/// What a comparison found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// What the runs were made of.
    pub setup: Setup,
    /// How many.
    pub runs: usize,
    /// Seed of all random streams.
    pub seed: u64,
    /// A score for each filter, in their order.
    pub filters: Vec<FilterScore>,
    /// Each filter against the next.
    pub gaps: Vec<Gap>,
    /// Share of the runs in which every filter errs more than the next: what a single run would have shown.
    pub share_in_order: f64,
}

/// How a filter did. Means over runs with intervals of 95 % confidence.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FilterScore {
    /// Name of the filter.
    pub filter: String,
    /// Root of the mean squared error of x over a run's samples.
    pub rmse: Statistic,
    /// The same of x'.
    pub rmse_of_velocity: Statistic,
    /// Root of the mean over samples of the squared mean error of x over runs.
    pub bias: f64,
    /// Normalised estimation error squared, mean over a run: 2 if covariances are right, more if they are too small.
    pub nees: Statistic,
    /// Median over runs of the wall time of a run.
    pub seconds: f64,
    /// Runs in which the filter broke down.
    pub failed: usize,
}

/// How much more one filter errs than the next, run by run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gap {
    /// The filter that errs more if the difference is above 0.
    pub first: String,
    /// The other.
    pub second: String,
    /// Mean of the differences of the RMSE of x.
    pub rmse_difference: Statistic,
}

/// Runs `filters` over `runs` runs, which are spread over threads; the result, but for times, does not depend on them.
///
/// # Errors
/// [`ExperimentError`] if the set-up is out of range, there are fewer than two runs, or no particles.
pub fn compare(
    setup: &Setup,
    filters: &[Filter],
    runs: usize,
    seed: u64,
) -> Result<Comparison, ExperimentError> {
    setup.check()?;
    if runs < 2 {
        return Err(ExperimentError::TooFewRuns(runs));
    }
    if filters.contains(&Filter::Particle(0)) {
        return Err(ExperimentError::NoParticles);
    }
    let truth = truth(setup.mu);
    // All filters of a run: RunScore[run][filter].
    let scores: Vec<Vec<RunScore>> = (0..runs)
        .into_par_iter()
        .map(|run| {
            let measured = setup.measure(&truth, seed, run);
            let track = |(index, filter): (usize, &Filter)| filter.track(setup, &measured, seed, run, index);
            filters.iter().enumerate().map(track).map(|track| RunScore::of(&track, &truth)).collect()
        })
        .collect();
    let of_filter = |index: usize| scores.iter().map(move |run| &run[index]);
    let score = |(index, filter): (usize, &Filter)| FilterScore::of(filter, of_filter(index));
    let gap = |(index, pair): (usize, &[Filter])| Gap {
        first: pair[0].to_string(),
        second: pair[1].to_string(),
        rmse_difference: Statistic::of(scores.iter().map(|run| run[index].rmse - run[index + 1].rmse)),
    };
    let in_order = |run: &&Vec<RunScore>| run.is_sorted_by(|first, second| first.rmse > second.rmse);
    let share_in_order = scores.iter().filter(in_order).count() as f64 / runs as f64;
    let gaps = filters.windows(2).enumerate().map(gap).collect();
    let filters = filters.iter().enumerate().map(score).collect();
    Ok(Comparison { setup: *setup, runs, seed, filters, gaps, share_in_order })
}

/// How a filter did in one run.
struct RunScore {
    rmse: f64,
    rmse_of_velocity: f64,
    nees: f64,
    errors: Vec<f64>,
    seconds: f64,
    failed: bool,
}

impl RunScore {
    fn of(track: &Track, truth: &[State<2>]) -> Self {
        let errors = || track.beliefs.iter().zip(truth).map(|(belief, truth)| belief.mean - truth);
        let rmse =
            |component: usize| (errors().map(|e| e[component].powi(2)).sum::<f64>() / SAMPLES as f64).sqrt();
        // A covariance without an inverse, as of a single particle, is infinitely too small.
        let nees = track.beliefs.iter().zip(truth).map(|(b, t)| b.nees(t).unwrap_or(f64::INFINITY));
        Self {
            rmse: rmse(0),
            rmse_of_velocity: rmse(1),
            nees: nees.sum::<f64>() / SAMPLES as f64,
            errors: errors().map(|e| e[0]).collect(),
            seconds: track.seconds,
            failed: track.failed,
        }
    }
}

impl FilterScore {
    fn of<'a>(filter: &Filter, runs: impl ExactSizeIterator<Item = &'a RunScore> + Clone) -> Self {
        let n = runs.len() as f64;
        let mean_error = |k: usize| runs.clone().map(|run| run.errors[k]).sum::<f64>() / n;
        let bias = ((0..SAMPLES).map(|k| mean_error(k).powi(2)).sum::<f64>() / SAMPLES as f64).sqrt();
        let mut seconds: Vec<f64> = runs.clone().map(|run| run.seconds).collect();
        seconds.sort_unstable_by(f64::total_cmp);
        Self {
            filter: filter.to_string(),
            rmse: Statistic::of(runs.clone().map(|run| run.rmse)),
            rmse_of_velocity: Statistic::of(runs.clone().map(|run| run.rmse_of_velocity)),
            bias,
            nees: Statistic::of(runs.clone().map(|run| run.nees)),
            seconds: seconds[seconds.len() / 2],
            failed: runs.filter(|run| run.failed).count(),
        }
    }
}
