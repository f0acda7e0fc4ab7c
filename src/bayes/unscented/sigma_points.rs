//! Sigma points: where they lie, what they weigh, and sums over them.

use std::array;

use nalgebra::SMatrix;

use crate::bayes::{Covariance, FilterError, State};

/// How far sigma points lie from the mean, and what they weigh. n is the number of components.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum SigmaPoints {
    /// For Gaussian beliefs: [`Symmetric`](Self::Symmetric) with n + beta = 3 up to three components, as the
    /// fourth moment asks; beyond, where the centre would weigh less than nothing, [`Scaled`](Self::Scaled) with
    /// alpha 0.6, beta 2, kappa 0, whose covariance weights are never negative.
    #[default]
    Auto,
    /// Points at sqrt(n + beta) standard deviations, weights beta / (n + beta) and 1 / (2 (n + beta)). With a negative
    /// beta a covariance can become indefinite.
    Symmetric {
        /// Above -n.
        beta: f64,
    },
    /// Points at alpha sqrt(n + kappa) standard deviations (Julier 2002), so that they need not spread with n.
    Scaled {
        /// How far the points are, > 0.
        alpha: f64,
        /// Knowledge of the fourth moment, added to the centre's covariance weight: 2 for a Gaussian.
        beta: f64,
        /// Above -n.
        kappa: f64,
    },
}

impl SigmaPoints {
    /// The same with [`Auto`](Self::Auto) replaced by what it is for `n` components.
    pub fn resolve(self, n: usize) -> Self {
        match self {
            Self::Auto if n <= 3 => Self::Symmetric { beta: 3.0 - n as f64 },
            Self::Auto => Self::Scaled { alpha: 0.6, beta: 2.0, kappa: 0.0 },
            chosen => chosen,
        }
    }

    pub(super) fn weights(self, n: usize) -> Result<Weights, FilterError> {
        let components = n as f64;
        let (spread, excess) = match self.resolve(n) {
            Self::Scaled { alpha, beta, kappa } => {
                (alpha * alpha * (components + kappa), 1.0 - alpha * alpha + beta)
            }
            Self::Symmetric { beta } => (components + beta, 0.0),
            Self::Auto => (3.0, 0.0),
        };
        if !(spread > 0.0 && spread.is_finite() && excess.is_finite()) {
            return Err(FilterError::BadSpread { spread });
        }
        let centre = (spread - components) / spread;
        Ok(Weights { spread, centre_mean: centre, centre_covariance: centre + excess, other: 0.5 / spread })
    }
}

/// Weights of sigma points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weights {
    /// n + beta, or alpha^2 (n + kappa): points lie at its root.
    pub spread: f64,
    /// The centre's in means.
    pub centre_mean: f64,
    /// The centre's in covariances.
    pub centre_covariance: f64,
    /// Every other point's.
    pub other: f64,
}

/// A value of `M` numbers at every sigma point: the centre, `N` pairs of the state, `W` pairs of the noise, which are
/// not there (`None`) if the noise has no points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spread<const M: usize, const N: usize, const W: usize> {
    centre: State<M>,
    pairs: [[State<M>; 2]; N],
    noise_pairs: Option<[[State<M>; 2]; W]>,
}

impl<const N: usize, const W: usize> Spread<N, N, W> {
    /// The points of a mean and a scaled root of its covariance.
    pub fn around(mean: &State<N>, root: &Covariance<N>) -> Self {
        let pairs = array::from_fn(|i| [mean + root.column(i), mean - root.column(i)]);
        Self { centre: *mean, pairs, noise_pairs: None }
    }

    /// The points of a mean and of zero-mean noise beside it, sent through `function`.
    pub fn joint(
        mean: &State<N>,
        root: &Covariance<N>,
        noise_root: &Covariance<W>,
        function: impl Fn(&State<N>, &State<W>) -> State<N>,
    ) -> Self {
        let calm = State::zeros();
        let noise = |i: usize| {
            let column: State<W> = noise_root.column(i).into();
            [function(mean, &column), function(mean, &-column)]
        };
        Self {
            noise_pairs: Some(array::from_fn(noise)),
            ..Self::around(mean, root).map(|x| function(x, &calm))
        }
    }
}

impl<const M: usize, const N: usize, const W: usize> Spread<M, N, W> {
    /// `function` of every point.
    pub fn map<const L: usize>(&self, function: impl Fn(&State<M>) -> State<L>) -> Spread<L, N, W> {
        let both = |pair: &[State<M>; 2]| [function(&pair[0]), function(&pair[1])];
        Spread {
            centre: function(&self.centre),
            pairs: array::from_fn(|i| both(&self.pairs[i])),
            noise_pairs: self.noise_pairs.as_ref().map(|pairs| array::from_fn(|i| both(&pairs[i]))),
        }
    }

    /// Weighted mean.
    pub fn mean(&self, weights: &Weights) -> State<M> {
        let others = self.others().fold(State::zeros(), |sum, point| sum + point);
        self.centre * weights.centre_mean + others * weights.other
    }

    /// Weighted covariance about `mean`.
    pub fn covariance(&self, mean: &State<M>, weights: &Weights) -> Covariance<M> {
        self.weighted_sum(self, weights, |point, _| {
            let deviation = point - mean;
            deviation * deviation.transpose()
        })
    }

    /// sum over points of covariance weight * term(own value, the other's value).
    pub fn weighted_sum<const L: usize, const R: usize, const C: usize>(
        &self,
        other: &Spread<L, N, W>,
        weights: &Weights,
        term: impl Fn(&State<M>, &State<L>) -> SMatrix<f64, R, C>,
    ) -> SMatrix<f64, R, C> {
        let sum = self.others().zip(other.others()).fold(SMatrix::zeros(), |sum, (a, b)| sum + term(a, b));
        term(&self.centre, &other.centre) * weights.centre_covariance + sum * weights.other
    }

    fn others(&self) -> impl Iterator<Item = &State<M>> {
        self.pairs.iter().flatten().chain(self.noise_pairs.iter().flatten().flatten())
    }
}
