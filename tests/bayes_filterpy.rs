//! The Kalman family against filterpy, on vectors that bench/filterpy_vectors.py made once.

use infopart::bayes::{
    Covariance, State,
    extended::ExtendedKalmanFilter,
    gaussian::{Gaussian, GaussianNoise, Innovation},
    kalman::{KalmanFilter, LinearModel},
    model::{Dynamics, Sensor},
    unscented::{MeasuredPoints, SigmaPoints, UnscentedKalmanFilter},
};
use nalgebra::{Matrix2, SMatrix};
use serde::Deserialize;

const VECTORS: &str = include_str!("data/filterpy.json");
const TOLERANCE: f64 = 1e-9;

#[derive(Deserialize)]
struct Vectors {
    linear: Linear,
    van_der_pol: VanDerPol,
}

#[derive(Deserialize)]
struct Linear {
    f: Vec<f64>,
    q: Vec<f64>,
    h: Vec<f64>,
    r: Vec<f64>,
    p0: Vec<f64>,
    x0: Vec<f64>,
    z: Vec<Vec<f64>>,
    steps: Vec<Step>,
}

#[derive(Deserialize)]
struct VanDerPol {
    dt: f64,
    mu: f64,
    q: Vec<f64>,
    r: f64,
    x0: Vec<f64>,
    p0: Vec<f64>,
    z: Vec<f64>,
    extended: Vec<Step>,
    symmetric_redrawn: Vec<Step>,
    symmetric_reused: Vec<Step>,
    scaled_redrawn: Vec<Step>,
    scaled_reused: Vec<Step>,
}

/// What filterpy had after an update. Matrices are row after row.
#[derive(Deserialize)]
struct Step {
    mean: Vec<f64>,
    covariance: Vec<f64>,
    residual: Vec<f64>,
    innovation_covariance: Vec<f64>,
    log_likelihood: f64,
}

impl Step {
    fn assert_met<const N: usize, const M: usize>(
        &self,
        k: usize,
        belief: &Gaussian<N>,
        innovation: &Innovation<M>,
    ) {
        let near = |what: &str, expected: &[f64], found: &mut dyn Iterator<Item = f64>| {
            let found: Vec<f64> = found.collect();
            assert_eq!(expected.len(), found.len());
            for (e, f) in expected.iter().zip(found) {
                assert!((e - f).abs() <= TOLERANCE * e.abs().max(1.0), "step {k}, {what}: {f}, not {e}");
            }
        };
        near("mean", &self.mean, &mut belief.mean.iter().copied());
        near("covariance", &self.covariance, &mut belief.covariance.transpose().iter().copied());
        near("residual", &self.residual, &mut innovation.residual.iter().copied());
        near("S", &self.innovation_covariance, &mut innovation.covariance.transpose().iter().copied());
        near("log-likelihood", &[self.log_likelihood], &mut [innovation.log_likelihood].into_iter());
    }
}

fn vectors() -> Vectors {
    serde_json::from_str(VECTORS).expect("the vectors are JSON")
}

fn matrix<const R: usize, const C: usize>(rows: &[f64]) -> SMatrix<f64, R, C> {
    SMatrix::from_row_slice(rows)
}

#[test]
fn the_linear_filter_is_filterpys() {
    let case = vectors().linear;
    let model = LinearModel::<4, 2> {
        transition: matrix(&case.f),
        process_noise: GaussianNoise::new(matrix(&case.q)).unwrap(),
        measurement: matrix(&case.h),
        measurement_noise: GaussianNoise::new(matrix(&case.r)).unwrap(),
    };
    let belief = Gaussian::new(State::from_column_slice(&case.x0), matrix(&case.p0)).unwrap();
    let mut filter = KalmanFilter::new(model, belief).unwrap();
    assert_eq!((case.z.len(), case.steps.len()), (40, 40));
    for (k, (z, step)) in case.z.iter().zip(&case.steps).enumerate() {
        filter.predict().unwrap();
        let innovation = filter.update(&State::from_column_slice(z)).unwrap();
        step.assert_met(k, filter.belief(), &innovation);
    }
}

/// The script's oscillator. `exact` gives its Jacobians, else they are central differences.
struct Oscillator {
    dt: f64,
    mu: f64,
    exact: bool,
}

impl Oscillator {
    fn without_jacobians(&self) -> Self {
        Self { exact: false, ..*self }
    }
}

impl Dynamics<2> for Oscillator {
    fn propagate(&self, x: &State<2>) -> State<2> {
        let push = self.mu * (1.0 - x[0] * x[0]) * x[1] - x[0];
        State::<2>::new(x[0] + self.dt * x[1], x[1] + self.dt * push)
    }

    fn jacobian(&self, x: &State<2>) -> Covariance<2> {
        if !self.exact {
            return infopart::bayes::model::central_differences(|x| self.propagate(x), x);
        }
        let (dt, mu) = (self.dt, self.mu);
        Matrix2::new(1.0, dt, dt * (-2.0 * mu * x[0] * x[1] - 1.0), 1.0 + dt * mu * (1.0 - x[0] * x[0]))
    }
}

impl Sensor<2, 1> for Oscillator {
    fn measure(&self, x: &State<2>) -> State<1> {
        State::<1>::new(x[0] + 0.1 * x[1] * x[1])
    }
}

struct Scene {
    case: VanDerPol,
    oscillator: Oscillator,
    belief: Gaussian<2>,
    process_noise: GaussianNoise<2>,
    measurement_noise: GaussianNoise<1>,
}

fn scene() -> Scene {
    let case = vectors().van_der_pol;
    assert_eq!(case.z.len(), 40);
    Scene {
        oscillator: Oscillator { dt: case.dt, mu: case.mu, exact: true },
        belief: Gaussian::new(State::from_column_slice(&case.x0), matrix(&case.p0)).unwrap(),
        process_noise: GaussianNoise::new(matrix(&case.q)).unwrap(),
        measurement_noise: GaussianNoise::new(matrix(&[case.r])).unwrap(),
        case,
    }
}

#[test]
fn the_extended_filter_is_filterpys_with_and_without_given_jacobians() {
    let Scene { case, oscillator, belief, process_noise, measurement_noise } = scene();
    for oscillator in [oscillator.without_jacobians(), oscillator] {
        let mut filter = ExtendedKalmanFilter::new(belief);
        assert_eq!(case.extended.len(), 40);
        for (k, (&z, step)) in case.z.iter().zip(&case.extended).enumerate() {
            filter.predict(&oscillator, &process_noise).unwrap();
            let innovation = filter.update(&oscillator, &measurement_noise, &State::<1>::new(z)).unwrap();
            step.assert_met(k, filter.belief(), &innovation);
        }
    }
}

#[test]
fn the_unscented_filter_is_filterpys_with_either_points_reused_or_redrawn() {
    let Scene { case, oscillator, belief, process_noise, measurement_noise } = scene();
    let symmetric = SigmaPoints::Symmetric { beta: 1.0 };
    let scaled = SigmaPoints::Scaled { alpha: 0.6, beta: 2.0, kappa: 0.0 };
    for (points, measured, steps) in [
        (symmetric, MeasuredPoints::Redrawn, &case.symmetric_redrawn),
        (SigmaPoints::Auto, MeasuredPoints::Redrawn, &case.symmetric_redrawn),
        (symmetric, MeasuredPoints::Reused, &case.symmetric_reused),
        (scaled, MeasuredPoints::Redrawn, &case.scaled_redrawn),
        (scaled, MeasuredPoints::Reused, &case.scaled_reused),
    ] {
        let mut filter = UnscentedKalmanFilter::new(belief, points, measured).unwrap();
        assert_eq!(steps.len(), 40);
        for (k, (&z, step)) in case.z.iter().zip(steps).enumerate() {
            filter.predict(&oscillator, &process_noise).unwrap();
            let innovation = filter.update(&oscillator, &measurement_noise, &State::<1>::new(z)).unwrap();
            step.assert_met(k, filter.belief(), &innovation);
        }
    }
}
