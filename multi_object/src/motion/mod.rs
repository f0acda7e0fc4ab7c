//! Filters that predict tracks: one front for every filter, over any motion model.

use infopart::bayes::{
    FilterError, State,
    gaussian::{Gaussian, GaussianNoise},
    kalman::{KalmanFilter, LinearModel},
};

/// How objects move and what is measured of them, with `N` components of state and `M` of measurement.
pub trait MotionModel<const N: usize, const M: usize>: Copy {
    /// The model, if it is linear but for [`constrain`](Self::constrain).
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
}

/// How a filter runs, where it has a choice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilterOptions {
    /// Particles of a particle filter.
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
        Self { seed: self.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(identity), ..self }
    }
}

/// A filter at work on one track.
#[derive(Debug)]
pub struct StateFilter<D, const N: usize, const M: usize> {
    model: D,
    engine: Engine<N, M>,
}

#[derive(Debug)]
enum Engine<const N: usize, const M: usize> {
    Kalman(KalmanFilter<N, M>),
}

impl<D: MotionModel<N, M>, const N: usize, const M: usize> StateFilter<D, N, M> {
    /// Starts from a belief.
    ///
    /// # Errors
    /// [`FilterError`] if the filter cannot run on the model.
    pub fn new(kind: FilterKind, model: D, belief: Gaussian<N>, options: FilterOptions) -> Result<Self, FilterError> {
        let _ = options;
        let engine = match kind {
            FilterKind::Kalman => Engine::Kalman(KalmanFilter::new(*model.linear().unwrap(), belief)?),
        };
        Ok(Self { model, engine })
    }

    /// What is believed now.
    pub fn belief(&self) -> &Gaussian<N> {
        match &self.engine {
            Engine::Kalman(filter) => filter.belief(),
        }
    }

    /// Moves on by a frame.
    ///
    /// # Errors
    /// [`FilterError`] if numbers overflow.
    pub fn predict(&mut self) -> Result<(), FilterError> {
        match &mut self.engine {
            Engine::Kalman(filter) => {
                let mut belief = *filter.belief();
                self.model.constrain(&mut belief.mean);
                filter.set_belief(belief);
                filter.predict().map(|_| ())
            }
        }
    }

    /// Takes a measurement.
    ///
    /// # Errors
    /// [`FilterError`] if it is not finite or cannot be used; the belief stays.
    pub fn update(&mut self, measured: &State<M>) -> Result<(), FilterError> {
        match &mut self.engine {
            Engine::Kalman(filter) => filter.update(measured).map(|_| ()),
        }
    }
}
