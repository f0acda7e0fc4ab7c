//! Gaussian random walk: x_k = x_k-1 + N(0, diag(sigma^2)).

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::{Proposal, State, Transition};

/// Independent Gaussian steps, shifted by a known amount: as a transition the shift is a known motion, as a
/// proposal it is where the data say the state went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomWalk<const N: usize> {
    /// Mean of a step.
    pub shift: State<N>,
    /// Standard deviation of a step's components, each > 0.
    pub sigma: State<N>,
}

impl<const N: usize> RandomWalk<N> {
    /// A walk without drift.
    pub fn new(sigma: State<N>) -> Self {
        Self { shift: State::zeros(), sigma }
    }

    fn draw<R: Rng + ?Sized>(&self, previous: &State<N>, rng: &mut R) -> State<N> {
        let mut next = previous + self.shift;
        for i in 0..N {
            next[i] += self.sigma[i] * rng.sample::<f64, _>(StandardNormal);
        }
        next
    }

    fn log_density_of_step(&self, step: &State<N>) -> f64 {
        let half_log_two_pi = 0.5 * std::f64::consts::TAU.ln();
        (0..N)
            .map(|i| {
                let z = (step[i] - self.shift[i]) / self.sigma[i];
                -0.5 * z * z - self.sigma[i].ln() - half_log_two_pi
            })
            .sum()
    }
}

impl<const N: usize> Transition<N> for RandomWalk<N> {
    fn sample<R: Rng + ?Sized>(&self, previous: &State<N>, rng: &mut R) -> State<N> {
        self.draw(previous, rng)
    }

    fn log_density(&self, next: &State<N>, previous: &State<N>) -> f64 {
        self.log_density_of_step(&(next - previous))
    }
}

impl<const N: usize> Proposal<N> for RandomWalk<N> {
    fn sample<R: Rng + ?Sized>(&self, previous: &State<N>, rng: &mut R) -> State<N> {
        self.draw(previous, rng)
    }

    fn log_density(&self, next: &State<N>, previous: &State<N>) -> f64 {
        self.log_density_of_step(&(next - previous))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_is_the_standard_normal_scaled() {
        let walk = RandomWalk::<1>::new(State::<1>::new(2.0));
        let at_one_sigma = Transition::log_density(&walk, &State::<1>::new(5.0), &State::<1>::new(3.0));
        let expected = ((-0.5f64).exp() / (2.0 * (2.0 * std::f64::consts::PI).sqrt())).ln();
        assert!((at_one_sigma - expected).abs() < 1e-14);
    }
}
