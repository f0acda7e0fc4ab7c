//! The particle filter against exact answers.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::*;
use crate::bayes::{random_walk::RandomWalk, resampling::NoResampling};

/// y = x + N(0, sigma^2).
struct Measured {
    y: f64,
    sigma: f64,
}

impl Observation<1> for Measured {
    fn log_likelihood(&self, state: &State<1>) -> f64 {
        let z = (self.y - state[0]) / self.sigma;
        -0.5 * z * z - self.sigma.ln() - 0.5 * std::f64::consts::TAU.ln()
    }
}

struct Nothing;

impl Observation<1> for Nothing {
    fn log_likelihood(&self, _: &State<1>) -> f64 {
        f64::NEG_INFINITY
    }
}

fn normal_particles(n: usize, rng: &mut ChaCha8Rng) -> Vec<State<1>> {
    (0..n).map(|_| State::<1>::new(rng.sample(StandardNormal))).collect()
}

/// Mean, variance and log-evidence of the exact scalar Kalman filter with x_0 ~ N(0, 1).
fn kalman(ys: &[f64], q: f64, r: f64) -> Vec<(f64, f64, f64)> {
    let (mut m, mut p) = (0.0, 1.0);
    ys.iter()
        .map(|y| {
            p += q;
            let s: f64 = p + r;
            let innovation = y - m;
            let evidence = -0.5 * innovation * innovation / s - 0.5 * (std::f64::consts::TAU * s).ln();
            let gain = p / s;
            m += gain * innovation;
            p *= 1.0 - gain;
            (m, p, evidence)
        })
        .collect()
}

const YS: [f64; 6] = [0.5, 1.4, 0.9, 2.2, 2.9, 2.4];

#[test]
fn on_a_linear_gaussian_model_it_meets_the_exact_kalman_filter() {
    let (q, r) = (0.3f64, 0.2f64);
    let transition = RandomWalk::<1>::new(State::<1>::new(q.sqrt()));
    for resampling in
        [Resampling::Multinomial, Resampling::Stratified, Resampling::Systematic, Resampling::Residual]
    {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let options = ParticleFilterOptions { resampling, ..Default::default() };
        let mut filter = ParticleFilter::new(normal_particles(40_000, &mut rng), options);
        for (y, (mean, variance, evidence)) in YS.iter().zip(kalman(&YS, q, r)) {
            let found = filter.step(&transition, &Measured { y: *y, sigma: r.sqrt() }, &mut rng);
            assert!((found.mean[0] - mean).abs() < 0.02, "{resampling:?}: {} {mean}", found.mean[0]);
            assert!((found.covariance[0] - variance).abs() < 0.01, "{resampling:?}");
            assert!((found.log_evidence - evidence).abs() < 0.03, "{resampling:?}");
        }
    }
}

#[test]
fn a_shifted_proposal_is_made_good_by_its_ratio() {
    let (q, r) = (0.3f64, 0.2f64);
    let transition = RandomWalk::<1>::new(State::<1>::new(q.sqrt()));
    let shifted = RandomWalk::<1> { shift: State::<1>::new(0.6), sigma: State::<1>::new(0.9) };
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut filter =
        ParticleFilter::new(normal_particles(40_000, &mut rng), ParticleFilterOptions::default());
    for (y, (mean, variance, evidence)) in YS.iter().zip(kalman(&YS, q, r)) {
        filter.propose(&shifted, &transition, &mut rng);
        let found = filter.correct(&Measured { y: *y, sigma: r.sqrt() }, &mut rng);
        assert!((found.mean[0] - mean).abs() < 0.03, "{} {mean}", found.mean[0]);
        assert!((found.covariance[0] - variance).abs() < 0.02);
        assert!((found.log_evidence - evidence).abs() < 0.04);
    }
}

#[test]
fn a_proposal_draws_the_same_bits_on_one_thread_and_on_several() {
    let transition = RandomWalk::<1>::new(State::<1>::new(0.5));
    let shifted = RandomWalk::<1> { shift: State::<1>::new(0.6), sigma: State::<1>::new(0.9) };
    let propose = |threads: usize, alone: bool| {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut filter =
            ParticleFilter::new(normal_particles(1000, &mut rng), ParticleFilterOptions::default());
        if alone {
            filter = filter.on_one_thread();
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            filter.propose(&shifted, &transition, &mut rng);
            let found = filter.correct(&Measured { y: 0.3, sigma: 0.4 }, &mut rng);
            (filter.states().to_vec(), found)
        })
    };
    let (states, found) = propose(1, true);
    assert_eq!((states.clone(), found), propose(1, false));
    assert_eq!((states.clone(), found), propose(3, false));
    // No two of the streams are the same.
    assert_ne!(states[0], states[256]);
    assert_ne!(states[256], states[512]);
}

#[test]
fn estimating_after_resampling_has_the_same_mean_but_is_another_number() {
    let transition = RandomWalk::<1>::new(State::<1>::new(1.0));
    let run = |estimate_after_resampling| {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let options = ParticleFilterOptions {
            estimate_after_resampling,
            resampling: Resampling::Multinomial,
            ..Default::default()
        };
        let mut filter = ParticleFilter::new(normal_particles(2000, &mut rng), options);
        filter.step(&transition, &Measured { y: 2.0, sigma: 0.1 }, &mut rng)
    };
    let (before, after) = (run(false), run(true));
    assert!(before.resampled && after.resampled);
    assert_ne!(before.mean, after.mean);
    assert!((before.mean - after.mean).norm() < 0.05);
}

#[test]
fn it_resamples_only_below_the_threshold() {
    let transition = RandomWalk::<1>::new(State::<1>::new(0.1));
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut filter = ParticleFilter::new(normal_particles(1000, &mut rng), ParticleFilterOptions::default());
    let vague = filter.step(&transition, &Measured { y: 0.0, sigma: 10.0 }, &mut rng);
    assert!(!vague.resampled && vague.effective_sample_size > 990.0);
    let sharp = filter.step(&transition, &Measured { y: 0.0, sigma: 0.01 }, &mut rng);
    assert!(sharp.resampled && sharp.effective_sample_size < 100.0);
    assert_eq!(filter.weights()[0], 1.0 / 1000.0);
}

#[test]
fn an_observation_that_nothing_explains_leaves_uniform_weights() {
    let transition = RandomWalk::<1>::new(State::<1>::new(0.1));
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut filter = ParticleFilter::new(normal_particles(100, &mut rng), ParticleFilterOptions::default());
    let found = filter.step(&transition, &Nothing, &mut rng);
    assert_eq!(found.log_evidence, f64::NEG_INFINITY);
    assert!((found.effective_sample_size - 100.0).abs() < 1e-9 && found.mean[0].is_finite());
}

#[test]
fn the_same_seed_gives_the_same_bits_at_any_number_of_threads() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let transition = RandomWalk::<1>::new(State::<1>::new(0.5));
            let mut rng = ChaCha8Rng::seed_from_u64(5);
            let mut filter =
                ParticleFilter::new(normal_particles(1001, &mut rng), ParticleFilterOptions::default());
            YS.map(|y| filter.step(&transition, &Measured { y, sigma: 0.3 }, &mut rng).mean[0].to_bits())
        })
    };
    assert_eq!(run(1), run(2));
    assert_eq!(run(1), run(8));
}

/// The paper's weather: clear days never follow each other; rain and snow stay with 1/2.
struct Weather;

const CLEAR: f64 = 0.0;
const RAIN: f64 = 1.0;
const SNOW: f64 = 2.0;

impl Weather {
    fn probability(next: f64, previous: f64) -> f64 {
        match (previous == CLEAR, next == previous) {
            (true, true) => 0.0,
            (true, false) | (false, true) => 0.5,
            (false, false) => 0.25,
        }
    }
}

impl Transition<1> for Weather {
    fn sample<R: Rng + ?Sized>(&self, previous: &State<1>, rng: &mut R) -> State<1> {
        let mut u: f64 = rng.random();
        for next in [CLEAR, RAIN, SNOW] {
            u -= Self::probability(next, previous[0]);
            if u < 0.0 {
                return State::<1>::new(next);
            }
        }
        State::<1>::new(SNOW)
    }

    fn log_density(&self, next: &State<1>, previous: &State<1>) -> f64 {
        Self::probability(next[0], previous[0]).ln()
    }
}

#[test]
fn a_week_after_rain_it_is_clear_with_the_papers_probability() {
    let mut exact = [0.0, 1.0, 0.0];
    for _ in 0..7 {
        exact = [CLEAR, RAIN, SNOW].map(|next| {
            [CLEAR, RAIN, SNOW]
                .iter()
                .zip(exact)
                .map(|(&p, share)| share * Weather::probability(next, p))
                .sum()
        });
    }
    assert_eq!(exact[0], 0.200_012_207_031_25);

    let n = 200_000;
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut filter = ParticleFilter::new(vec![State::<1>::new(RAIN); n], ParticleFilterOptions::default());
    for _ in 0..7 {
        filter.predict(&Weather, &mut rng);
    }
    let clear = filter.states().iter().filter(|s| s[0] == CLEAR).count() as f64 / n as f64;
    let standard_error = (exact[0] * (1.0 - exact[0]) / n as f64).sqrt();
    assert!((clear - exact[0]).abs() < 4.0 * standard_error, "{clear}");
}

#[test]
fn without_resampling_it_still_meets_the_exact_answer_while_its_weights_degenerate() {
    let (q, r) = (0.3f64, 0.2f64);
    let transition = RandomWalk::<1>::new(State::<1>::new(q.sqrt()));
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let options = ParticleFilterOptions {
        resampling: NoResampling,
        resampling_threshold: 2.0,
        epsilon: 0.0,
        estimate_after_resampling: false,
        regularisation: None,
    };
    let mut filter = ParticleFilter::new(normal_particles(100_000, &mut rng), options);
    let mut sizes = Vec::new();
    for (y, (mean, variance, _)) in YS.iter().zip(kalman(&YS, q, r)) {
        let found = filter.step(&transition, &Measured { y: *y, sigma: r.sqrt() }, &mut rng);
        assert!(!found.resampled);
        assert!((found.mean[0] - mean).abs() < 0.05, "{} {mean}", found.mean[0]);
        assert!((found.covariance[0] - variance).abs() < 0.03, "{} {variance}", found.covariance[0]);
        sizes.push(found.effective_sample_size);
    }
    assert!(sizes.is_sorted_by(|a, b| a > b), "{sizes:?}");
    assert!(sizes[5] < 0.1 * sizes[0], "{sizes:?}");
}

#[test]
fn regularising_draws_copies_apart_and_widens_by_the_bandwidth() {
    for (kernel, variance_of_kernel) in [(Kernel::Gaussian, 1.0), (Kernel::Epanechnikov, 0.2)] {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        let options = ParticleFilterOptions {
            resampling_threshold: 2.0,
            estimate_after_resampling: true,
            regularisation: Some(kernel),
            ..Default::default()
        };
        let n = 50_000;
        let mut filter = ParticleFilter::new(normal_particles(n, &mut rng), options);
        // N(0, 1) seen at 1 with variance 1: N(1/2, 1/2), widened by h^2 times the kernel's variance.
        let found = filter.correct(&Measured { y: 1.0, sigma: 1.0 }, &mut rng);
        let h = kernel.bandwidth(1, n);
        assert!((found.mean[0] - 0.5).abs() < 0.02);
        let expected = 0.5 * (1.0 + h * h * variance_of_kernel);
        assert!((found.covariance[0] - expected).abs() < 0.01, "{} {expected}", found.covariance[0]);
        let mut positions: Vec<u64> = filter.states().iter().map(|s| s[0].to_bits()).collect();
        positions.sort_unstable();
        positions.dedup();
        assert!(positions.len() > n - 10, "copies stayed copies: {}", positions.len());
    }
}

#[test]
fn no_particles_are_a_typed_error() {
    let none = ParticleFilter::<1>::try_new(Vec::new(), ParticleFilterOptions::default());
    assert_eq!(none.unwrap_err(), FilterError::NoParticles);
}

#[test]
fn one_thread_weighs_to_the_same_bits() {
    let run = |alone: bool| {
        let transition = RandomWalk::<1>::new(State::<1>::new(0.5));
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let filter = ParticleFilter::new(normal_particles(501, &mut rng), ParticleFilterOptions::default());
        let mut filter = if alone { filter.on_one_thread() } else { filter };
        YS.map(|y| filter.step(&transition, &Measured { y, sigma: 0.3 }, &mut rng).mean[0].to_bits())
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn no_likelihood_underflows_however_far_the_observation() {
    let states = [0.0, 1.0, 2.0].map(State::<1>::new).to_vec();
    let mut filter = ParticleFilter::new(states, ParticleFilterOptions::default());
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    // The likelihoods are about exp(-5e13), and those of neighbours differ by a factor of exp(1e7).
    let found = filter.correct(&Measured { y: 1e5, sigma: 0.01 }, &mut rng);
    assert_eq!(found.mean[0], 2.0);
    assert!(found.log_evidence.is_finite() && found.log_evidence < -1e13);
    assert!(found.resampled && filter.states().iter().all(|state| state[0] == 2.0));
}
