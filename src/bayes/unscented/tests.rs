//! The unscented filter against exact answers.

use nalgebra::{Matrix1, Matrix2, Vector1, Vector2};
use proptest::prelude::*;

use super::*;
use crate::bayes::kalman::{KalmanFilter, LinearModel};

struct Square;

impl Dynamics<1> for Square {
    fn propagate(&self, state: &State<1>) -> State<1> {
        Vector1::new(state[0] * state[0])
    }
}

impl Sensor<1, 1> for Square {
    fn measure(&self, state: &State<1>) -> State<1> {
        self.propagate(state)
    }
}

/// x (1 + w): noise that multiplies.
struct Scaling;

impl NoisyDynamics<1, 1> for Scaling {
    fn propagate(&self, state: &State<1>, noise: &State<1>) -> State<1> {
        state * (1.0 + noise[0])
    }
}

fn scalar(mean: f64, variance: f64) -> Gaussian<1> {
    Gaussian::new(Vector1::new(mean), Matrix1::new(variance)).unwrap()
}

fn noise(variance: f64) -> GaussianNoise<1> {
    GaussianNoise::new(Matrix1::new(variance)).unwrap()
}

fn start<const N: usize>(belief: Gaussian<N>) -> UnscentedKalmanFilter<N> {
    UnscentedKalmanFilter::new(belief, SigmaPoints::Auto, MeasuredPoints::Redrawn).unwrap()
}

#[test]
fn the_square_of_a_gaussian_has_its_exact_mean_and_variance() {
    // x ~ N(m, v): E x^2 = m^2 + v, Var x^2 = 4 m^2 v + 2 v^2. n + beta = 3 meets the fourth moment.
    let (m, v) = (1.5, 0.4);
    let mut filter = start(scalar(m, v));
    let moved = *filter.predict(&Square, &noise(0.1)).unwrap();
    assert!((moved.mean[0] - (m * m + v)).abs() < 1e-14);
    assert!((moved.covariance[0] - (4.0 * m * m * v + 2.0 * v * v + 0.1)).abs() < 1e-13);
}

#[test]
fn noise_that_multiplies_is_propagated_with_the_state() {
    // Points (m +- sqrt(3 v), 0) and (m, +- sqrt(3 q)) of n = 2 with n + beta = 3: mean m, variance v + m^2 q.
    let (m, v, q) = (2.0, 0.3, 0.05);
    let mut filter =
        UnscentedKalmanFilter::<1, 1>::augmented(scalar(m, v), SigmaPoints::Auto, MeasuredPoints::Reused)
            .unwrap();
    let moved = *filter.predict_general(&Scaling, &noise(q)).unwrap();
    assert!((moved.mean[0] - m).abs() < 1e-14);
    assert!((moved.covariance[0] - (v + m * m * q)).abs() < 1e-14);
    // Reused points of general noise know of it: S = P- + R for a sensor that measures the state.
    let model = walk(0.0, 0.7);
    let innovation = filter.update(&model, &noise(0.7), &Vector1::new(1.0)).unwrap();
    assert!((innovation.covariance[0] - (v + m * m * q + 0.7)).abs() < 1e-14);
}

fn walk(q: f64, r: f64) -> LinearModel<1, 1> {
    LinearModel {
        transition: Matrix1::identity(),
        process_noise: noise(q),
        measurement: Matrix1::identity(),
        measurement_noise: noise(r),
    }
}

#[test]
fn reused_points_do_not_know_of_additive_noise() {
    let model = walk(2.0, 0.5);
    for (measured_points, expected) in [(MeasuredPoints::Redrawn, 3.5), (MeasuredPoints::Reused, 1.5)] {
        let mut filter =
            UnscentedKalmanFilter::new(scalar(0.0, 1.0), SigmaPoints::Auto, measured_points).unwrap();
        filter.predict(&model, &model.process_noise).unwrap();
        let z = Vector1::new(1.0);
        let innovation = filter.update(&model, &model.measurement_noise, &z).unwrap();
        assert!((innovation.covariance[0] - expected).abs() < 1e-14);
        // P = P- - K S K' with K = C / S.
        let c = expected - 0.5;
        assert!((filter.belief().covariance[0] - (3.0 - c * c / expected)).abs() < 1e-14);
        // A second measurement without a prediction has nothing to reuse.
        let before = filter.belief().covariance[0];
        let innovation = filter.update(&model, &model.measurement_noise, &z).unwrap();
        assert!((innovation.covariance[0] - (before + 0.5)).abs() < 1e-14);
    }
}

#[test]
fn more_than_three_components_are_scaled_and_it_says_so() {
    assert_eq!(SigmaPoints::Auto.resolve(2), SigmaPoints::Symmetric { beta: 1.0 });
    assert_eq!(SigmaPoints::Auto.resolve(3), SigmaPoints::Symmetric { beta: 0.0 });
    let filter = start(Gaussian::<7>::new(State::zeros(), Covariance::identity()).unwrap());
    assert_eq!(filter.sigma_points(), SigmaPoints::Scaled { alpha: 0.6, beta: 2.0, kappa: 0.0 });
    assert!(filter.alone.centre_covariance > 0.0);
    let seven = SigmaPoints::Symmetric { beta: -4.0 }.weights(7).unwrap();
    assert!((seven.centre_mean + 4.0 / 3.0).abs() < 1e-15);
}

#[test]
fn sigma_points_without_a_spread_and_covariances_without_a_root_are_refused() {
    for points in [
        SigmaPoints::Symmetric { beta: -1.0 },
        SigmaPoints::Symmetric { beta: f64::NAN },
        SigmaPoints::Scaled { alpha: 0.0, beta: 2.0, kappa: 0.0 },
    ] {
        let error =
            UnscentedKalmanFilter::new(scalar(0.0, 1.0), points, MeasuredPoints::Redrawn).unwrap_err();
        assert!(error.to_string().contains("choose n + beta > 0"), "{error}");
    }
    let mut known = start(scalar(1.0, 0.0));
    let error = known.predict(&Square, &noise(1.0)).unwrap_err();
    assert_eq!(error, FilterError::CholeskyFailed { what: "the covariance" });
    let mut filter = start(scalar(1.0, 1.0));
    assert!(filter.update(&Square, &noise(1.0), &Vector1::new(f64::NAN)).is_err());
    assert_eq!(filter.belief(), &scalar(1.0, 1.0));
}

proptest! {
    #[test]
    fn on_a_linear_model_it_is_the_kalman_filter(
        f in prop::array::uniform4(-1.0..1.0f64), h in prop::array::uniform2(-1.0..1.0f64),
        q in 0.01..2.0f64, r in 0.01..2.0f64, zs in prop::array::uniform5(-3.0..3.0f64), scaled in any::<bool>(),
    ) {
        let model = LinearModel::<2, 1> {
            transition: Matrix2::from_row_slice(&f),
            process_noise: GaussianNoise::diagonal(&Vector2::new(q, 0.5 * q)).unwrap(),
            measurement: nalgebra::RowVector2::from_row_slice(&h),
            measurement_noise: noise(r),
        };
        let belief = Gaussian::new(Vector2::new(1.0, -1.0), Matrix2::identity()).unwrap();
        let points =
            if scaled { SigmaPoints::Scaled { alpha: 0.6, beta: 2.0, kappa: 0.0 } } else { SigmaPoints::Auto };
        let mut exact = KalmanFilter::new(model, belief).unwrap();
        let mut filter = UnscentedKalmanFilter::new(belief, points, MeasuredPoints::Redrawn).unwrap();
        let mut extended = crate::bayes::extended::ExtendedKalmanFilter::new(belief);
        for z in zs {
            exact.predict().unwrap();
            filter.predict(&model, &model.process_noise).unwrap();
            extended.predict(&model, &model.process_noise).unwrap();
            let z = Vector1::new(z);
            let expected = exact.update(&z).unwrap();
            let found = filter.update(&model, &model.measurement_noise, &z).unwrap();
            let linearised = extended.update(&model, &model.measurement_noise, &z).unwrap();
            prop_assert!((found.log_likelihood - expected.log_likelihood).abs() < 1e-9);
            prop_assert_eq!(linearised.log_likelihood, expected.log_likelihood);
            prop_assert!((filter.belief().mean - exact.belief().mean).amax() < 1e-9);
            prop_assert!((filter.belief().covariance - exact.belief().covariance).amax() < 1e-9);
            prop_assert_eq!(extended.belief(), exact.belief());
        }
    }
}

/// Seven components that turn each other.
struct Ring;

impl Dynamics<7> for Ring {
    fn propagate(&self, state: &State<7>) -> State<7> {
        State::from_fn(|i, _| 2.0 * (state[i] + 3.0 * state[(i + 1) % 7]).sin())
    }
}

impl Sensor<7, 1> for Ring {
    fn measure(&self, state: &State<7>) -> State<1> {
        Vector1::new(state[0] * state[3])
    }
}

#[test]
fn seven_components_keep_a_positive_covariance_however_bent_the_model() {
    let belief = Gaussian::<7>::new(State::repeat(0.5), Covariance::identity() * 2.0).unwrap();
    let tiny = GaussianNoise::new(Covariance::<7>::identity() * 1e-9).unwrap();
    let run = |points| {
        let mut filter = UnscentedKalmanFilter::new(belief, points, MeasuredPoints::Redrawn).unwrap();
        (0..300).try_for_each(|k| {
            filter.predict(&Ring, &tiny)?;
            filter.update(&Ring, &noise(1e-3), &Vector1::new((f64::from(k)).sin())).map(|_| ())
        })
    };
    assert_eq!(run(SigmaPoints::Auto), Ok(()));
    // n + beta = 3 weighs the centre by -4/3 and breaks down, with a remedy.
    let error = run(SigmaPoints::Symmetric { beta: -4.0 }).unwrap_err();
    assert!(error.to_string().contains("scale the sigma points") || error == FilterError::SingularInnovation);
}
