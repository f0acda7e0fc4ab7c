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

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix1, Matrix2, Vector1, Vector2};

    use super::*;

    /// A push w that enters by half its square of time and by its time, and a drag that grows with speed.
    struct Pushed;

    impl NoisyDynamics<2, 1> for Pushed {
        fn propagate(&self, state: &State<2>, noise: &State<1>) -> State<2> {
            let speed = state[1];
            Vector2::new(state[0] + speed + 0.5 * noise[0], speed - 0.1 * speed * speed + speed * noise[0])
        }
    }

    /// The square of the first component.
    struct Squared;

    impl Sensor<2, 1> for Squared {
        fn measure(&self, state: &State<2>) -> State<1> {
            Vector1::new(state[0] * state[0])
        }
    }

    fn start() -> ExtendedKalmanFilter<2> {
        let covariance = Matrix2::new(0.5, 0.1, 0.1, 0.3);
        ExtendedKalmanFilter::new(Gaussian::new(Vector2::new(3.0, 2.0), covariance).unwrap())
    }

    #[test]
    fn noise_goes_through_its_own_jacobian() {
        let mut filter = start();
        let before = filter.belief().covariance;
        let noise = GaussianNoise::new(Matrix1::new(0.2)).unwrap();
        let moved = *filter.predict_general(&Pushed, &noise).unwrap();
        // By hand at (3, 2), w = 0: F = [1 1; 0 1 - 0.2 * 2], W = [0.5; 2].
        let (f, w) = (Matrix2::new(1.0, 1.0, 0.0, 0.6), Vector2::new(0.5, 2.0));
        let expected = f * before * f.transpose() + w * w.transpose() * 0.2;
        assert_eq!(moved.mean, Vector2::new(5.0, 1.6));
        assert!((moved.covariance - expected).amax() < 1e-9, "{}", moved.covariance);
    }

    #[test]
    fn a_sensor_is_linearised_at_the_prediction() {
        let mut filter = start();
        let noise = GaussianNoise::new(Matrix1::new(2.0)).unwrap();
        let innovation = filter.update(&Squared, &noise, &Vector1::new(10.0)).unwrap();
        // H = [6 0]: S = 36 * 0.5 + 2 = 20, K = [3; 0.6] / 20.
        assert!((innovation.covariance[0] - 20.0).abs() < 1e-8);
        assert!((filter.belief().mean - Vector2::new(3.15, 2.03)).amax() < 1e-9);
        assert!((filter.belief().covariance - Matrix2::new(0.05, 0.01, 0.01, 0.282)).amax() < 1e-9);
    }

    #[test]
    fn what_is_not_finite_is_refused_and_leaves_the_belief() {
        struct Broken;
        impl Dynamics<2> for Broken {
            fn propagate(&self, state: &State<2>) -> State<2> {
                state / 0.0
            }
        }
        let mut filter = start();
        let before = filter;
        let noise = GaussianNoise::new(Matrix2::identity()).unwrap();
        assert!(matches!(filter.predict(&Broken, &noise), Err(FilterError::NotFinite { .. })));
        let noise = GaussianNoise::new(Matrix1::new(0.0)).unwrap();
        let error = filter.update(&Squared, &noise, &Vector1::new(f64::NAN)).unwrap_err();
        assert_eq!(error, FilterError::NotFinite { what: "the measurement" });
        assert_eq!(filter, before);
    }
}
