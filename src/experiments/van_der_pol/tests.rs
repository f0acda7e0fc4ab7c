//! The experiment on small sizes; what it says of the paper is in docs/van_der_pol.md.

use super::*;
use crate::bayes::{
    extended::ExtendedKalmanFilter,
    model::{Dynamics, Sensor, central_differences},
    unscented::{MeasuredPoints, SigmaPoints, UnscentedKalmanFilter},
};

const REDRAWN: Filter = Filter::Unscented(MeasuredPoints::Redrawn);

fn setup(noise: NoiseShape) -> Setup {
    Setup { mu: 1.0, process_variance: 1e-3, measurement_variance: 4e-3, noise }
}

#[test]
fn the_truth_is_the_oscillators_limit_cycle() {
    // With a tiny mu it is a harmonic oscillator: 2 cos t.
    let calm = truth(1e-12);
    assert_eq!(calm.len(), SAMPLES);
    for (k, state) in calm.iter().enumerate() {
        let t = k as f64 * TIME_STEP;
        assert!((state - State::<2>::new(2.0 * t.cos(), -2.0 * t.sin())).amax() < 1e-10);
    }
    // With mu = 1, scipy.integrate.solve_ivp(DOP853, rtol 1e-13, atol 1e-13) gives at t = 5:
    let found = truth(1.0)[SAMPLES - 1];
    assert!((found - State::<2>::new(TRUTH_AT_5[0], TRUTH_AT_5[1])).amax() < 1e-9, "{found}");
}

const TRUTH_AT_5: [f64; 2] = [-0.837077450295, 1.307088937800];

#[test]
fn the_given_jacobians_are_the_derivatives() {
    let step = EulerStep { mu: 3.0, step: TIME_STEP };
    for state in truth(3.0).iter().step_by(10) {
        let differences = central_differences(|x| step.propagate(x), state);
        assert!((step.jacobian(state) - differences).amax() < 1e-8);
        assert_eq!(
            Position.jacobian(state),
            central_differences(|x| Position.measure(x), state).map(f64::round)
        );
    }
}

#[test]
fn every_noise_has_its_variance_and_a_density_that_fits_its_draws() {
    for shape in [NoiseShape::Gauss, NoiseShape::Student, NoiseShape::Bimodal] {
        let noise = MeasurementNoise::new(shape, 0.25);
        // Integrals over the density, by the midpoint rule.
        let h = 1e-3;
        let at = |i: i32| (f64::from(i) + 0.5) * h;
        let (mut total, mut variance, mut inner) = (0.0, 0.0, 0.0);
        for i in -200_000..200_000 {
            let p = noise.log_density(at(i)).exp() * h;
            total += p;
            variance += p * at(i).powi(2);
            inner += if at(i).abs() < 0.3 { p } else { 0.0 };
        }
        assert!((total - 1.0).abs() < 1e-5, "{shape:?}: {total}");
        assert!((variance - 0.25).abs() < 2e-3, "{shape:?}: {variance}");
        let mut rng = stream(3, 0, Use::Measurements);
        let draws = 200_000;
        let hits = (0..draws).filter(|_| noise.sample(&mut rng).abs() < 0.3).count() as f64;
        assert!((hits / f64::from(draws) - inner).abs() < 4e-3, "{shape:?}: {inner}");
    }
}

/// Runs whose truth is drawn from the filters' own model.
fn matched_runs(setup: &Setup, runs: usize) -> Vec<(Vec<State<2>>, Vec<f64>)> {
    let (dynamics, process, noise) = (setup.dynamics(), setup.process_noise(), setup.measurement_noise());
    let start = GaussianNoise::new(first_belief().covariance).unwrap();
    (0..runs)
        .map(|run| {
            let mut rng = stream(17, run, Use::Measurements);
            let first = first_belief().mean + start.sample(&mut rng);
            let mut states = vec![first];
            for k in 1..SAMPLES {
                states.push(dynamics.propagate(&states[k - 1]) + process.sample(&mut rng));
            }
            let seen = states.iter().map(|state| state[0] + noise.sample(&mut rng)).collect();
            (states, seen)
        })
        .collect()
}

/// Mean and the half-width at 4 sigma of a mean of `n` independent chi-squares of `degrees` freedom.
fn chi_square_bound(degrees: f64, n: usize) -> f64 {
    4.0 * (2.0 * degrees / n as f64).sqrt()
}

#[test]
fn on_a_matched_model_nees_and_nis_are_chi_square() {
    let setup = Setup { process_variance: 1e-3, measurement_variance: 1e-3, ..setup(NoiseShape::Gauss) };
    let runs = matched_runs(&setup, 300);
    let (process, noise) = (
        setup.process_noise(),
        GaussianNoise::diagonal(&State::<1>::new(setup.measurement_variance)).unwrap(),
    );
    let mut nis = [0.0; 2];
    let mut nees = [0.0; 3];
    for (run, (states, seen)) in runs.iter().enumerate() {
        let mut extended = ExtendedKalmanFilter::new(first_belief());
        let mut unscented =
            UnscentedKalmanFilter::new(first_belief(), SigmaPoints::Auto, MeasuredPoints::Redrawn).unwrap();
        for (k, &x) in seen.iter().enumerate() {
            if k > 0 {
                extended.predict(&setup.dynamics(), &process).unwrap();
                unscented.predict(&setup.dynamics(), &process).unwrap();
            }
            let z = State::<1>::new(x);
            nis[0] += extended.update(&Position, &noise, &z).unwrap().nis;
            nis[1] += unscented.update(&Position, &noise, &z).unwrap().nis;
        }
        // One sample a run, so that those averaged are independent.
        let last = states.last().unwrap();
        nees[0] += extended.belief().nees(last).unwrap();
        nees[1] += unscented.belief().nees(last).unwrap();
        let track = Filter::Particle(2000).track(&setup, seen, 17, run, 0);
        nees[2] += track.beliefs[SAMPLES - 1].nees(last).unwrap();
    }
    // Innovations are independent of each other.
    let innovations = runs.len() * SAMPLES;
    for sum in nis {
        let mean = sum / innovations as f64;
        assert!((mean - 1.0).abs() < chi_square_bound(1.0, innovations), "NIS {mean}");
    }
    for sum in nees {
        let mean = sum / runs.len() as f64;
        assert!((mean - 2.0).abs() < chi_square_bound(2.0, runs.len()), "NEES {mean}");
    }
}

#[test]
fn with_gaussian_noise_a_large_particle_filter_meets_the_kalman_filters() {
    let setup = Setup { measurement_variance: 1e-3, ..setup(NoiseShape::Gauss) };
    let measured = setup.measure(&truth(1.0), 5, 0);
    let [exact, found] =
        [REDRAWN, Filter::Particle(20_000)].map(|filter| filter.track(&setup, &measured, 5, 0, 1).beliefs);
    for (a, b) in exact.iter().zip(&found) {
        assert!((a.mean - b.mean).component_mul(&State::<2>::new(1.0, 0.1)).amax() < 2e-3, "{a:?} {b:?}");
    }
}

#[test]
fn a_particle_filter_that_knows_the_noise_beats_the_kalman_filters_by_far_if_it_is_bimodal() {
    let filters = [Filter::Extended, Filter::Particle(2000)];
    let found = compare(&setup(NoiseShape::Bimodal), &filters, 100, 2).unwrap();
    assert!(found.filters[1].rmse.mean < 0.8 * found.filters[0].rmse.mean, "{:?}", found.filters);
    assert_eq!(found.gaps[0].rmse_difference.sign(), 1);
}

#[test]
fn calibration_finds_the_published_error() {
    let r = calibrated(1.0, 1e-3, 200, 4).unwrap();
    let setup = Setup { measurement_variance: r, ..setup(NoiseShape::Gauss) };
    let found = compare(&setup, &[Filter::Extended], 200, 4).unwrap();
    assert!((found.filters[0].rmse.mean - PUBLISHED_EKF_RMSE).abs() < 1e-7);
}

#[test]
fn the_difference_from_the_exact_filter_falls_with_the_root_of_the_particles() {
    let found = convergence(&setup(NoiseShape::Gauss), &[200, 800, 3200], 60_000, 12, 1).unwrap();
    assert!((found.slope + 0.5).abs() < 0.1, "{found:?}");
    assert!(found.points.is_sorted_by(|a, b| a.rms_difference > b.rms_difference));
}

#[test]
fn results_do_not_depend_on_threads() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let filters = [Filter::Extended, REDRAWN, Filter::Particle(50)];
        let mut found = pool.install(|| compare(&setup(NoiseShape::Student), &filters, 40, 9)).unwrap();
        found.filters.iter_mut().for_each(|filter| filter.seconds = 0.0);
        found
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn what_cannot_be_run_is_refused() {
    let good = setup(NoiseShape::Gauss);
    let ekf = [Filter::Extended];
    for (setup, filters, runs, reason) in [
        (Setup { mu: f64::NAN, ..good }, &ekf[..], 9, "above 0 and at most 10"),
        (Setup { mu: -1.0, ..good }, &ekf, 9, "mu is -1"),
        (Setup { process_variance: 0.0, ..good }, &ekf, 9, "process variance is 0"),
        (Setup { measurement_variance: f64::INFINITY, ..good }, &ekf, 9, "measurement variance is inf"),
        (good, &ekf, 1, "at least 2"),
        (good, &[Filter::Particle(0)], 9, "at least 1"),
    ] {
        let message = compare(&setup, filters, runs, 1).unwrap_err().to_string();
        assert!(message.contains(reason), "{message}");
    }
    assert!(matches!(convergence(&good, &[], 10, 2, 1), Err(ExperimentError::NoSlope { .. })));
    assert!(matches!(convergence(&good, &[5, 5], 10, 2, 1), Err(ExperimentError::NoSlope { .. })));
    assert!(matches!(convergence(&good, &[5, 10], 10, 2, 1), Err(ExperimentError::NoSlope { .. })));
}

#[test]
fn the_plot_is_whole_and_finite() {
    let filters = [Filter::Extended, REDRAWN, Filter::Particle(100)];
    let svg = plot(&setup(NoiseShape::Gauss), &filters, 1).unwrap();
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    assert_eq!(svg.matches("<polyline").count(), 3 * 4);
    assert_eq!(svg.matches("<circle").count(), SAMPLES + 1);
    assert!(!svg.contains("NaN") && !svg.contains("inf") && svg.contains("PF-100"));
}
