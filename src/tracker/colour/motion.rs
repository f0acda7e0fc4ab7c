//! How targets move: the mean velocity so far, and the particles' step X'' = X' + v + e.

use std::collections::VecDeque;

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::{
    bayes::Transition,
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

/// The particles' step. Steps that leave the limits end on them.
#[derive(Debug, Clone, Copy)]
pub(super) struct VelocityWalk {
    /// h / w.
    pub aspect: f64,
    /// v, pixels.
    pub velocity: (f64, f64),
    /// Standard deviations of e in x, y and w, pixels.
    pub sigma: PartState,
    /// Where the target may be.
    pub limits: Limits,
}

impl Transition<3> for VelocityWalk {
    fn sample<R: Rng + ?Sized>(&self, previous: &PartState, rng: &mut R) -> PartState {
        let noise: PartState = self.sigma.map(|sigma| sigma * rng.sample::<f64, _>(StandardNormal));
        // A step in width keeps the centre.
        let drift = PartState::new(
            self.velocity.0 - noise[2] / 2.0,
            self.velocity.1 - self.aspect * noise[2] / 2.0,
            0.0,
        );
        self.limits.confine(previous + noise + drift, self.aspect)
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
    fn particles_step_by_velocity_and_noise() {
        let walk = VelocityWalk {
            aspect: 2.0,
            velocity: (5.0, -2.0),
            sigma: PartState::new(1.0, 2.0, 0.5),
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
        // A step in width of deviation 0.5 moves the corner by half of it, and by as much as the height grows.
        let expected = [1.0 + 0.0625, 0.125, 4.0 + 0.25];
        for (found, expected) in square.iter().zip(expected) {
            assert!((found - expected).abs() < 0.1, "{square:?} {expected}");
        }
    }
}
