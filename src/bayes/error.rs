//! What can be wrong with what a filter is given, or become wrong in a step.

use thiserror::Error;

/// Why a filter refuses an input or a step. A step that fails leaves the filter as it was.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum FilterError {
    /// A NaN or an infinity.
    #[error(
        "{what} holds a NaN or an infinity: skip the update of a step without a measurement, and check the model"
    )]
    NotFinite {
        /// What holds it.
        what: &'static str,
    },
    /// A covariance that differs from its transpose.
    #[error("{what} is not symmetric at ({row}, {column}): give (P + P') / 2")]
    NotSymmetric {
        /// Which covariance.
        what: &'static str,
        /// Row of the worst element, counted from 0.
        row: usize,
        /// Column of the worst element, counted from 0.
        column: usize,
    },
    /// A covariance with a negative eigenvalue.
    #[error("{what} is not positive semi-definite: give variances >= 0 and correlations within [-1, 1]")]
    Indefinite {
        /// Which covariance.
        what: &'static str,
    },
    /// S = H P H' + R cannot be inverted.
    #[error("the innovation covariance is singular: give every measured component a noise variance above 0")]
    SingularInnovation,
    /// A square root was needed of a matrix that is not positive definite.
    #[error(
        "{what} has no Cholesky factor: start from variances above 0, add process noise, or scale the sigma points"
    )]
    CholeskyFailed {
        /// Which covariance.
        what: &'static str,
    },
    /// Sigma points whose spread would not be real or whose weights would be infinite.
    #[error("the sigma points' spread is {spread}, not above 0: choose n + beta > 0, or alpha > 0")]
    BadSpread {
        /// n + beta, or alpha^2 (n + kappa) when scaled.
        spread: f64,
    },
    /// A particle filter without particles.
    #[error("a particle filter needs at least one particle: give more than 0")]
    NoParticles,
}
