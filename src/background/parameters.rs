//! The background model's parameters.

use serde::{Deserialize, Serialize};

use super::{BackgroundError, check_range};

/// How fast the mean and variance of the component that explains a pixel follow it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum ComponentRate {
    /// By learning rate / weight: the mean over the frames that the component explained (KaewTraKulPong and Bowden).
    #[default]
    Owned,
    /// By the learning rate, as weights do: what OpenCV's `bgsegm` does. A rare component settles late.
    Shared,
}

/// Parameters of a [`BackgroundModel`](super::BackgroundModel).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BackgroundParameters {
    /// K: Gaussians a pixel, from 1 to 8; 3 to 5 are usual.
    pub components: usize,
    /// L: frames that the model looks back; the learning rate ends at 1 / L. From 1 to 100,000.
    pub history: usize,
    /// Frames over which the learning rate is 1 / (frames so far); after them it is 1 / L. From 1 to 100,000; more than
    /// L mean L.
    pub training_frames: usize,
    /// T: the share of time that the background accounts for, in [0, 1]. The components of highest weight / deviation
    /// whose weights sum to more than T are background.
    pub background_ratio: f64,
    /// A component explains a pixel within this many standard deviations, in [0.1, 20].
    pub match_deviations: f64,
    /// Standard deviation of the camera's noise, grey levels, in [0.1, 255]: no component is narrower.
    pub noise_sigma: f64,
    /// Standard deviation of a new component, grey levels, in [0.1, 255].
    pub initial_sigma: f64,
    /// Weight of a new component, in [0.0001, 1].
    pub initial_weight: f64,
    /// How fast means and variances follow.
    pub component_rate: ComponentRate,
    /// Whether foreground that is a darker background of the same colour is told apart as shadow.
    pub shadows: bool,
    /// How dark a shadow may be: its brightness as a share of the background's, in [0, 1].
    pub darkest_shadow: f64,
}

impl Default for BackgroundParameters {
    fn default() -> Self {
        Self {
            components: 5,
            history: 200,
            training_frames: 200,
            background_ratio: 0.7,
            match_deviations: 2.5,
            noise_sigma: 15.0,
            initial_sigma: 30.0,
            initial_weight: 0.05,
            component_rate: ComponentRate::default(),
            shadows: false,
            darkest_shadow: 0.7,
        }
    }
}

impl BackgroundParameters {
    /// Checks every value; only what passes can run.
    ///
    /// # Errors
    /// [`BackgroundError::OutOfRange`], naming the key.
    pub fn check(self) -> Result<CheckedBackgroundParameters, BackgroundError> {
        check_range("components", self.components as f64, 1.0, 8.0)?;
        check_range("history", self.history as f64, 1.0, 1e5)?;
        check_range("training_frames", self.training_frames as f64, 1.0, 1e5)?;
        check_range("background_ratio", self.background_ratio, 0.0, 1.0)?;
        check_range("match_deviations", self.match_deviations, 0.1, 20.0)?;
        check_range("noise_sigma", self.noise_sigma, 0.1, 255.0)?;
        check_range("initial_sigma", self.initial_sigma, 0.1, 255.0)?;
        check_range("initial_weight", self.initial_weight, 1e-4, 1.0)?;
        check_range("darkest_shadow", self.darkest_shadow, 0.0, 1.0)?;
        Ok(CheckedBackgroundParameters(self))
    }

    /// The learning rate of frame `frame` (counted from 1).
    pub(super) fn learning_rate(&self, frame: u64) -> f32 {
        let still_training = frame <= self.training_frames.min(self.history) as u64;
        (1.0 / if still_training { frame as f64 } else { self.history as f64 }) as f32
    }
}

/// Parameters that have passed [`BackgroundParameters::check`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CheckedBackgroundParameters(BackgroundParameters);

impl std::ops::Deref for CheckedBackgroundParameters {
    type Target = BackgroundParameters;

    fn deref(&self) -> &BackgroundParameters {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_values_name_their_key_and_range() {
        let refused = |parameters: BackgroundParameters| parameters.check().unwrap_err().to_string();
        let default = BackgroundParameters::default;
        assert!(refused(BackgroundParameters { components: 9, ..default() }).contains("`components` is 9"));
        assert!(refused(BackgroundParameters { history: 0, ..default() }).contains("`history`"));
        let nan = BackgroundParameters { noise_sigma: f64::NAN, ..default() };
        assert!(refused(nan).contains("`noise_sigma` is NaN but must be from 0.1 to 255"));
        default().check().unwrap();
    }

    #[test]
    fn the_rate_is_a_running_mean_first_and_a_window_later() {
        let matlab = BackgroundParameters { training_frames: 40, ..BackgroundParameters::default() };
        let rates = [1, 2, 40, 41, 1000].map(|frame| matlab.learning_rate(frame));
        assert_eq!(rates, [1.0, 0.5, 0.025, 0.005, 0.005]);
        assert_eq!(BackgroundParameters::default().learning_rate(100), 0.01);
    }
}
