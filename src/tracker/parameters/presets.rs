//! Named sets of parameters.

use crate::{bayes::resampling::Resampling, geometry::Region};

use super::{ParameterError, Parameters};
use crate::tracker::SearchExtent;

impl Parameters {
    /// Names that [`preset`](Self::preset) knows.
    pub const PRESETS: &[&str] = &["default", "paper"];

    /// The parameters of that name.
    ///
    /// # Errors
    /// [`ParameterError::UnknownPreset`].
    pub fn preset(name: &str) -> Result<Self, ParameterError> {
        match name {
            "default" => Ok(Self::default()),
            "paper" => Ok(Self::paper()),
            _ => Err(ParameterError::UnknownPreset { name: name.to_owned() }),
        }
    }

    /// The method as printed: the first frame's HOG for ever, the score unscaled, a walk of the top left corner,
    /// bootstrap resampling, the estimate after it, and an unconditional update every frame. What the paper leaves open is
    /// as in the default.
    fn paper() -> Self {
        Self {
            region: Region::Part,
            search: SearchExtent::Off,
            particles: 800,
            scale_about_centre: false,
            resampling: Resampling::Multinomial,
            resampling_threshold: 0.5,
            epsilon: 1e-20,
            estimate_after_resampling: true,
            stumps: 40,
            feature_pool: 300,
            boosting_turns: 1,
            score_per_root_stump: false,
            score_weight: 1.0,
            hog_weight: 20.0,
            hog_ageing: 0.0,
            correlation_weight: 0.0,
            recent_samples: 400,
            target_jitter: 5.0,
            target_jitter_share: 1.0,
            balanced_labels: false,
            update_interval: 1,
            update_score: -1000.0,
            update_confidence: 0.0,
            ..Self::default()
        }
    }
}
