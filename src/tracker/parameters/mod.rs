//! InfoPart's parameters: one table that holds name, type, default, range, unit and meaning of each.

mod field;
mod presets;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::search::SearchExtent;
use crate::{bayes::resampling::Resampling, geometry::Region};
use field::Limited;

/// Version of the parameters' schema. It grows when a key changes its meaning.
pub const SCHEMA_VERSION: u64 = 2;

/// Parameters that cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ParameterError {
    /// No such preset.
    #[error("there is no preset `{name}`; choose one of: {}", Parameters::PRESETS.join(", "))]
    UnknownPreset {
        /// The name as given.
        name: String,
    },
    /// The text is not the TOML of parameters: a syntax error, an unknown key, or a value of another type.
    #[error("{message}\nrun `infopart config` to see every key, its type and its default")]
    Toml {
        /// What is wrong, with the line.
        message: String,
    },
    /// A value is not finite or out of its range.
    #[error("`{key}` is {given} but must be from {low} to {high}")]
    OutOfRange {
        /// The parameter.
        key: &'static str,
        /// The value as given.
        given: String,
        /// Smallest allowed value.
        low: String,
        /// Largest allowed value.
        high: String,
    },
    /// Two values do not fit together.
    #[error("{message}")]
    Inconsistent {
        /// Which, and what to change.
        message: &'static str,
    },
}

/// Declares the parameters' struct, its defaults, its check and its documentation from one table.
macro_rules! parameters {
    ($( $name:ident : $kind:ty = $default:expr, $([$low:expr, $high:expr],)? $unit:literal, $doc:literal; )*) => {
        /// Every parameter of InfoPart. Unknown keys are refused, missing ones take the preset's value.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        #[non_exhaustive]
        pub struct Parameters {
            $(
                #[doc = $doc]
                #[doc = concat!("Unit: ", $unit, ".")]
                pub $name: $kind,
            )*
        }

        impl Default for Parameters {
            fn default() -> Self {
                Self { $( $name: $default, )* }
            }
        }

        impl Parameters {
            /// Checks every value; only what passes can run.
            ///
            /// # Errors
            /// [`ParameterError::OutOfRange`] or [`ParameterError::Inconsistent`], naming the key.
            pub fn check(self) -> Result<CheckedParameters, ParameterError> {
                $( $( self.$name.check(stringify!($name), $low, $high)?; )? )*
                self.check_together()?;
                Ok(CheckedParameters(self))
            }

            /// The parameters as TOML, each with its meaning, unit, range and default before it.
            pub fn to_documented_toml(&self) -> String {
                let mut text = String::from(field::HEADER);
                let default = Self::default();
                $(
                    field::document(&mut text, $doc, $unit, &[$( field::show::<$kind>(&$low), field::show::<$kind>(&$high) )?]);
                    field::assign(&mut text, stringify!($name), &self.$name, &default.$name);
                )*
                text
            }
        }
    };
}

parameters! {
    schema_version: u64 = SCHEMA_VERSION, [SCHEMA_VERSION, SCHEMA_VERSION], "version",
        "Version of this schema.";
    seed: u64 = 1, [0, 1 << 53], "number",
        "Seed of all randomness. The same seed gives the same boxes at any number of threads.";
    region: Region = Region::Part, "part, whole or the upper fraction in (0, 1]",
        "What is tracked of the box, from its top edge down. `part` is head and torso of a person, the upper 5/8.";

    search: SearchExtent = SearchExtent::Frame, "off, near or frame",
        "Where a target that was lost is looked for: nowhere else, near where it was lost, or in the whole frame.";

    particles: usize = 100, [1, 100_000], "particles",
        "N_s: particles, all sets together.";
    particle_sets: usize = 1, [1, 32], "sets",
        "n: independent particle sets that share the particles; their means are weighted by mean likelihood.";
    initial_spread: f64 = 5.0, [0.0, 1000.0], "pixels",
        "Particles start uniformly within this distance of the first box.";
    noise_x: f64 = 0.35, [0.0001, 10.0], "share of max(w, h/2) of the part",
        "sx: standard deviation of a step in x.";
    noise_y: f64 = 0.175, [0.0001, 10.0], "share of h of the part",
        "sy: standard deviation of a step in y.";
    noise_w: f64 = 0.01, [0.0001, 1.0], "share of w of the part",
        "sw: standard deviation of a step in width.";
    scale_about_centre: bool = true, "true or false",
        "Whether a step in width keeps the centre instead of the top left corner.";
    resampling: Resampling = Resampling::Systematic, "multinomial, stratified, systematic or residual",
        "How particles are resampled.";
    resampling_threshold: f64 = 0.5, [0.0, 1.1], "share of N_s",
        "Particles are resampled when the effective sample size falls below this.";
    epsilon: f64 = 1e-20, [0.0, 1.0], "share of the best weight",
        "Added to every weight before normalising.";
    estimate_after_resampling: bool = false, "true or false",
        "Whether the estimate is taken after resampling, which adds variance and nothing else.";

    stumps: usize = 20, [1, 1000], "stumps",
        "s: weak classifiers of gentle AdaBoost.";
    feature_pool: usize = 150, [1, 10_000], "features",
        "Haar-like features that the stumps choose from, drawn at random from all masks, sizes and positions.";
    boosting_turns: usize = 5, [1, 100], "rounds",
        "Each round of training searches this fraction of the features, in turns; 1 searches all of them.";
    score_weight: f64 = 0.75, [0.0, 1000.0], "per unit of score",
        "alpha: weight of the classifier's score in the exponent of the likelihood.";
    score_per_root_stump: bool = true, "true or false",
        "Whether the score is divided by sqrt(s) in the exponent.";
    hog_weight: f64 = 20.0, [0.0, 10_000.0], "per unit of squared distance",
        "gamma: weight of the squared HOG distance in the exponent of the likelihood.";
    hog_ageing: f64 = 0.01, [0.0, 1.0], "share an update",
        "How far the HOG template moves towards the current one at each update; 0 keeps that of frame 1.";
    max_part_cells: usize = 4000, [16, 1_000_000], "cells",
        "Larger parts are averaged down to at most about this many pixels before features are computed.";

    correlation_weight: f64 = 40.0, [0.0, 1000.0], "per unit of response",
        "beta: weight of the place filters' mean response in the exponent of the likelihood; 0 leaves out all cues over the window.";
    correlation_window: f64 = 4.0, [1.0, 10.0], "sqrt(w h) of the whole box",
        "Side of the square window that is searched.";
    correlation_cells: usize = 32, [8, 128], "cells",
        "Cells along the window's side; an odd number is rounded up.";
    correlation_label_sigma: f64 = 0.0625, [0.001, 1.0], "sqrt(w h) of the whole box",
        "Standard deviation of the response that the filters are to give.";
    correlation_filters: usize = 2, [1, 2], "filters",
        "The first filter looks at the target's own cells, the second, if there is one, at its surroundings too.";
    correlation_support: f64 = 1.0, [0.1, 10.0], "share of w and h of the whole box",
        "The first filter is zero farther from the centre than this.";
    correlation_own_cells: bool = true, "true or false",
        "Whether the first filter learns little of cells that are not the target's own by their colour.";
    correlation_surroundings: f64 = 1.3, [0.1, 10.0], "share of w and h of the whole box",
        "The second filter is zero farther from the centre than this.";
    correlation_temporal: f64 = 20.0, [0.0, 1e6], "penalty",
        "mu: how strongly a later filter is held to the one before.";
    correlation_rounds: usize = 2, [1, 20], "rounds",
        "Rounds of the alternating direction method in which a filter learns.";
    colour_weight: f64 = 60.0, [0.0, 1000.0], "per unit of contrast",
        "Weight of the foreground's contrast, by colour, in the exponent of the likelihood.";
    colour_rate: f64 = 0.04, [0.0001, 1.0], "share a learning",
        "How far the colours of target and surroundings move towards what is learnt.";
    correlation_interval: usize = 2, [1, 10_000], "frames",
        "A filter learns every so many frames, in turns.";
    scale_weight: f64 = 40.0, [0.0, 1000.0], "per unit of response",
        "Weight of the scale filter's response in the exponent of the likelihood; 0 leaves it out.";
    scale_sizes: usize = 17, [5, 101], "sizes",
        "Sizes that the scale filter looks at; an even number is rounded up.";
    scale_ratio: f64 = 1.03, [1.001, 1.5], "size over the one before",
        "The step from one of these sizes to the next.";
    scale_rate: f64 = 0.025, [0.0001, 1.0], "share a learning",
        "How far the scale filter moves towards what it learns.";
    peak_share: f64 = 0.5, [0.0, 0.99], "share of particles",
        "Particles drawn around the place that the cues over the window answer to instead of from the walk.";
    peak_spread: f64 = 0.1, [0.001, 10.0], "sqrt(w h) of the part",
        "Standard deviation of those draws along each axis.";

    first_targets: usize = 30, [1, 10_000], "samples",
        "N+: target samples of the first frame, always kept.";
    first_backgrounds: usize = 60, [1, 10_000], "samples",
        "N-: background samples of the first frame, always kept.";
    targets: usize = 10, [0, 10_000], "samples",
        "Target samples added at each update.";
    backgrounds: usize = 20, [0, 10_000], "samples",
        "Background samples added at each update.";
    recent_samples: usize = 120, [0, 100_000], "samples",
        "How many of the latest samples are remembered besides those of the first frame.";
    target_jitter: f64 = 5.0, [0.0, 100.0], "pixels",
        "Target samples lie within this distance of the target along each axis.";
    target_jitter_share: f64 = 1.0, [0.0, 1.0], "share of w and h of the part",
        "And within this share of the part's width and height.";
    background_reach: f64 = 1.0, [0.1, 10.0], "share of max(w, h/2) and of h of the part",
        "Background samples lie up to this far from the target along each axis.";
    background_overlap: f64 = 0.5, [0.0, 0.95], "overlap",
        "Background samples overlap the target by at most this.";
    balanced_labels: bool = true, "true or false",
        "Whether target and background samples weigh the same in total when training starts.";
    update_interval: usize = 4, [1, 10_000], "frames",
        "The classifier is updated every so many frames.";
    update_score: f64 = 2.0, [-1000.0, 1000.0], "score",
        "And only if the classifier's score of the estimate is above this.";
    hard_negatives: usize = 5, [0, 100], "samples a place",
        "Background samples added at each other place that the cues over the window answer to.";
    update_response: f64 = 0.7, [0.0, 1.0], "share of the running mean",
        "Nothing is learnt from a frame in which the filters answer less than this share of what they lately did.";
    update_confidence: f64 = 0.5, [0.0, 1.0], "probability",
        "Nothing is learnt from a frame that, taken alone, gives a lower probability of an overlap above one half.";
}

impl Parameters {
    /// Reads keys from TOML over `base`.
    ///
    /// # Errors
    /// [`ParameterError::Toml`] for a syntax error, an unknown key or a value of the wrong type.
    pub fn from_toml(text: &str, base: Self) -> Result<Self, ParameterError> {
        let error =
            |e: toml::de::Error| ParameterError::Toml { message: e.to_string().trim_end().to_owned() };
        let given: toml::Table = toml::from_str(text).map_err(error)?;
        let mut merged =
            toml::Table::try_from(&base).map_err(|e| ParameterError::Toml { message: e.to_string() })?;
        merged.extend(given);
        merged.try_into().map_err(error)
    }

    fn check_together(&self) -> Result<(), ParameterError> {
        if self.particle_sets > self.particles {
            let message = "`particle_sets` exceeds `particles`: give each set at least one particle";
            return Err(ParameterError::Inconsistent { message });
        }
        Ok(())
    }
}

/// Parameters that have passed [`Parameters::check`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CheckedParameters(Parameters);

impl std::ops::Deref for CheckedParameters {
    type Target = Parameters;

    fn deref(&self) -> &Parameters {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_passes_its_own_check_and_survives_its_documentation() {
        for name in Parameters::PRESETS {
            let preset = Parameters::preset(name).unwrap();
            let back = Parameters::from_toml(&preset.to_documented_toml(), Parameters::default()).unwrap();
            assert_eq!(back, preset, "{name}");
            preset.check().unwrap();
        }
    }

    #[test]
    fn given_keys_override_the_base_and_nothing_else() {
        let base = Parameters { seed: 9, ..Parameters::default() };
        let read = Parameters::from_toml("particles = 50\nregion = \"whole\"", base).unwrap();
        assert_eq!((read.particles, read.seed, read.region), (50, 9, Region::Whole));
        assert_eq!(Parameters::from_toml("region = 0.5", read).unwrap().region, Region::Upper(0.5));
    }

    #[test]
    fn wrong_configurations_name_the_key() {
        let read = |text: &str| Parameters::from_toml(text, Parameters::default());
        let refused = |text: &str| match read(text) {
            Err(error) => error.to_string(),
            Ok(parameters) => parameters.check().unwrap_err().to_string(),
        };
        for (text, key) in [
            ("partciles = 3", "partciles"),
            ("particles = 0", "particles"),
            ("particles = -1", "particles"),
            ("noise_x = nan", "noise_x"),
            ("noise_x = inf", "noise_x"),
            ("score_weight = \"big\"", "score_weight"),
            ("region = 1.5", "region"),
            ("resampling = \"best\"", "best"),
            ("schema_version = 99", "schema_version"),
            ("particles = 3\nparticle_sets = 4", "particle_sets"),
            ("particles = = 3", "1"),
        ] {
            assert!(refused(text).contains(key), "{text}: {}", refused(text));
        }
        assert!(Parameters::preset("best").unwrap_err().to_string().contains("default, paper"));
    }

    #[test]
    fn an_integer_may_stand_where_a_real_number_is_meant() {
        let read = Parameters::from_toml("score_weight = 3", Parameters::default()).unwrap();
        assert_eq!(read.score_weight, 3.0);
    }
}
