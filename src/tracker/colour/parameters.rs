//! The colour tracker's parameters.

use serde::{Deserialize, Serialize};

use crate::{
    background::BackgroundParameters,
    bayes::{kernel::Kernel, particle::ParticleFilterOptions, resampling::Resampling},
    features::colour_histogram::Normalisation,
    tracker::ParameterError,
};

/// How fast particles move on: v in X'' = X' + v + e.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum VelocityModel {
    /// Not at all: a random walk.
    None,
    /// By ((m - 1) v_mean + v_current) / m, the mean over the m steps so far.
    #[default]
    Running,
    /// By the mean over the last `velocity_window` steps.
    Window,
}

/// How the halves of the target are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Halves {
    /// Upper and lower half, each with its histogram; the product of both similarities.
    #[default]
    Product,
    /// The same, with the mean of both similarities.
    Mean,
    /// One histogram of the whole target.
    Whole,
}

/// What happens to the particles after they are weighed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum ColourResampling {
    /// Nothing: weights go on from frame to frame (sequential importance sampling).
    None,
    /// N independent draws.
    Multinomial,
    /// One draw in each of N equal strata.
    Stratified,
    /// One draw for all strata.
    #[default]
    Systematic,
    /// The copies that are certain, the rest multinomial.
    Residual,
    /// Systematic, then each particle is moved by a Gaussian kernel of the particles' covariance at Silverman's bandwidth
    /// (the regularised particle filter).
    Regularised,
}

/// Parameters of a [`ColourTracker`](super::ColourTracker). Unknown keys are refused, missing ones take the default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct ColourParameters {
    /// Seed of all randomness, at most 2^53. The same seed gives the same boxes at any number of threads.
    pub seed: u64,
    /// N: particles a target, from 1 to 100,000.
    pub particles: usize,
    /// Particles start uniformly within this distance of the first box, pixels, in [0, 1000].
    pub initial_spread: f64,
    /// Standard deviation of a step in x, share of the target's width, in [0.0001, 10].
    pub noise_x: f64,
    /// Standard deviation of a step in y, share of the target's height, in [0.0001, 10].
    pub noise_y: f64,
    /// Standard deviation of a step in width (the height follows), share of the target's width, in [0, 1]. The method has 0.
    pub noise_w: f64,
    /// How fast particles move on.
    pub velocity: VelocityModel,
    /// Steps of the window, from 1 to 10,000.
    pub velocity_window: usize,
    /// The factor before <H, H_i> in the weight exp(10 <H, H_i>), in [0, 1000].
    pub similarity_weight: f64,
    /// How histograms are scaled.
    pub normalisation: Normalisation,
    /// Whether a histogram of gradient orientations is a cue besides colours.
    pub gradient: bool,
    /// How the halves of the target are compared.
    pub halves: Halves,
    /// Whether only foreground counts; for cameras that do not move.
    pub foreground: bool,
    /// Frames that the background is learnt before foreground counts, from 1 to 100,000.
    pub foreground_after: usize,
    /// The background model, if foreground counts.
    pub background: BackgroundParameters,
    /// Whether levels are scaled so that the surroundings of the target are as bright as in the first frame.
    pub brightness: bool,
    /// How far the target's histograms move towards the current ones in a frame in which it is seen, in [0, 1].
    pub model_rate: f64,
    /// How particles are resampled.
    pub resampling: ColourResampling,
    /// Resample when N_eff falls below this share of N, in [0, 1.1]; above 1 always.
    pub resampling_threshold: f64,
    /// Two targets whose histograms' inner product is below this never hide each other, in [0, 1.1]; above 1 none does.
    pub occlusion_correlation: f64,
    /// Larger targets are sampled down to at most about this many pixels, from 16 to 1,000,000.
    pub max_target_cells: usize,
}

impl Default for ColourParameters {
    fn default() -> Self {
        Self {
            seed: 1,
            particles: 300,
            initial_spread: 5.0,
            noise_x: 0.4,
            noise_y: 0.2,
            noise_w: 0.0,
            velocity: VelocityModel::default(),
            velocity_window: 5,
            similarity_weight: 10.0,
            normalisation: Normalisation::default(),
            gradient: true,
            halves: Halves::default(),
            foreground: false,
            foreground_after: 25,
            background: BackgroundParameters::default(),
            brightness: false,
            model_rate: 0.0,
            resampling: ColourResampling::default(),
            resampling_threshold: 0.5,
            occlusion_correlation: 0.8,
            max_target_cells: 2000,
        }
    }
}

impl ColourParameters {
    /// Reads keys from TOML; missing ones take the default.
    ///
    /// # Errors
    /// [`ParameterError::Toml`] for a syntax error, an unknown key or a value of the wrong type.
    pub fn from_toml(text: &str) -> Result<Self, ParameterError> {
        toml::from_str(text)
            .map_err(|error| ParameterError::Toml { message: error.to_string().trim_end().to_owned() })
    }

    /// Every key as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).unwrap_or_default()
    }

    /// Checks every value; only what passes can run.
    ///
    /// # Errors
    /// [`ParameterError::OutOfRange`] or [`ParameterError::Inconsistent`], naming the key.
    pub fn check(self) -> Result<CheckedColourParameters, ParameterError> {
        within("seed", self.seed, 0, 1 << 53)?;
        within("particles", self.particles, 1, 100_000)?;
        within("initial_spread", self.initial_spread, 0.0, 1000.0)?;
        within("noise_x", self.noise_x, 0.0001, 10.0)?;
        within("noise_y", self.noise_y, 0.0001, 10.0)?;
        within("noise_w", self.noise_w, 0.0, 1.0)?;
        within("velocity_window", self.velocity_window, 1, 10_000)?;
        within("similarity_weight", self.similarity_weight, 0.0, 1000.0)?;
        within("foreground_after", self.foreground_after, 1, 100_000)?;
        within("model_rate", self.model_rate, 0.0, 1.0)?;
        within("resampling_threshold", self.resampling_threshold, 0.0, 1.1)?;
        within("occlusion_correlation", self.occlusion_correlation, 0.0, 1.1)?;
        within("max_target_cells", self.max_target_cells, 16, 1_000_000)?;
        if self.background.clone().check().is_err() {
            let message = "a value under [background] is out of its range: `components` 1 to 8, `history` and \
                           `training_frames` 1 to 100000, shares 0 to 1, deviations 0.1 to 255";
            return Err(ParameterError::Inconsistent { message });
        }
        Ok(CheckedColourParameters(self))
    }

    pub(super) fn filter_options(&self) -> ParticleFilterOptions {
        let never = self.resampling == ColourResampling::None;
        ParticleFilterOptions {
            resampling: match self.resampling {
                ColourResampling::Multinomial => Resampling::Multinomial,
                ColourResampling::Stratified => Resampling::Stratified,
                ColourResampling::Residual => Resampling::Residual,
                _ => Resampling::Systematic,
            },
            resampling_threshold: if never { 0.0 } else { self.resampling_threshold },
            regularisation: (self.resampling == ColourResampling::Regularised).then_some(Kernel::Gaussian),
            ..ParticleFilterOptions::default()
        }
    }
}

fn within<T: PartialOrd + std::fmt::Display>(
    key: &'static str,
    given: T,
    low: T,
    high: T,
) -> Result<(), ParameterError> {
    if given >= low && given <= high {
        return Ok(());
    }
    let (given, low, high) = (given.to_string(), low.to_string(), high.to_string());
    Err(ParameterError::OutOfRange { key, given, low, high })
}

/// Parameters that have passed [`ColourParameters::check`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CheckedColourParameters(ColourParameters);

impl std::ops::Deref for CheckedColourParameters {
    type Target = ColourParameters;

    fn deref(&self) -> &ColourParameters {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_printed_is_read_back_and_bad_values_name_their_key() {
        let default = ColourParameters::default();
        assert_eq!(ColourParameters::from_toml(&default.to_toml()).unwrap(), default);
        let refused = |text: &str| match ColourParameters::from_toml(text) {
            Err(error) => error.to_string(),
            Ok(parameters) => parameters.check().unwrap_err().to_string(),
        };
        for (text, key) in [
            ("particles = 0", "particles"),
            ("noise_x = nan", "noise_x"),
            ("partciles = 3", "partciles"),
            ("resampling = \"best\"", "best"),
            ("[background]\ncomponents = 20", "components"),
        ] {
            assert!(refused(text).contains(key), "{text}: {}", refused(text));
        }
    }
}
