//! The extended Kalman filter: a non-linear model, made linear at the estimate.
//!
//! Steps:
//! 1. Jacobians F = df/dx and, for general noise, W = df/dw at (x, 0),
//! 2. predict: x- = f(x, 0), P- = F P F' + W Q W' (additive noise: W = I),
//! 3. Jacobian H = dh/dx at x-, innovation z - h(x-), S = H P- H' + R, gain K = P- H' S^-1,
//! 4. correct: x = x- + K (z - h(x-)), P = P- - K S K', computed in Joseph's form.

use super::{
    Covariance, FilterError, State,
    gaussian::{Gaussian, GaussianNoise, Innovation, check_finite},
    model::{Dynamics, NoisyDynamics, Sensor},
};

/// A belief that moves and is corrected by models linearised at its mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExtendedKalmanFilter<const N: usize> {
    belief: Gaussian<N>,
}

impl<const N: usize> ExtendedKalmanFilter<N> {
    /// Starts from a belief.
    pub fn new(belief: Gaussian<N>) -> Self {
        Self { belief }
    }

    /// What is believed of the state now.
    pub fn belief(&self) -> &Gaussian<N> {
        &self.belief
    }

    /// Replaces the belief.
    pub fn set_belief(&mut self, belief: Gaussian<N>) {
        self.belief = belief;
    }

    /// Steps 1 and 2 with additive noise.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] if the model gives a NaN or an infinity. The belief then stays as it was.
    pub fn predict(
        &mut self,
        dynamics: &impl Dynamics<N>,
        noise: &GaussianNoise<N>,
    ) -> Result<&Gaussian<N>, FilterError> {
        let x = &self.belief.mean;
        self.belief = self.belief.moved(dynamics.propagate(x), &dynamics.jacobian(x), noise.covariance())?;
        Ok(&self.belief)
    }

    /// Steps 1 and 2 with noise that enters the dynamics anywhere.
    ///
    /// # Errors
    /// As [`predict`](Self::predict).
    pub fn predict_general<const W: usize>(
        &mut self,
        dynamics: &impl NoisyDynamics<N, W>,
        noise: &GaussianNoise<W>,
    ) -> Result<&Gaussian<N>, FilterError> {
        let x = &self.belief.mean;
        let spread = dynamics.noise_jacobian(x) * noise.factor();
        let noise: Covariance<N> = spread * spread.transpose();
        let mean = dynamics.propagate(x, &State::zeros());
        self.belief = self.belief.moved(mean, &dynamics.state_jacobian(x), &noise)?;
        Ok(&self.belief)
    }

    /// Steps 3 and 4.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] if the measurement or its prediction holds a NaN or an infinity,
    /// [`FilterError::SingularInnovation`] if S cannot be inverted. The belief then stays as it was.
    pub fn update<const M: usize>(
        &mut self,
        sensor: &impl Sensor<N, M>,
        noise: &GaussianNoise<M>,
        measured: &State<M>,
    ) -> Result<Innovation<M>, FilterError> {
        check_finite(measured, "the measurement")?;
        let x = &self.belief.mean;
        let residual = measured - sensor.measure(x);
        let (belief, innovation) =
            self.belief.corrected(residual, &sensor.jacobian(x), noise.covariance())?;
        self.belief = belief;
        Ok(innovation)
    }
}
