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

use super::BoxFilter;
use crate::{camera_motion::CameraMotion, motion::MotionModel};

/// Components of the state.
pub(super) const STATE: usize = 7;
/// Components of a measurement.
pub(super) const MEASURED: usize = 4;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BoxModel(LinearModel<STATE, MEASURED>);

/// How uncertain boxes, their motion and their detections are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BoxNoise {
    /// The reference's: the same for boxes of any size, in pixels, with an area known to a few square pixels and an aspect
    /// ratio that may be any. A linear filter does well on it, as only the shares of the variances count.
    #[default]
    Reference,
    /// In proportion to the box a track starts with, so that the beliefs can be meant: standard deviations of 1/20 of the
    /// height for a position and 1/160 for a velocity, a tenth and a fiftieth of the area, a tenth of the aspect ratio.
    Proportional,
}

/// Variances: of the motion in a frame, of a measurement, of the first belief.
struct Variances {
    process: [f64; STATE],
    measurement: [f64; MEASURED],
    first: [f64; STATE],
}

impl BoxNoise {
    fn variances(self, first: &Rect) -> Variances {
        match self {
            Self::Reference => Variances {
                process: [1.0, 1.0, 1.0, 1.0, 0.01, 0.01, 1e-4],
                measurement: [1.0, 1.0, 10.0, 10.0],
                first: [10.0, 10.0, 10.0, 10.0, 1e4, 1e4, 1e4],
            },
            Self::Proportional => {
                let place = (first.h / 20.0).powi(2);
                let speed = (first.h / 160.0).powi(2);
                let (area, growth) = ((first.area() / 10.0).powi(2), (first.area() / 50.0).powi(2));
                let ratio = (0.1 * first.w / first.h).powi(2);
                let fast = 100.0 * speed;
                Variances {
                    process: [place, place, area / 4.0, ratio / 100.0, speed, speed, growth / 25.0],
                    measurement: [place, place, area, ratio],
                    first: [4.0 * place, 4.0 * place, 4.0 * area, 4.0 * ratio, fast, fast, growth],
                }
            }
        }
    }
}

impl BoxModel {
    /// The model of a track that starts with `first`, and what is then believed of it: it may move anyhow.
    pub(super) fn starting(first: &Rect, noise: BoxNoise) -> Result<(Self, Gaussian<STATE>), FilterError> {
        let mut transition = SMatrix::identity();
        for component in 0..3 {
            transition[(component, component + 4)] = 1.0;
        }
        let variances = noise.variances(first);
        let model = Self(LinearModel {
            transition,
            process_noise: GaussianNoise::diagonal(&State::from(variances.process))?,
            measurement: SMatrix::identity(),
            measurement_noise: GaussianNoise::diagonal(&State::from(variances.measurement))?,
        });
        let seen = measured(first);
        let mean = State::from([seen[0], seen[1], seen[2], seen[3], 0.0, 0.0, 0.0]);
        let covariance = Covariance::from_diagonal(&State::from(variances.first));
        Ok((model, Gaussian::new(mean, covariance)?))
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

/// Moves what a filter believes as the camera moved the picture: the centre as a point, its velocity as a direction, the area with
/// the scale.
pub(super) fn move_camera(filter: &mut BoxFilter, motion: &CameraMotion) {
    let CameraMotion { linear, shift } = *motion;
    let scale = motion.area_scale();
    let mut matrix = SMatrix::<f64, STATE, STATE>::identity();
    for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        matrix[(row, column)] = linear[row][column];
        matrix[(row + 4, column + 4)] = linear[row][column];
    }
    (matrix[(2, 2)], matrix[(6, 6)]) = (scale, scale);
    let shift = State::from([shift[0], shift[1], 0.0, 0.0, 0.0, 0.0, 0.0]);
    filter.map_belief(&matrix, &shift);
}

/// The box of a state, if it is one.
pub(super) fn box_of(state: &State<STATE>) -> Option<Rect> {
    let w = (state[2] * state[3]).sqrt();
    let h = state[2] / w;
    let found = Rect::new(state[0] - w / 2.0, state[1] - h / 2.0, w, h);
    found.is_proper().then_some(found)
}
