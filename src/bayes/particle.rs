//! The particle filter (Algorithm 1 of the InfoPart paper, over any state).
//!
//! Steps, each frame:
//! 1. draw each particle from the proposal (by default the transition),
//! 2. weigh: weight_i *= p(y | x_i) p(x_i | x_i,k-1) / q(x_i | x_i,k-1, y), as logarithms,
//! 3. normalise, keeping the logarithm of the mean likelihood,
//! 4. N_eff = 1 / sum(weight^2),
//! 5. resample if N_eff < threshold * N_s, weights back to 1 / N_s; a regularised filter then moves each copy by
//!    h A e, with h the kernel's bandwidth, A A' the weighted covariance before resampling, e drawn from the kernel,
//! 6. estimate the weighted mean and its covariance, before or after step 5.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{
    Covariance, FilterError, Observation, Proposal, State, Transition,
    gaussian::semidefinite_factor,
    kernel::Kernel,
    resampling::{Resample, Resampling},
    weights,
};
use crate::parallel::{Chunks, ChunksMut, for_each};

/// Particles that one thread weighs at a time.
const CHUNK: usize = 16;
/// Particles that are drawn from one stream of random numbers, and so by one thread.
const STREAM: usize = 256;

/// How a particle filter normalises, resamples and estimates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ParticleFilterOptions<S = Resampling> {
    /// Scheme that draws the ancestors.
    pub resampling: S,
    /// Resample when N_eff < `resampling_threshold` * N_s; 0 never, above 1 always.
    pub resampling_threshold: f64,
    /// Added to every weight before normalising, relative to the best particle's.
    pub epsilon: f64,
    /// Estimate after resampling, as the paper does, instead of before: same mean, more variance.
    pub estimate_after_resampling: bool,
    /// Kernel that particles are drawn from after resampling (the regularised particle filter); `None` keeps copies.
    pub regularisation: Option<Kernel>,
}

impl Default for ParticleFilterOptions {
    fn default() -> Self {
        Self {
            resampling: Resampling::default(),
            resampling_threshold: 0.5,
            epsilon: 1e-20,
            estimate_after_resampling: false,
            regularisation: None,
        }
    }
}

/// What a step found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleEstimate<const N: usize> {
    /// Weighted mean of the particles.
    pub mean: State<N>,
    /// Weighted covariance of the particles.
    pub covariance: Covariance<N>,
    /// N_eff before resampling, in [1, N_s].
    pub effective_sample_size: f64,
    /// ln of the mean likelihood p(y_k | y_1:k-1); -inf if nothing explains the observation.
    pub log_evidence: f64,
    /// Whether the particles were resampled.
    pub resampled: bool,
}

/// Weighted particles that stand for p(x_k | y_1:k).
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ParticleFilter<const N: usize, S = Resampling> {
    options: ParticleFilterOptions<S>,
    on_one_thread: bool,
    states: Vec<State<N>>,
    weights: Vec<f64>,
    log_weights: Vec<f64>,
    log_likelihoods: Vec<f64>,
    spare: Vec<State<N>>,
    ancestors: Vec<usize>,
}

impl<const N: usize, S: Resample> ParticleFilter<N, S> {
    /// Starts from particles of equal weight.
    ///
    /// # Panics
    /// If there is no particle.
    pub fn new(states: Vec<State<N>>, options: ParticleFilterOptions<S>) -> Self {
        Self::try_new(states, options).expect("a particle filter needs at least one particle")
    }

    /// [`new`](Self::new) for particles that may be none.
    ///
    /// # Errors
    /// [`FilterError::NoParticles`] if there is no particle.
    pub fn try_new(states: Vec<State<N>>, options: ParticleFilterOptions<S>) -> Result<Self, FilterError> {
        let n = states.len();
        if n == 0 {
            return Err(FilterError::NoParticles);
        }
        let uniform = 1.0 / n as f64;
        Ok(Self {
            options,
            on_one_thread: false,
            spare: states.clone(),
            states,
            weights: vec![uniform; n],
            log_weights: vec![uniform.ln(); n],
            log_likelihoods: vec![0.0; n],
            ancestors: Vec::with_capacity(n),
        })
    }

    /// Weighs the particles on the calling thread, for likelihoods too cheap to share, or callers that use the threads
    /// themselves. The results are the same bits.
    pub fn on_one_thread(mut self) -> Self {
        self.on_one_thread = true;
        self
    }

    /// The particles.
    pub fn states(&self) -> &[State<N>] {
        &self.states
    }

    /// The particles' weights; they sum to 1.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Steps 1: moves every particle by the transition, one after another, so that the draws do not depend on threads.
    pub fn predict<R: Rng + ?Sized>(&mut self, transition: &impl Transition<N>, rng: &mut R) {
        for state in &mut self.states {
            *state = transition.sample(state, rng);
        }
    }

    /// Step 1 with a proposal of its own; the weights take p / q. Particles are moved in parallel, each 256 of them
    /// with random numbers of their own.
    pub fn propose<R: Rng + ?Sized>(
        &mut self,
        proposal: &(impl Proposal<N> + Sync),
        transition: &(impl Transition<N> + Sync),
        rng: &mut R,
    ) {
        let seed = rng.random();
        std::mem::swap(&mut self.states, &mut self.spare);
        self.states.resize(self.spare.len(), State::zeros());
        let (next, states, log_weights) = (&mut self.states, &self.spare, &mut self.log_weights);
        // A stream of random numbers: where its particles go to, where they come from, and their log-weights.
        let streams = (ChunksMut(next, STREAM), (Chunks(states, STREAM), ChunksMut(log_weights, STREAM)));
        let least = if self.on_one_thread { usize::MAX / 2 } else { 1 };
        for_each(streams, least, |number, (next, (states, log_weights))| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            rng.set_stream(number as u64);
            for ((next, state), log_weight) in next.iter_mut().zip(states).zip(log_weights) {
                *next = proposal.sample(state, &mut rng);
                *log_weight += transition.log_density(next, state) - proposal.log_density(next, state);
            }
        });
    }

    /// Steps 2 to 6: weighs the moved particles by the observation, in parallel, and resamples if need be.
    pub fn correct<R: Rng + ?Sized>(
        &mut self,
        observation: &(impl Observation<N> + Sync),
        rng: &mut R,
    ) -> ParticleEstimate<N> {
        self.weigh(observation);
        let log_evidence = weights::normalise(&mut self.log_weights, &mut self.weights, self.options.epsilon);
        let effective_sample_size = weights::effective_sample_size(&self.weights);
        let before = self.mean_and_covariance();
        let due = effective_sample_size < self.options.resampling_threshold * self.states.len() as f64;
        let resampled = due && self.resample(rng);
        if resampled && let Some(kernel) = self.options.regularisation {
            self.regularise(kernel, &before.1, rng);
        }
        let (mean, covariance) = if resampled && self.options.estimate_after_resampling {
            self.mean_and_covariance()
        } else {
            before
        };
        ParticleEstimate { mean, covariance, effective_sample_size, log_evidence, resampled }
    }

    /// One whole step with the transition as proposal.
    pub fn step<R: Rng + ?Sized>(
        &mut self,
        transition: &impl Transition<N>,
        observation: &(impl Observation<N> + Sync),
        rng: &mut R,
    ) -> ParticleEstimate<N> {
        self.predict(transition, rng);
        self.correct(observation, rng)
    }

    /// Step 2.
    fn weigh(&mut self, observation: &(impl Observation<N> + Sync)) {
        if self.on_one_thread {
            observation.log_likelihoods(&self.states, &mut self.log_likelihoods);
        } else {
            let chunks = (Chunks(&self.states, CHUNK), ChunksMut(&mut self.log_likelihoods, CHUNK));
            for_each(chunks, 1, |_, (states, out)| observation.log_likelihoods(states, out));
        }
        for (log_weight, log_likelihood) in self.log_weights.iter_mut().zip(&self.log_likelihoods) {
            *log_weight += log_likelihood;
        }
    }

    /// Step 5; whether there was anything to do.
    fn resample<R: Rng + ?Sized>(&mut self, rng: &mut R) -> bool {
        if !self.options.resampling.resample(&self.weights, rng, &mut self.ancestors) {
            return false;
        }
        self.spare.clear();
        self.spare.extend(self.ancestors.iter().map(|&i| self.states[i]));
        std::mem::swap(&mut self.states, &mut self.spare);
        let uniform = 1.0 / self.states.len() as f64;
        self.weights.fill(uniform);
        self.log_weights.fill(uniform.ln());
        true
    }

    /// The end of step 5: particles that were copied are drawn apart.
    fn regularise<R: Rng + ?Sized>(&mut self, kernel: Kernel, covariance: &Covariance<N>, rng: &mut R) {
        let scale = semidefinite_factor(covariance) * kernel.bandwidth(N, self.states.len());
        for state in &mut self.states {
            *state += scale * kernel.sample(rng);
        }
    }

    /// Step 6.
    fn mean_and_covariance(&self) -> (State<N>, Covariance<N>) {
        let weighted = || self.states.iter().zip(&self.weights);
        let mean = weighted().fold(State::zeros(), |sum, (state, &w)| sum + state * w);
        let covariance = weighted().fold(Covariance::zeros(), |sum, (state, &w)| {
            let d = state - mean;
            sum + d * d.transpose() * w
        });
        (mean, covariance)
    }
}

#[cfg(test)]
mod tests;
