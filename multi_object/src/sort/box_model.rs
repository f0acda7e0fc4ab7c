//! The motion of a box: [u, v, s, r, u', v', s'] with centre (u, v), area s and aspect ratio r = width / height; the
//! velocities are constant, r is. Measured are u, v, s and r.

use infopart::{
    bayes::{
        Covariance, FilterError, State,
        gaussian::{Gaussian, GaussianNoise},
        kalman::LinearModel,
        model::{Dynamics, Sensor},
    },
    geometry::Rect,
};
use nalgebra::SMatrix;

use crate::motion::MotionModel;

/// Components of the state.
pub(super) const STATE: usize = 7;
/// Components of a measurement.
pub(super) const MEASURED: usize = 4;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BoxModel(LinearModel<STATE, MEASURED>);

impl BoxModel {
    pub(super) fn new() -> Result<Self, FilterError> {
        let mut transition = SMatrix::identity();
        for component in 0..3 {
            transition[(component, component + 4)] = 1.0;
        }
        Ok(Self(LinearModel {
            transition,
            process_noise: GaussianNoise::diagonal(&State::from([1.0, 1.0, 1.0, 1.0, 0.01, 0.01, 1e-4]))?,
            measurement: SMatrix::identity(),
            measurement_noise: GaussianNoise::diagonal(&State::from([1.0, 1.0, 10.0, 10.0]))?,
        }))
    }
}

impl Dynamics<STATE> for BoxModel {
    fn propagate(&self, state: &State<STATE>) -> State<STATE> {
        let mut state = *state;
        self.constrain(&mut state);
        self.0.propagate(&state)
    }

    fn jacobian(&self, _: &State<STATE>) -> SMatrix<f64, STATE, STATE> {
        self.0.transition
    }
}

impl Sensor<STATE, MEASURED> for BoxModel {
    fn measure(&self, state: &State<STATE>) -> State<MEASURED> {
        self.0.measure(state)
    }

    fn jacobian(&self, _: &State<STATE>) -> SMatrix<f64, MEASURED, STATE> {
        self.0.measurement
    }
}

impl MotionModel<STATE, MEASURED> for BoxModel {
    fn linear(&self) -> Option<&LinearModel<STATE, MEASURED>> {
        Some(&self.0)
    }

    fn process_noise(&self) -> &GaussianNoise<STATE> {
        &self.0.process_noise
    }

    fn measurement_noise(&self) -> &GaussianNoise<MEASURED> {
        &self.0.measurement_noise
    }

    /// An area never shrinks below nothing.
    fn constrain(&self, state: &mut State<STATE>) {
        if state[2] + state[6] <= 0.0 {
            state[6] = 0.0;
        }
    }
}

/// The measurement that a box is.
pub(super) fn measured(detection: &Rect) -> State<MEASURED> {
    let (u, v) = detection.centre();
    State::from([u, v, detection.area(), detection.w / detection.h])
}

/// What is believed of a box seen once: it may move anyhow.
pub(super) fn first_belief(detection: &Rect) -> Result<Gaussian<STATE>, FilterError> {
    let seen = measured(detection);
    let mean = State::from([seen[0], seen[1], seen[2], seen[3], 0.0, 0.0, 0.0]);
    let variances = State::from([10.0, 10.0, 10.0, 10.0, 1e4, 1e4, 1e4]);
    Gaussian::new(mean, Covariance::from_diagonal(&variances))
}

/// The box of a state, if it is one.
pub(super) fn box_of(state: &State<STATE>) -> Option<Rect> {
    let w = (state[2] * state[3]).sqrt();
    let h = state[2] / w;
    let found = Rect::new(state[0] - w / 2.0, state[1] - h / 2.0, w, h);
    found.is_proper().then_some(found)
}
