//! The oscillator: the truth, the filters' model of it, and what is measured.

use nalgebra::{Matrix2, RowVector2, SMatrix};

use super::{SAMPLES, START, TIME_STEP};
use crate::bayes::{
    State,
    model::{Dynamics, Sensor},
};

/// Runge-Kutta steps from sample to sample.
const SUBSTEPS: usize = 50;

/// (x', x'') at (x, x').
fn slope(mu: f64, state: &State<2>) -> State<2> {
    let (x, velocity) = (state[0], state[1]);
    State::<2>::new(velocity, mu * (1.0 - x * x) * velocity - x)
}

/// (x, x') at every sample, by the classical Runge-Kutta method with steps of a millisecond.
pub fn truth(mu: f64) -> Vec<State<2>> {
    let h = TIME_STEP / SUBSTEPS as f64;
    let step = |state: State<2>| {
        let k1 = slope(mu, &state);
        let k2 = slope(mu, &(state + k1 * (h / 2.0)));
        let k3 = slope(mu, &(state + k2 * (h / 2.0)));
        let k4 = slope(mu, &(state + k3 * h));
        state + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0)
    };
    let next = |state: &State<2>| Some((0..SUBSTEPS).fold(*state, |state, _| step(state)));
    std::iter::successors(Some(State::from(START)), next).take(SAMPLES).collect()
}

/// One Euler step of the oscillator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EulerStep {
    /// Strength of the non-linearity.
    pub mu: f64,
    /// Seconds.
    pub step: f64,
}

impl Dynamics<2> for EulerStep {
    fn propagate(&self, state: &State<2>) -> State<2> {
        state + slope(self.mu, state) * self.step
    }

    fn jacobian(&self, state: &State<2>) -> SMatrix<f64, 2, 2> {
        let (x, velocity) = (state[0], state[1]);
        let of_slope = Matrix2::new(0.0, 1.0, -2.0 * self.mu * x * velocity - 1.0, self.mu * (1.0 - x * x));
        Matrix2::identity() + of_slope * self.step
    }
}

/// x is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position;

impl Sensor<2, 1> for Position {
    fn measure(&self, state: &State<2>) -> State<1> {
        State::<1>::new(state[0])
    }

    fn jacobian(&self, _: &State<2>) -> SMatrix<f64, 1, 2> {
        RowVector2::new(1.0, 0.0)
    }
}
