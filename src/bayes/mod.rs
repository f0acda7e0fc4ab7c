//! Bayesian filtering of a hidden state, knowing nothing of images.
//!
//! A filter keeps p(x_k | y_1:k) for a hidden state x with a transition p(x_k | x_k-1) and an observation
//! p(y_k | x_k). A particle filter needs no more than to draw and to weigh: [`Transition`], [`Observation`] and
//! [`Proposal`]. The Kalman family needs functions and Gaussian noise: [`model::Dynamics`], [`model::Sensor`] and
//! [`gaussian::GaussianNoise`], which [`model::Disturbed`] and [`model::Measured`] make into the former, so that every
//! filter runs on one model.

mod error;
pub mod extended;
pub mod gaussian;
pub mod kalman;
pub mod kernel;
pub mod model;
pub mod particle;
pub mod random_walk;
pub mod resampling;
pub mod unscented;
pub mod weights;

pub use error::FilterError;

use nalgebra::{SMatrix, SVector};
use rand::Rng;

/// A state of `N` real components.
pub type State<const N: usize> = SVector<f64, N>;
/// A covariance (or another square matrix) over a state of `N` components.
pub type Covariance<const N: usize> = SMatrix<f64, N, N>;

/// How the hidden state moves: p(x_k | x_k-1).
pub trait Transition<const N: usize> {
    /// Draws x_k given x_k-1 = `previous`.
    fn sample<R: Rng + ?Sized>(&self, previous: &State<N>, rng: &mut R) -> State<N>;

    /// ln p(x_k = `next` | x_k-1 = `previous`); -inf where it cannot happen.
    fn log_density(&self, next: &State<N>, previous: &State<N>) -> f64;
}

/// How well a state explains what was observed: p(y_k | x_k) for the y_k at hand.
pub trait Observation<const N: usize> {
    /// ln p(y_k | x_k = `state`), up to a constant that is the same for every state; -inf where it cannot be.
    fn log_likelihood(&self, state: &State<N>) -> f64;

    /// [`log_likelihood`](Self::log_likelihood) of many states at once, for observations that can share work.
    /// `out` is as long as `states`.
    fn log_likelihoods(&self, states: &[State<N>], out: &mut [f64]) {
        for (state, value) in states.iter().zip(out) {
            *value = self.log_likelihood(state);
        }
    }
}

/// Where a particle filter draws from: q(x_k | x_k-1, y_k). Whatever it is, the weights carry
/// p(x_k | x_k-1) / q(x_k | x_k-1, y_k), or the filter would be biased.
pub trait Proposal<const N: usize> {
    /// Draws x_k given x_k-1 = `previous`.
    fn sample<R: Rng + ?Sized>(&self, previous: &State<N>, rng: &mut R) -> State<N>;

    /// ln q(x_k = `next` | x_k-1 = `previous`, y_k). Finite wherever the transition and the likelihood are not zero.
    fn log_density(&self, next: &State<N>, previous: &State<N>) -> f64;
}
