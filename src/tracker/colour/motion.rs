//! How targets move: the mean velocity so far, and the particles' step X'' = X' + v + e.

use std::collections::VecDeque;

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::{
    bayes::{Covariance, Transition},
    tracker::motion::{Limits, PartState},
};

use super::parameters::{ColourParameters, VelocityModel};

/// The mean of the target's steps: all of them, or the last few.
#[derive(Debug, Clone)]
pub(super) struct Velocity {
    model: VelocityModel,
    window: usize,
    steps: u64,
    mean: (f64, f64),
    latest: VecDeque<(f64, f64)>,
}

impl Velocity {
    pub fn new(parameters: &ColourParameters) -> Self {
        Self {
            model: parameters.velocity,
            window: parameters.velocity_window,
            steps: 0,
            mean: (0.0, 0.0),
            latest: VecDeque::with_capacity(parameters.velocity_window + 1),
        }
    }

    /// Takes the latest step, pixels.
    pub fn add(&mut self, current: (f64, f64)) {
        self.steps += 1;
        let m = self.steps as f64;
        let mean = |mean: f64, current: f64| ((m - 1.0) * mean + current) / m;
        match self.model {
            VelocityModel::None => {}
            VelocityModel::Running => {
                self.mean = (mean(self.mean.0, current.0), mean(self.mean.1, current.1));
            }
            VelocityModel::Window => {
                self.latest.push_back(current);
                if self.latest.len() > self.window {
                    self.latest.pop_front();
                }
                let sum = self.latest.iter().fold((0.0, 0.0), |sum, step| (sum.0 + step.0, sum.1 + step.1));
                let count = self.latest.len() as f64;
                self.mean = (sum.0 / count, sum.1 / count);
            }
        }
    }

    /// v, pixels a frame.
    pub fn mean(&self) -> (f64, f64) {
        self.mean
    }
}

/// The regularised filter's Gaussian kernel: the particles' covariance at Silverman's bandwidth, as a lower triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kernel {
    x: f64,
    y_of_x: f64,
    y: f64,
    w: f64,
}

impl Kernel {
    /// The kernel for `particles` particles of this covariance; the width counts as a dimension if it varies.
    pub fn new(covariance: &Covariance<3>, particles: usize) -> Self {
        let dimensions: f64 = if covariance[(2, 2)] > 0.0 { 3.0 } else { 2.0 };
        let exponent = 1.0 / (dimensions + 4.0);
        let bandwidth = (4.0 / (dimensions + 2.0)).powf(exponent) * (particles as f64).powf(-exponent);
        let root = |square: f64| square.max(0.0).sqrt();
        let x = root(covariance[(0, 0)]);
        let y_of_x = if x > 0.0 { covariance[(1, 0)] / x } else { 0.0 };
        let y = root(covariance[(1, 1)] - y_of_x * y_of_x);
        let w = root(covariance[(2, 2)]);
        Self { x: bandwidth * x, y_of_x: bandwidth * y_of_x, y: bandwidth * y, w: bandwidth * w }
    }

    fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> PartState {
        let [a, b, c]: [f64; 3] = std::array::from_fn(|_| rng.sample(StandardNormal));
        PartState::new(self.x * a, self.y_of_x * a + self.y * b, self.w * c)
    }
}

/// The particles' step. Steps that leave the limits end on them.
#[derive(Debug, Clone, Copy)]
pub(super) struct VelocityWalk {
    /// h / w.
    pub aspect: f64,
    /// v, pixels.
    pub velocity: (f64, f64),
    /// Standard deviations of e in x, y and w, pixels.
    pub sigma: PartState,
    /// Moves the particles before the step, if they were resampled and the filter is regularised.
    pub kernel: Option<Kernel>,
    /// Where the target may be.
    pub limits: Limits,
}

impl Transition<3> for VelocityWalk {
    fn sample<R: Rng + ?Sized>(&self, previous: &PartState, rng: &mut R) -> PartState {
        let kernel = self.kernel.map_or_else(PartState::zeros, |kernel| kernel.sample(rng));
        let noise: PartState = self.sigma.map(|sigma| sigma * rng.sample::<f64, _>(StandardNormal));
        let width = kernel[2] + noise[2];
        // A step in width keeps the centre.
        let drift =
            PartState::new(self.velocity.0 - width / 2.0, self.velocity.1 - self.aspect * width / 2.0, 0.0);
        self.limits.confine(previous + kernel + noise + drift, self.aspect)
    }

    fn log_density(&self, next: &PartState, previous: &PartState) -> f64 {
        // The tracker proposes from the transition itself, so only differences of position matter.
        let (dx, dy) = (next[0] - previous[0] - self.velocity.0, next[1] - previous[1] - self.velocity.1);
        let term = |step: f64, sigma: f64| -0.5 * (step / sigma).powi(2) - sigma.ln();
        term(dx, self.sigma[0]) + term(dy, self.sigma[1]) - std::f64::consts::TAU.ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn velocity_is_the_mean_of_all_steps_or_of_the_last() {
        let of = |velocity| {
            let parameters = ColourParameters { velocity, velocity_window: 2, ..Default::default() };
            let mut velocity = Velocity::new(&parameters);
            [(3.0, 0.0), (6.0, -3.0), (0.0, 9.0)].into_iter().for_each(|step| velocity.add(step));
            velocity.mean()
        };
        assert_eq!(of(VelocityModel::None), (0.0, 0.0));
        assert_eq!(of(VelocityModel::Running), (3.0, 2.0));
        assert_eq!(of(VelocityModel::Window), (3.0, 3.0));
    }

    #[test]
    fn particles_step_by_velocity_noise_and_kernel() {
        let covariance = Covariance::<3>::new(16.0, 6.0, 0.0, 6.0, 9.0, 0.0, 0.0, 0.0, 0.0);
        let kernel = Kernel::new(&covariance, 300);
        // Silverman's bandwidth in two dimensions is N^(-1/6).
        let scale = 300f64.powf(-1.0 / 3.0);
        let walk = VelocityWalk {
            aspect: 2.0,
            velocity: (5.0, -2.0),
            sigma: PartState::new(1.0, 2.0, 0.0),
            kernel: Some(kernel),
            limits: Limits { frame_width: 1e4, frame_height: 1e4, narrowest: 1.0, widest: 1e3 },
        };
        let start = PartState::new(500.0, 600.0, 50.0);
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let n = 40_000.0;
        let (mut mean, mut square) = (PartState::zeros(), [0.0; 3]);
        for _ in 0..n as usize {
            let step = walk.sample(&start, &mut rng) - start - PartState::new(5.0, -2.0, 0.0);
            mean += step / n;
            let products = [step[0] * step[0], step[0] * step[1], step[1] * step[1]];
            square.iter_mut().zip(products).for_each(|(sum, product)| *sum += product / n);
        }
        assert!(mean.norm() < 0.05, "{mean}");
        let expected = [1.0 + 16.0 * scale, 6.0 * scale, 4.0 + 9.0 * scale];
        for (found, expected) in square.iter().zip(expected) {
            assert!((found - expected).abs() < 0.1, "{square:?} {expected}");
        }
    }
}
