//! How the centre of an object moves over the picture. Units are pixels, frames and radians; measured is the centre.
//!
//! The noise is one of two: that of the well-known MATLAB example of tracking in atrium.mp4, where it says something (position 100,
//! speed 25, measurement 100, variances a frame, and 200 and 50 at the start), or one in proportion to the object.

use infopart::bayes::{
    Covariance, FilterError, State,
    gaussian::{Gaussian, GaussianNoise},
    kalman::LinearModel,
    model::{Dynamics, Sensor},
};
use nalgebra::SMatrix;

use super::MotionModel;

/// The heading of an object seen once may be any: the variance of a uniform angle, pi² / 3.
const FIRST_HEADING: f64 = std::f64::consts::PI * std::f64::consts::PI / 3.0;
/// 0.1 rad a frame.
const HEADING_NOISE: f64 = 0.01;
const TURN_NOISE: f64 = 0.001;
const FIRST_TURN: f64 = 0.01;
/// Turn rates, rad a frame, below which the path is taken for straight.
const STRAIGHT: f64 = 1e-6;

/// Variances, pixels squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CentreNoise {
    /// What a position gains a frame.
    pub position: f64,
    /// What a speed gains a frame.
    pub speed: f64,
    /// Of a measured centre.
    pub measurement: f64,
    /// Of the position of an object seen once.
    pub first_position: f64,
    /// Of the speed of an object seen once.
    pub first_speed: f64,
}

impl CentreNoise {
    /// That of the MATLAB example, the same for every object.
    pub const ATRIUM: Self =
        Self { position: 100.0, speed: 25.0, measurement: 100.0, first_position: 200.0, first_speed: 50.0 };

    /// In proportion to an object whose area is that of a square of `side` pixels: standard deviations of 1/50 of the side a
    /// frame for position and for speed, 1/12 for a measurement, which a swinging leg or arm moves; an object seen once is
    /// where it was seen to 1/8 of its side and moves by up to about 1/4 of it a frame.
    pub fn for_side(side: f64) -> Self {
        let squared = |share: f64| (share * side).powi(2);
        Self {
            position: squared(1.0 / 50.0),
            speed: squared(1.0 / 50.0),
            measurement: squared(1.0 / 12.0),
            first_position: squared(1.0 / 8.0),
            first_speed: squared(1.0 / 8.0),
        }
    }
}

/// A model whose state begins with the centre (x, y).
pub trait CentreModel<const N: usize>: MotionModel<N, 2> + Sized {
    /// The model under this noise.
    ///
    /// # Errors
    /// [`FilterError`] if a variance is not above 0.
    fn under(noise: CentreNoise) -> Result<Self, FilterError>;

    /// What is believed of an object seen once, at `centre`.
    ///
    /// # Errors
    /// [`FilterError`] if the centre is not finite or a variance is not above 0.
    fn first_belief(centre: (f64, f64), noise: CentreNoise) -> Result<Gaussian<N>, FilterError>;
}

fn first<const N: usize>(centre: (f64, f64), variances: [f64; N]) -> Result<Gaussian<N>, FilterError> {
    let mut mean = State::zeros();
    (mean[0], mean[1]) = centre;
    Gaussian::new(mean, Covariance::from_diagonal(&State::from(variances)))
}

/// Constant velocity: (x, y, x', y').
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantVelocity(LinearModel<4, 2>);

impl Dynamics<4> for ConstantVelocity {
    fn propagate(&self, state: &State<4>) -> State<4> {
        self.0.propagate(state)
    }

    fn jacobian(&self, _: &State<4>) -> SMatrix<f64, 4, 4> {
        self.0.transition
    }
}

impl Sensor<4, 2> for ConstantVelocity {
    fn measure(&self, state: &State<4>) -> State<2> {
        State::from([state[0], state[1]])
    }

    fn jacobian(&self, _: &State<4>) -> SMatrix<f64, 2, 4> {
        self.0.measurement
    }
}

impl MotionModel<4, 2> for ConstantVelocity {
    fn linear(&self) -> Option<&LinearModel<4, 2>> {
        Some(&self.0)
    }

    fn process_noise(&self) -> &GaussianNoise<4> {
        &self.0.process_noise
    }

    fn measurement_noise(&self) -> &GaussianNoise<2> {
        &self.0.measurement_noise
    }
}

impl CentreModel<4> for ConstantVelocity {
    fn under(noise: CentreNoise) -> Result<Self, FilterError> {
        let CentreNoise { position, speed, measurement, .. } = noise;
        let mut transition = SMatrix::identity();
        (transition[(0, 2)], transition[(1, 3)]) = (1.0, 1.0);
        let noise = [position, position, speed, speed];
        Ok(Self(LinearModel {
            transition,
            process_noise: GaussianNoise::diagonal(&State::from(noise))?,
            measurement: SMatrix::identity(),
            measurement_noise: GaussianNoise::diagonal(&State::from([measurement; 2]))?,
        }))
    }

    fn first_belief(centre: (f64, f64), noise: CentreNoise) -> Result<Gaussian<4>, FilterError> {
        let CentreNoise { first_position, first_speed, .. } = noise;
        first(centre, [first_position, first_position, first_speed, first_speed])
    }
}

/// Constant turn rate and speed: (x, y, speed, heading, turn rate). The heading is from the x axis towards the y axis,
/// rad; the turn rate is in rad a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConstantTurn {
    process_noise: GaussianNoise<5>,
    measurement_noise: GaussianNoise<2>,
}

impl Dynamics<5> for ConstantTurn {
    fn propagate(&self, state: &State<5>) -> State<5> {
        let [x, y, speed, heading, turn] = state.data.0[0];
        let after = heading + turn;
        let (dx, dy) = if turn.abs() < STRAIGHT {
            (speed * heading.cos(), speed * heading.sin())
        } else {
            (speed * (after.sin() - heading.sin()) / turn, speed * (heading.cos() - after.cos()) / turn)
        };
        State::from([x + dx, y + dy, speed, after, turn])
    }
}

impl Sensor<5, 2> for ConstantTurn {
    fn measure(&self, state: &State<5>) -> State<2> {
        State::from([state[0], state[1]])
    }

    fn jacobian(&self, _: &State<5>) -> SMatrix<f64, 2, 5> {
        SMatrix::identity()
    }
}

impl MotionModel<5, 2> for ConstantTurn {
    fn linear(&self) -> Option<&LinearModel<5, 2>> {
        None
    }

    fn process_noise(&self) -> &GaussianNoise<5> {
        &self.process_noise
    }

    fn measurement_noise(&self) -> &GaussianNoise<2> {
        &self.measurement_noise
    }
}

impl CentreModel<5> for ConstantTurn {
    fn under(noise: CentreNoise) -> Result<Self, FilterError> {
        let CentreNoise { position, speed, measurement, .. } = noise;
        let noise = [position, position, speed, HEADING_NOISE, TURN_NOISE];
        Ok(Self {
            process_noise: GaussianNoise::diagonal(&State::from(noise))?,
            measurement_noise: GaussianNoise::diagonal(&State::from([measurement; 2]))?,
        })
    }

    fn first_belief(centre: (f64, f64), noise: CentreNoise) -> Result<Gaussian<5>, FilterError> {
        let CentreNoise { first_position, first_speed, .. } = noise;
        first(centre, [first_position, first_position, first_speed, FIRST_HEADING, FIRST_TURN])
    }
}
