//! Non-linear models with Gaussian noise: one description that the extended and the unscented Kalman filter and, as a
//! [`Transition`] and an [`Observation`], the particle filter run on.

use nalgebra::SMatrix;
use rand::Rng;

use super::{
    FilterError, Observation, State, Transition,
    gaussian::{GaussianNoise, check_finite},
    kalman::LinearModel,
};

/// How a state moves when nothing disturbs it: x_k = f(x_k-1), to which noise is added.
pub trait Dynamics<const N: usize> {
    /// f(`state`).
    fn propagate(&self, state: &State<N>) -> State<N>;

    /// F = df/dx at `state`; central differences unless a model knows better.
    fn jacobian(&self, state: &State<N>) -> SMatrix<f64, N, N> {
        central_differences(|x| self.propagate(x), state)
    }
}

/// How a state moves when noise of `W` components enters anywhere: x_k = f(x_k-1, w_k-1).
pub trait NoisyDynamics<const N: usize, const W: usize> {
    /// f(`state`, `noise`).
    fn propagate(&self, state: &State<N>, noise: &State<W>) -> State<N>;

    /// F = df/dx at (`state`, 0); central differences unless a model knows better.
    fn state_jacobian(&self, state: &State<N>) -> SMatrix<f64, N, N> {
        central_differences(|x| self.propagate(x, &State::zeros()), state)
    }

    /// W = df/dw at (`state`, 0); central differences unless a model knows better.
    fn noise_jacobian(&self, state: &State<N>) -> SMatrix<f64, N, W> {
        central_differences(|w| self.propagate(state, w), &State::zeros())
    }
}

/// What is measured of a state: z = h(x), to which noise is added.
pub trait Sensor<const N: usize, const M: usize> {
    /// h(`state`).
    fn measure(&self, state: &State<N>) -> State<M>;

    /// H = dh/dx at `state`; central differences unless a sensor knows better.
    fn jacobian(&self, state: &State<N>) -> SMatrix<f64, M, N> {
        central_differences(|x| self.measure(x), state)
    }
}

/// The Jacobian of `function` at `at` by central differences, whose error falls with the square of the step: steps of
/// eps^(1/3), relative to a component above 1.
pub fn central_differences<const N: usize, const M: usize>(
    function: impl Fn(&State<N>) -> State<M>,
    at: &State<N>,
) -> SMatrix<f64, M, N> {
    let mut jacobian = SMatrix::<f64, M, N>::zeros();
    for i in 0..N {
        let step = f64::EPSILON.cbrt() * at[i].abs().max(1.0);
        let (mut above, mut below) = (*at, *at);
        above[i] += step;
        below[i] -= step;
        let slope = (function(&above) - function(&below)) / (above[i] - below[i]);
        jacobian.set_column(i, &slope);
    }
    jacobian
}

impl<const N: usize, const M: usize> Dynamics<N> for LinearModel<N, M> {
    fn propagate(&self, state: &State<N>) -> State<N> {
        self.transition * state
    }

    fn jacobian(&self, _: &State<N>) -> SMatrix<f64, N, N> {
        self.transition
    }
}

impl<const N: usize, const M: usize> Sensor<N, M> for LinearModel<N, M> {
    fn measure(&self, state: &State<N>) -> State<M> {
        self.measurement * state
    }

    fn jacobian(&self, _: &State<N>) -> SMatrix<f64, M, N> {
        self.measurement
    }
}

/// x_k = f(x_k-1) + w for a particle filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbed<'a, D, const N: usize> {
    /// f.
    pub dynamics: &'a D,
    /// The distribution of w.
    pub noise: &'a GaussianNoise<N>,
}

impl<D: Dynamics<N>, const N: usize> Transition<N> for Disturbed<'_, D, N> {
    fn sample<R: Rng + ?Sized>(&self, previous: &State<N>, rng: &mut R) -> State<N> {
        self.dynamics.propagate(previous) + self.noise.sample(rng)
    }

    fn log_density(&self, next: &State<N>, previous: &State<N>) -> f64 {
        self.noise.log_density(&(next - self.dynamics.propagate(previous)))
    }
}

/// A measured z = h(x) + v for a particle filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured<'a, S, const M: usize> {
    sensor: &'a S,
    noise: &'a GaussianNoise<M>,
    value: State<M>,
}

impl<'a, S, const M: usize> Measured<'a, S, M> {
    /// The measurement `value` = h(x) + v.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`] if `value` holds a NaN or an infinity.
    pub fn new(sensor: &'a S, noise: &'a GaussianNoise<M>, value: State<M>) -> Result<Self, FilterError> {
        check_finite(&value, "the measurement")?;
        Ok(Self { sensor, noise, value })
    }
}

impl<S: Sensor<N, M>, const N: usize, const M: usize> Observation<N> for Measured<'_, S, M> {
    fn log_likelihood(&self, state: &State<N>) -> f64 {
        self.noise.log_density(&(self.value - self.sensor.measure(state)))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Vector2};

    use super::*;

    #[test]
    fn central_differences_meet_the_derivative_at_any_scale() {
        let function = |x: &State<2>| Vector2::new(x[0].powi(3) * x[1], x[0].sin());
        for at in [Vector2::<f64>::new(0.0, 1.0), Vector2::new(2.0, -3.0), Vector2::new(1e5, 1e-5)] {
            let exact = Matrix2::new(3.0 * at[0] * at[0] * at[1], at[0].powi(3), at[0].cos(), 0.0);
            let found = central_differences(function, &at);
            for (found, exact) in found.iter().zip(exact.iter()) {
                // The sine at 1e5 is sampled with a step of about half a radian.
                let scale = if at[0] > 1e4 { 0.1 } else { 1e-8 };
                assert!((found - exact).abs() <= scale * exact.abs().max(1.0), "{found} {exact}");
            }
        }
    }

    #[test]
    fn a_nan_is_refused_before_it_reaches_a_particle() {
        let noise = GaussianNoise::diagonal(&State::<1>::new(1.0)).unwrap();
        let model = LinearModel::<1, 1> {
            transition: SMatrix::identity(),
            process_noise: noise,
            measurement: SMatrix::identity(),
            measurement_noise: noise,
        };
        assert!(Measured::new(&model, &noise, State::<1>::new(f64::NAN)).is_err());
        let seen = Measured::new(&model, &noise, State::<1>::new(2.0)).unwrap();
        let at_one_sigma = -0.5 - 0.5 * std::f64::consts::TAU.ln();
        assert!((seen.log_likelihood(&State::<1>::new(1.0)) - at_one_sigma).abs() < 1e-15);
        let moves = Disturbed { dynamics: &model, noise: &noise };
        assert!(
            (moves.log_density(&State::<1>::new(4.0), &State::<1>::new(5.0)) - at_one_sigma).abs() < 1e-15
        );
    }
}
