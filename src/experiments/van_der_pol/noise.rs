//! Errors of the measurements: a Gaussian and two that are not, all of mean 0 and one variance.

use rand::{Rng, RngExt};
use rand_distr::{StandardNormal, StudentT};
use serde::Serialize;

use crate::bayes::{Observation, State};

/// Degrees of freedom of Student's t: the fewest whole ones that have a variance.
const DEGREES_OF_FREEDOM: f64 = 3.0;
/// Where the two modes lie, in standard deviations of the whole.
const MODE: f64 = 0.95;

/// The distribution of errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum NoiseShape {
    /// Normal.
    Gauss,
    /// Student's t with 3 degrees of freedom: heavy tails.
    Student,
    /// Two equal normal modes at +-0.95 standard deviations: hardly ever near 0.
    Bimodal,
}

/// Errors of a shape and a variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasurementNoise {
    shape: NoiseShape,
    deviation: f64,
    log_scale: f64,
    student: StudentT<f64>,
}

impl MeasurementNoise {
    /// Errors of a variance > 0.
    pub fn new(shape: NoiseShape, variance: f64) -> Self {
        let deviation = variance.sqrt();
        let student = StudentT::new(DEGREES_OF_FREEDOM).expect("3 degrees of freedom are above 0");
        Self { shape, deviation, log_scale: deviation.ln(), student }
    }

    /// A draw.
    pub fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> f64 {
        let standard = match self.shape {
            NoiseShape::Gauss => rng.sample(StandardNormal),
            NoiseShape::Student => rng.sample(self.student) / DEGREES_OF_FREEDOM.sqrt(),
            NoiseShape::Bimodal => {
                let mode = if rng.random::<bool>() { MODE } else { -MODE };
                mode + (1.0 - MODE * MODE).sqrt() * rng.sample::<f64, _>(StandardNormal)
            }
        };
        standard * self.deviation
    }

    /// ln of the density of an error.
    pub fn log_density(&self, error: f64) -> f64 {
        let z = error / self.deviation;
        let half_log_two_pi = 0.5 * std::f64::consts::TAU.ln();
        let standard = match self.shape {
            NoiseShape::Gauss => -0.5 * z * z - half_log_two_pi,
            // 2 / (pi (1 + z^2)^2): t with 3 degrees of freedom, scaled to variance 1.
            NoiseShape::Student => std::f64::consts::FRAC_2_PI.ln() - 2.0 * (z * z).ln_1p(),
            NoiseShape::Bimodal => {
                let variance = 1.0 - MODE * MODE;
                let (near, far) = (z.abs() - MODE, z.abs() + MODE);
                let share_of_far = (-0.5 * (far * far - near * near) / variance).exp();
                -0.5 * near * near / variance + share_of_far.ln_1p()
                    - (2.0f64).ln()
                    - 0.5 * variance.ln()
                    - half_log_two_pi
            }
        };
        standard - self.log_scale
    }
}

/// A measured x with errors of any shape, for a particle filter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen<'a> {
    pub x: f64,
    pub noise: &'a MeasurementNoise,
}

impl Observation<2> for Seen<'_> {
    fn log_likelihood(&self, state: &State<2>) -> f64 {
        self.noise.log_density(self.x - state[0])
    }
}
