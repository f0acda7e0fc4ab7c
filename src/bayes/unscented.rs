//! The unscented Kalman filter: a Gaussian sent through a non-linear model by its sigma points.
//!
//! Steps (Julier and Uhlmann 2004; scaled points: Julier 2002):
//! 1. sigma points chi_0 = x, chi_i = x +- column i of sqrt((n + beta) P), the root by Cholesky,
//! 2. predict: propagate the points; x- and P- are their weighted mean and covariance, P- plus Q if noise is additive
//!    (noise of another kind has sigma points of its own beside the state's),
//! 3. measure the points, the propagated ones or new ones of (x-, P-): Z_i = h(chi_i), z- their mean,
//!    S = R + sum W (Z_i - z-)(Z_i - z-)', C = sum W (chi_i - x-)(Z_i - z-)', K = C S^-1,
//! 4. correct: x = x- + K (z - z-), P = P- - K S K', computed as a sum of squares: with e_i = chi_i - x- - K (Z_i - z-)
//!    it is sum W e_i e_i' + K R K' (+ Q, if the points know nothing of it), which needs no subtraction.

use super::{
    Covariance, FilterError, State,
    gaussian::{Gaussian, GaussianNoise, Innovation, check_finite, cholesky, symmetric},
    model::{Dynamics, NoisyDynamics, Sensor},
};
use nalgebra::SMatrix;

mod sigma_points;

pub use sigma_points::SigmaPoints;
use sigma_points::{Spread, Weights};

/// Which points are measured in an update.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MeasuredPoints {
    /// New ones, drawn from the predicted mean and covariance: they know of additive process noise.
    #[default]
    Redrawn,
    /// Those that the prediction propagated: they carry on its skewness, but know of process noise only if that is general.
    Reused,
}

/// A belief that moves and is corrected by sigma points. `W` is how many components general process noise has; 0 if all
/// noise is additive.
#[derive(Debug, Clone, PartialEq)]
pub struct UnscentedKalmanFilter<const N: usize, const W: usize = 0> {
    belief: Gaussian<N>,
    measured_points: MeasuredPoints,
    sigma_points: SigmaPoints,
    /// Weights of the state's points, and of the state's and the noise's together.
    alone: Weights,
    joint: Weights,
    propagated: Option<Propagated<N, W>>,
}

/// The points that the last prediction propagated.
#[derive(Debug, Clone, PartialEq)]
struct Propagated<const N: usize, const W: usize> {
    points: Spread<N, N, W>,
    weights: Weights,
    /// What the points do not know of: Q if it is additive, else zero.
    noise: Covariance<N>,
}

impl<const N: usize> UnscentedKalmanFilter<N, 0> {
    /// Starts from a belief; all process noise is additive.
    ///
    /// # Errors
    /// [`FilterError::BadSpread`] if the sigma points cannot be of `N` components.
    pub fn new(
        belief: Gaussian<N>,
        sigma_points: SigmaPoints,
        measured_points: MeasuredPoints,
    ) -> Result<Self, FilterError> {
        Self::augmented(belief, sigma_points, measured_points)
    }
}

impl<const N: usize, const W: usize> UnscentedKalmanFilter<N, W> {
    /// Starts from a belief; general process noise has `W` components.
    ///
    /// # Errors
    /// [`FilterError::BadSpread`] if the sigma points cannot be of `N` or of `N` + `W` components.
    pub fn augmented(
        belief: Gaussian<N>,
        sigma_points: SigmaPoints,
        measured_points: MeasuredPoints,
    ) -> Result<Self, FilterError> {
        let (alone, joint) = (sigma_points.weights(N)?, sigma_points.weights(N + W)?);
        Ok(Self { belief, measured_points, sigma_points, alone, joint, propagated: None })
    }

    /// What is believed of the state now.
    pub fn belief(&self) -> &Gaussian<N> {
        &self.belief
    }

    /// Replaces the belief; the next update redraws its points.
    pub fn set_belief(&mut self, belief: Gaussian<N>) {
        self.belief = belief;
        self.propagated = None;
    }

    /// Which sigma points a prediction runs on, with the values chosen for the number of components.
    pub fn sigma_points(&self) -> SigmaPoints {
        self.sigma_points.resolve(N + W)
    }

    /// Steps 1 and 2 with additive noise.
    ///
    /// # Errors
    /// [`FilterError::CholeskyFailed`] if the covariance is not positive definite, [`FilterError::NotFinite`] if the
    /// model gives a NaN or an infinity. The belief then stays as it was.
    pub fn predict(
        &mut self,
        dynamics: &impl Dynamics<N>,
        noise: &GaussianNoise<N>,
    ) -> Result<&Gaussian<N>, FilterError> {
        let root = self.root(&self.alone)?;
        let points = Spread::around(&self.belief.mean, &root).map(|x| dynamics.propagate(x));
        self.adopt(points, self.alone, *noise.covariance())
    }

    /// Steps 1 and 2 with noise that enters the dynamics anywhere and has sigma points beside the state's.
    ///
    /// # Errors
    /// As [`predict`](Self::predict).
    pub fn predict_general(
        &mut self,
        dynamics: &impl NoisyDynamics<N, W>,
        noise: &GaussianNoise<W>,
    ) -> Result<&Gaussian<N>, FilterError> {
        let root = self.root(&self.joint)?;
        let noise_root = noise.factor() * self.joint.spread.sqrt();
        let points = Spread::joint(&self.belief.mean, &root, &noise_root, |x, w| dynamics.propagate(x, w));
        self.adopt(points, self.joint, Covariance::zeros())
    }

    /// Steps 3 and 4.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] if the measurement or its prediction holds a NaN or an infinity,
    /// [`FilterError::CholeskyFailed`] if the predicted covariance is not positive definite,
    /// [`FilterError::SingularInnovation`] if S cannot be inverted. The belief then stays as it was.
    pub fn update<const M: usize>(
        &mut self,
        sensor: &impl Sensor<N, M>,
        noise: &GaussianNoise<M>,
        measured: &State<M>,
    ) -> Result<Innovation<M>, FilterError> {
        check_finite(measured, "the measurement")?;
        let reused = self.propagated.take().filter(|_| self.measured_points == MeasuredPoints::Reused);
        let Propagated { points, weights, noise: unknown } = match &reused {
            Some(propagated) => propagated.clone(),
            None => self.redrawn()?,
        };
        let outcome = self.correct(&points, &weights, &unknown, sensor, noise, measured);
        match outcome {
            Ok((belief, innovation)) => {
                self.belief = belief;
                Ok(innovation)
            }
            Err(error) => {
                self.propagated = reused;
                Err(error)
            }
        }
    }

    /// Step 1: the scaled root of the covariance.
    fn root(&self, weights: &Weights) -> Result<Covariance<N>, FilterError> {
        Ok(cholesky(&self.belief.covariance, "the covariance")?.l() * weights.spread.sqrt())
    }

    /// The end of step 2.
    fn adopt(
        &mut self,
        points: Spread<N, N, W>,
        weights: Weights,
        noise: Covariance<N>,
    ) -> Result<&Gaussian<N>, FilterError> {
        let mean = points.mean(&weights);
        check_finite(&mean, "the predicted mean")?;
        let covariance = symmetric(&(points.covariance(&mean, &weights) + noise));
        check_finite(&covariance, "the predicted covariance")?;
        self.belief = Gaussian { mean, covariance };
        self.propagated = Some(Propagated { points, weights, noise });
        Ok(&self.belief)
    }

    fn redrawn(&self) -> Result<Propagated<N, W>, FilterError> {
        let points = Spread::around(&self.belief.mean, &self.root(&self.alone)?);
        Ok(Propagated { points, weights: self.alone, noise: Covariance::zeros() })
    }

    fn correct<const M: usize>(
        &self,
        points: &Spread<N, N, W>,
        weights: &Weights,
        unknown: &Covariance<N>,
        sensor: &impl Sensor<N, M>,
        noise: &GaussianNoise<M>,
        measured: &State<M>,
    ) -> Result<(Gaussian<N>, Innovation<M>), FilterError> {
        let mean = &self.belief.mean;
        let seen = points.map(|x| sensor.measure(x));
        let predicted = seen.mean(weights);
        let spread = seen.covariance(&predicted, weights) + noise.covariance();
        let innovation = Innovation::new(measured - predicted, symmetric(&spread))?;
        let cross: SMatrix<f64, N, M> =
            points.weighted_sum(&seen, weights, |chi, z| (chi - mean) * (z - predicted).transpose());
        let gain = innovation.gain(&cross);
        let errors: Covariance<N> = points.weighted_sum(&seen, weights, |chi, z| {
            let error = chi - mean - gain * (z - predicted);
            error * error.transpose()
        });
        let covariance = errors + gain * noise.covariance() * gain.transpose() + unknown;
        let mean = mean + gain * innovation.residual;
        Ok((Gaussian { mean, covariance: symmetric(&covariance) }, innovation))
    }
}

#[cfg(test)]
mod tests;
