//! Filters that predict tracks: one front for every filter, over any motion model whose noise is Gaussian and additive.

use infopart::bayes::{
    Covariance, FilterError, State,
    extended::ExtendedKalmanFilter,
    gaussian::{Gaussian, GaussianNoise},
    kalman::{KalmanFilter, LinearModel},
    kernel::Kernel,
    model::{Disturbed, Dynamics, Measured, Sensor},
    particle::{ParticleFilter, ParticleFilterOptions},
    unscented::{MeasuredPoints, SigmaPoints, UnscentedKalmanFilter},
};
use nalgebra::{Cholesky, SMatrix};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

mod models;
#[cfg(test)]
mod tests;

pub use models::{CentreModel, CentreNoise, ConstantTurn, ConstantVelocity};

/// How objects move and what is measured of them, with `N` components of state and `M` of measurement.
pub trait MotionModel<const N: usize, const M: usize>: Dynamics<N> + Sensor<N, M> + Copy + Sync {
    /// The same as matrices, if the model is linear but for [`constrain`](Self::constrain).
    fn linear(&self) -> Option<&LinearModel<N, M>>;

    /// Q.
    fn process_noise(&self) -> &GaussianNoise<N>;

    /// R.
    fn measurement_noise(&self) -> &GaussianNoise<M>;

    /// Puts right, before it moves, a state that cannot be.
    fn constrain(&self, _state: &mut State<N>) {}
}

/// Which filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FilterKind {
    /// The linear Kalman filter.
    Kalman,
    /// The extended Kalman filter.
    Ekf,
    /// The unscented Kalman filter.
    Ukf,
    /// The particle filter, regularised by a Gaussian kernel after resampling.
    Pf,
}

impl FilterKind {
    /// Every filter.
    pub const ALL: [Self; 4] = [Self::Kalman, Self::Ekf, Self::Ukf, Self::Pf];

    /// What tables call it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Kalman => "KF",
            Self::Ekf => "EKF",
            Self::Ukf => "UKF",
            Self::Pf => "PF",
        }
    }
}

/// How a filter runs, where it has a choice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilterOptions {
    /// Particles of a particle filter, at least 1.
    pub particles: usize,
    /// Seed of a particle filter's draws.
    pub seed: u64,
}

impl Default for FilterOptions {
    fn default() -> Self {
        Self { particles: 300, seed: 1 }
    }
}

impl FilterOptions {
    /// The same for one track among many, with draws of its own.
    pub fn for_track(self, identity: u64) -> Self {
        // An odd constant spreads neighbouring seeds over all 64 bits.
        Self { seed: self.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(identity), ..self }
    }
}

/// A filter at work on one track.
#[derive(Debug, Clone)]
pub struct StateFilter<D, const N: usize, const M: usize> {
    model: D,
    engine: Engine<N, M>,
}

#[derive(Debug, Clone)]
enum Engine<const N: usize, const M: usize> {
    Kalman(Box<KalmanFilter<N, M>>),
    Extended(ExtendedKalmanFilter<N>),
    Unscented(Box<UnscentedKalmanFilter<N>>),
    Particle(Box<Particles<N>>),
}

#[derive(Debug, Clone)]
struct Particles<const N: usize> {
    filter: ParticleFilter<N>,
    rng: ChaCha8Rng,
    belief: Gaussian<N>,
}

impl<D: MotionModel<N, M>, const N: usize, const M: usize> StateFilter<D, N, M> {
    /// Starts from a belief. Of a model that is not linear, [`FilterKind::Kalman`] is the extended Kalman filter.
    ///
    /// # Errors
    /// [`FilterError`] if the filter cannot run on the model.
    pub fn new(
        kind: FilterKind,
        model: D,
        belief: Gaussian<N>,
        options: FilterOptions,
    ) -> Result<Self, FilterError> {
        let engine = match (kind, model.linear()) {
            (FilterKind::Kalman, Some(linear)) => {
                Engine::Kalman(Box::new(KalmanFilter::new(*linear, belief)?))
            }
            (FilterKind::Kalman | FilterKind::Ekf, _) => Engine::Extended(ExtendedKalmanFilter::new(belief)),
            (FilterKind::Ukf, _) => {
                let (points, measured) = (SigmaPoints::default(), MeasuredPoints::default());
                Engine::Unscented(Box::new(UnscentedKalmanFilter::new(belief, points, measured)?))
            }
            (FilterKind::Pf, _) => Engine::Particle(Box::new(Particles::new(belief, options)?)),
        };
        Ok(Self { model, engine })
    }

    /// What is believed now.
    pub fn belief(&self) -> &Gaussian<N> {
        match &self.engine {
            Engine::Kalman(filter) => filter.belief(),
            Engine::Extended(filter) => filter.belief(),
            Engine::Unscented(filter) => filter.belief(),
            Engine::Particle(particles) => &particles.belief,
        }
    }

    /// Moves on by a frame.
    ///
    /// # Errors
    /// [`FilterError`] if numbers overflow or a covariance degenerates.
    pub fn predict(&mut self) -> Result<(), FilterError> {
        let Self { model, engine } = self;
        match engine {
            Engine::Kalman(filter) => {
                let mut belief = *filter.belief();
                model.constrain(&mut belief.mean);
                filter.set_belief(belief);
                filter.predict().map(|_| ())
            }
            Engine::Extended(filter) => filter.predict(model, model.process_noise()).map(|_| ()),
            Engine::Unscented(filter) => filter.predict(model, model.process_noise()).map(|_| ()),
            Engine::Particle(particles) => {
                let transition = Disturbed { dynamics: model, noise: model.process_noise() };
                particles.filter.predict(&transition, &mut particles.rng);
                particles.summarise();
                Ok(())
            }
        }
    }

    /// Takes a measurement.
    ///
    /// # Errors
    /// [`FilterError`] if it is not finite or cannot be used; the belief stays.
    pub fn update(&mut self, measured: &State<M>) -> Result<(), FilterError> {
        let Self { model, engine } = self;
        let noise = model.measurement_noise();
        match engine {
            Engine::Kalman(filter) => filter.update(measured).map(|_| ()),
            Engine::Extended(filter) => filter.update(model, noise, measured).map(|_| ()),
            Engine::Unscented(filter) => filter.update(model, noise, measured).map(|_| ()),
            Engine::Particle(particles) => {
                let observation = Measured::new(&*model, noise, *measured)?;
                let estimate = particles.filter.correct(&observation, &mut particles.rng);
                particles.belief = Gaussian { mean: estimate.mean, covariance: estimate.covariance };
                Ok(())
            }
        }
    }

    /// Moves what is believed to `matrix` x + `shift`, as where the coordinates themselves have moved. Particles are drawn anew
    /// from the belief. A belief that would not be one stays as it was.
    pub fn map_belief(&mut self, matrix: &SMatrix<f64, N, N>, shift: &State<N>) {
        let Gaussian { mean, covariance } = *self.belief();
        let Ok(moved) = Gaussian::new(matrix * mean + shift, matrix * covariance * matrix.transpose()) else {
            return;
        };
        match &mut self.engine {
            Engine::Kalman(filter) => filter.set_belief(moved),
            Engine::Extended(filter) => filter.set_belief(moved),
            Engine::Unscented(filter) => filter.set_belief(moved),
            Engine::Particle(particles) => particles.draw_anew(moved),
        }
    }

    /// How far a measurement is from its prediction: residual' S^-1 residual + ln |S|, with S = H P H' + R. Infinite where
    /// S is singular or a number is not finite.
    pub fn assignment_cost(&self, measured: &State<M>) -> f64 {
        let belief = self.belief();
        let jacobian = Sensor::jacobian(&self.model, &belief.mean);
        let covariance =
            jacobian * belief.covariance * jacobian.transpose() + self.model.measurement_noise().covariance();
        let residual = measured - self.model.measure(&belief.mean);
        let Some(factor) = Cholesky::new(covariance) else { return f64::INFINITY };
        let log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|pivot| 2.0 * pivot.ln()).sum();
        let cost = residual.dot(&factor.solve(&residual)) + log_determinant;
        if cost.is_finite() { cost } else { f64::INFINITY }
    }
}

impl<const N: usize> Particles<N> {
    fn new(belief: Gaussian<N>, options: FilterOptions) -> Result<Self, FilterError> {
        let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
        let filter = drawn(options.particles, &belief, &mut rng)?;
        Ok(Self { filter, rng, belief })
    }

    fn draw_anew(&mut self, belief: Gaussian<N>) {
        if let Ok(filter) = drawn(self.filter.states().len(), &belief, &mut self.rng) {
            (self.filter, self.belief) = (filter, belief);
        }
    }

    /// The particles' mean and covariance.
    fn summarise(&mut self) {
        let weighted = || self.filter.states().iter().zip(self.filter.weights());
        let mean: State<N> = weighted().map(|(state, &weight)| state * weight).sum();
        let mut covariance = Covariance::<N>::zeros();
        for (state, &weight) in weighted() {
            let off = state - mean;
            covariance += off * off.transpose() * weight;
        }
        self.belief = Gaussian { mean, covariance };
    }
}

/// Particles drawn from a belief.
fn drawn<const N: usize>(
    particles: usize,
    belief: &Gaussian<N>,
    rng: &mut ChaCha8Rng,
) -> Result<ParticleFilter<N>, FilterError> {
    let spread = GaussianNoise::new(belief.covariance)?;
    let states = (0..particles).map(|_| belief.mean + spread.sample(rng)).collect();
    let options =
        ParticleFilterOptions { regularisation: Some(Kernel::Gaussian), ..ParticleFilterOptions::default() };
    Ok(ParticleFilter::try_new(states, options)?.on_one_thread())
}
