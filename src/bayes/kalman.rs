//! The linear Kalman filter: exact for x_k = F x_k-1 + u + w, z_k = H x_k + v with Gaussian w and v.
//!
//! Steps (R. E. Kalman 1960, in the notation of Welch and Bishop):
//! 1. predict: x- = F x + u, P- = F P F' + Q,
//! 2. innovation: residual = z - H x-, S = H P- H' + R,
//! 3. gain: K = P- H' S^-1, by Cholesky,
//! 4. correct: x = x- + K residual, P = (I - K H) P- (I - K H)' + K R K' (Joseph's form).

use nalgebra::SMatrix;

use super::{
    FilterError, State,
    gaussian::{Gaussian, GaussianNoise, Innovation, check_finite},
};

/// A linear model with Gaussian noise: `N` components of state, `M` measured numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearModel<const N: usize, const M: usize> {
    /// F: how the state moves in a step.
    pub transition: SMatrix<f64, N, N>,
    /// Q: what moves it besides.
    pub process_noise: GaussianNoise<N>,
    /// H: what is measured of a state.
    pub measurement: SMatrix<f64, M, N>,
    /// R: how the measurement errs.
    pub measurement_noise: GaussianNoise<M>,
}

/// A belief that moves and is corrected by a linear model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KalmanFilter<const N: usize, const M: usize> {
    /// The model; it may change between steps.
    pub model: LinearModel<N, M>,
    belief: Gaussian<N>,
}

impl<const N: usize, const M: usize> KalmanFilter<N, M> {
    /// Starts from a belief.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] if F or H holds a NaN or an infinity.
    pub fn new(model: LinearModel<N, M>, belief: Gaussian<N>) -> Result<Self, FilterError> {
        check_finite(&model.transition, "the transition matrix")?;
        check_finite(&model.measurement, "the measurement matrix")?;
        Ok(Self { model, belief })
    }

    /// What is believed of the state now.
    pub fn belief(&self) -> &Gaussian<N> {
        &self.belief
    }

    /// Replaces the belief, for what a linear model cannot say, such as a component that must not be negative.
    pub fn set_belief(&mut self, belief: Gaussian<N>) {
        self.belief = belief;
    }

    /// Step 1.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] if the belief has overflowed.
    pub fn predict(&mut self) -> Result<&Gaussian<N>, FilterError> {
        self.predict_with(&State::zeros())
    }

    /// Step 1 with a known input: u = `shift` is added to the state.
    ///
    /// # Errors
    /// As [`predict`](Self::predict).
    pub fn predict_with(&mut self, shift: &State<N>) -> Result<&Gaussian<N>, FilterError> {
        let transition = &self.model.transition;
        let mean = transition * self.belief.mean + shift;
        self.belief = self.belief.moved(mean, transition, self.model.process_noise.covariance())?;
        Ok(&self.belief)
    }

    /// Step 2 alone: how a measurement meets its prediction, for gating and association; the belief stays.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    pub fn innovation(&self, measured: &State<M>) -> Result<Innovation<M>, FilterError> {
        let Self { model, belief } = self;
        check_finite(measured, "the measurement")?;
        let h = &model.measurement;
        let covariance = h * belief.covariance * h.transpose() + model.measurement_noise.covariance();
        Innovation::new(measured - h * belief.mean, super::gaussian::symmetric(&covariance))
    }

    /// Steps 2 to 4.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] if the measurement holds a NaN or an infinity, [`FilterError::SingularInnovation`] if S
    /// cannot be inverted. The belief then stays as it was.
    pub fn update(&mut self, measured: &State<M>) -> Result<Innovation<M>, FilterError> {
        check_finite(measured, "the measurement")?;
        let h = &self.model.measurement;
        let residual = measured - h * self.belief.mean;
        let (belief, innovation) =
            self.belief.corrected(residual, h, self.model.measurement_noise.covariance())?;
        self.belief = belief;
        Ok(innovation)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix1, Matrix2, Matrix2x1, RowVector2, Vector1, Vector2};
    use proptest::prelude::*;

    use super::*;

    fn scalar(q: f64, r: f64) -> LinearModel<1, 1> {
        LinearModel {
            transition: Matrix1::new(1.0),
            process_noise: GaussianNoise::new(Matrix1::new(q)).unwrap(),
            measurement: Matrix1::new(1.0),
            measurement_noise: GaussianNoise::new(Matrix1::new(r)).unwrap(),
        }
    }

    /// Position and velocity, position measured.
    fn constant_velocity(q: f64, r: f64) -> LinearModel<2, 1> {
        LinearModel {
            transition: Matrix2::new(1.0, 1.0, 0.0, 1.0),
            process_noise: GaussianNoise::new(Matrix2::new(0.25, 0.5, 0.5, 1.0) * q).unwrap(),
            measurement: RowVector2::new(1.0, 0.0),
            measurement_noise: GaussianNoise::new(Matrix1::new(r)).unwrap(),
        }
    }

    fn start(variance: f64) -> Gaussian<2> {
        Gaussian::new(Vector2::zeros(), Matrix2::identity() * variance).unwrap()
    }

    #[test]
    fn two_equal_sources_are_averaged() {
        let belief = Gaussian::new(Vector1::new(2.0), Matrix1::new(4.0)).unwrap();
        let mut filter = KalmanFilter::new(scalar(0.0, 4.0), belief).unwrap();
        let innovation = filter.update(&Vector1::new(6.0)).unwrap();
        assert!((filter.belief().mean[0] - 4.0).abs() < 1e-15);
        assert!((filter.belief().covariance[0] - 2.0).abs() < 1e-15);
        assert_eq!((innovation.residual[0], innovation.covariance[0]), (4.0, 8.0));
        assert!((innovation.nis - 2.0).abs() < 1e-15);
        let density = (-1.0f64).exp() / (std::f64::consts::TAU * 8.0).sqrt();
        assert!((innovation.log_likelihood - density.ln()).abs() < 1e-14);
    }

    #[test]
    fn the_variance_of_a_random_walk_settles_at_the_riccati_equations_root() {
        // p = (p + q) r / (p + q + r) with q = r = 1: p is the inverse of the golden ratio.
        let belief = Gaussian::new(Vector1::zeros(), Matrix1::new(50.0)).unwrap();
        let mut filter = KalmanFilter::new(scalar(1.0, 1.0), belief).unwrap();
        for _ in 0..50 {
            filter.predict().unwrap();
            filter.update(&Vector1::zeros()).unwrap();
        }
        assert!((filter.belief().covariance[0] - (5.0f64.sqrt() - 1.0) / 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_straight_line_through_two_exact_points_is_found() {
        let mut filter = KalmanFilter::new(constant_velocity(0.0, 1e-12), start(1e6)).unwrap();
        for z in [3.0, 5.0] {
            filter.predict().unwrap();
            filter.update(&Vector1::new(z)).unwrap();
        }
        assert!((filter.belief().mean - Vector2::new(5.0, 2.0)).amax() < 1e-9);
        filter.predict_with(&Vector2::new(0.5, 0.0)).unwrap();
        assert!((filter.belief().mean[0] - 7.5).abs() < 1e-9);
    }

    #[test]
    fn the_innovation_alone_is_that_of_the_update() {
        let mut filter = KalmanFilter::new(constant_velocity(0.1, 0.5), start(3.0)).unwrap();
        filter.predict().unwrap();
        let z = Vector1::new(1.5);
        let (alone, updating) = (filter.innovation(&z).unwrap(), filter.update(&z).unwrap());
        assert_eq!((alone.residual, alone.covariance), (updating.residual, updating.covariance));
        assert_eq!((alone.nis, alone.log_likelihood), (updating.nis, updating.log_likelihood));
    }

    #[test]
    fn refused_measurements_leave_the_belief() {
        let mut filter = KalmanFilter::new(constant_velocity(0.0, 0.0), start(1.0)).unwrap();
        let before = filter;
        for bad in [f64::NAN, f64::INFINITY] {
            let error = filter.update(&Vector1::new(bad)).unwrap_err();
            assert_eq!(error, FilterError::NotFinite { what: "the measurement" });
            assert!(filter.innovation(&Vector1::new(bad)).is_err());
        }
        assert_eq!(filter, before);
        // An exact measurement makes the position known; a second one has nothing left to correct.
        filter.update(&Vector1::new(1.0)).unwrap();
        let error = filter.update(&Vector1::new(1.0)).unwrap_err();
        assert_eq!(error, FilterError::SingularInnovation);
        assert!(error.to_string().contains("noise variance above 0"));
    }

    #[test]
    fn the_same_number_measured_twice_without_noise_is_singular() {
        let model = LinearModel::<1, 2> {
            transition: Matrix1::new(1.0),
            process_noise: GaussianNoise::new(Matrix1::new(0.0)).unwrap(),
            measurement: Matrix2x1::new(1.0, 3.0),
            measurement_noise: GaussianNoise::new(Matrix2::zeros()).unwrap(),
        };
        let belief = Gaussian::new(Vector1::zeros(), Matrix1::new(0.7)).unwrap();
        let mut filter = KalmanFilter::new(model, belief).unwrap();
        assert_eq!(filter.update(&Vector2::new(1.0, 3.0)).unwrap_err(), FilterError::SingularInnovation);
    }

    #[test]
    fn overflow_and_broken_models_are_told() {
        let mut filter = KalmanFilter::new(constant_velocity(0.0, 1.0), start(1e308)).unwrap();
        let errors = (0..3).filter_map(|_| filter.predict().err()).count();
        assert!(errors > 0 && filter.belief().covariance.iter().all(|value| value.is_finite()));
        let broken =
            LinearModel { measurement: RowVector2::new(f64::NAN, 0.0), ..constant_velocity(0.0, 1.0) };
        assert!(KalmanFilter::new(broken, start(1.0)).is_err());
    }

    proptest! {
        /// Ten thousand measurements that are far more exact than the start: P = (I - K H) P would turn indefinite. A start
        /// that is more vague than a measurement by more digits than a double has may be refused, but never be got wrong.
        #[test]
        fn the_covariance_stays_symmetric_and_positive(
            log_r in -12.0..0.0f64, log_q in -12.0..0.0f64, z in -5.0..5.0f64,
        ) {
            let model = constant_velocity(10f64.powf(log_q), 10f64.powf(log_r));
            let mut filter = KalmanFilter::new(model, start(1e6)).unwrap();
            for _ in 0..10_000 {
                filter.predict().unwrap();
                if let Err(error) = filter.update(&Vector1::new(z)) {
                    prop_assert!(log_r < -8.0 && error == FilterError::SingularInnovation, "{error}");
                    return Ok(());
                }
            }
            let p = filter.belief().covariance;
            prop_assert_eq!(p, p.transpose());
            prop_assert!(p[(0, 0)] > 0.0 && p[(1, 1)] > 0.0 && p.determinant() >= 0.0);
        }
    }
}
