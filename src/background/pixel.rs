//! The mixture of one pixel.
//!
//! Steps, each frame, for a colour x and a learning rate a:
//! 1. the component that explains x: the first, in the order of weight / deviation, with
//!    |x - mean|^2 < d^2 * (sum of the channels' variances),
//! 2. weights: w_k = (1 - a) w_k, and a more for the component of step 1,
//! 3. its mean and variance move towards x and (x - mean)^2 by the rate a / w_k, or a ([`ComponentRate`]); the variance
//!    stays above the noise's,
//! 4. if none explains x, the last component is replaced by a wide and light one at x, and weights are normalised,
//! 5. components are brought back into order,
//! 6. the first components whose weights sum to more than T are background; if step 1's is another, x is foreground,
//! 7. foreground of a background component's chromaticity but darker is shadow.
//!
//! [`ComponentRate`]: super::ComponentRate

use super::parameters::{BackgroundParameters, ComponentRate};

/// Mask value of a background pixel.
pub const BACKGROUND: u8 = 0;
/// Mask value of a moving shadow, where shadows are told apart.
pub const SHADOW: u8 = 127;
/// Mask value of a foreground pixel.
pub const FOREGROUND: u8 = 255;

/// How a pixel is learnt from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Learning {
    /// As the parameters say.
    #[default]
    Usual,
    /// Not at all: an object stands there, and what is behind it stays known. (A pixel of which nothing is known is learnt.)
    Hold,
    /// All that is known is forgotten for what is seen now: what stood there has gone.
    Replace,
}

/// A component but for its weight: mean and variance of each channel, grey levels and their squares.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Gaussian {
    pub mean: [f32; 3],
    pub variance: [f32; 3],
}

impl Gaussian {
    fn total_variance(&self) -> f32 {
        self.variance[0] + self.variance[1] + self.variance[2]
    }

    fn squared_distance(&self, colour: &[f32; 3]) -> f32 {
        (0..3).map(|c| (colour[c] - self.mean[c]) * (colour[c] - self.mean[c])).sum()
    }
}

/// What is the same for every pixel of a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Update {
    rate: f32,
    match_squared: f32,
    least_variance: f32,
    background_ratio: f32,
    initial: (f32, f32),
    owned: bool,
    darkest_shadow: Option<f32>,
}

impl Update {
    pub fn new(parameters: &BackgroundParameters, frame: u64) -> Self {
        let square = |value: f64| (value * value) as f32;
        Self {
            rate: parameters.learning_rate(frame),
            match_squared: square(parameters.match_deviations),
            least_variance: square(parameters.noise_sigma),
            background_ratio: parameters.background_ratio as f32,
            initial: (parameters.initial_weight as f32, square(parameters.initial_sigma)),
            owned: parameters.component_rate == ComponentRate::Owned,
            darkest_shadow: parameters.shadows.then_some(parameters.darkest_shadow as f32),
        }
    }

    /// Steps 1 to 7: learns from `colour` and gives its mask value. `weights` and `gaussians` are the pixel's mixture.
    #[inline(always)]
    pub fn apply(
        &self,
        colour: [f32; 3],
        learning: Learning,
        weights: &mut [f32],
        gaussians: &mut [Gaussian],
    ) -> u8 {
        if learning == Learning::Replace {
            weights.fill(0.0);
        }
        let explaining = self.explaining(&colour, weights, gaussians);
        if learning == Learning::Hold && weights[0] > 0.0 {
            return self.label(&colour, explaining.unwrap_or(weights.len()), weights, gaussians);
        }
        let changed = match explaining {
            Some(k) => {
                self.reinforce(k, &colour, weights, gaussians);
                k
            }
            None => self.replace(&colour, weights, gaussians),
        };
        let place = bring_into_order(changed, weights, gaussians);
        self.label(&colour, place, weights, gaussians)
    }

    /// Steps 6 and 7 for a colour that the component at `place` explains.
    #[inline(always)]
    fn label(&self, colour: &[f32; 3], place: usize, weights: &[f32], gaussians: &[Gaussian]) -> u8 {
        let background = self.background_components(weights);
        if place < background {
            BACKGROUND
        } else if self.is_shadow(colour, &gaussians[..background]) {
            SHADOW
        } else {
            FOREGROUND
        }
    }

    /// Step 1. Components without weight are not in use; none in use comes after them.
    #[inline(always)]
    fn explaining(&self, colour: &[f32; 3], weights: &[f32], gaussians: &[Gaussian]) -> Option<usize> {
        let in_use = weights.iter().zip(gaussians).take_while(|(weight, _)| **weight > 0.0);
        in_use
            .map(|(_, gaussian)| gaussian)
            .position(|g| g.squared_distance(colour) < self.match_squared * g.total_variance())
    }

    /// Steps 2 and 3.
    #[inline(always)]
    fn reinforce(&self, k: usize, colour: &[f32; 3], weights: &mut [f32], gaussians: &mut [Gaussian]) {
        for weight in weights.iter_mut() {
            *weight *= 1.0 - self.rate;
        }
        weights[k] += self.rate;
        let rate = if self.owned { (self.rate / weights[k]).min(1.0) } else { self.rate };
        let Gaussian { mean, variance } = &mut gaussians[k];
        for ((mean, variance), value) in mean.iter_mut().zip(variance).zip(colour) {
            let difference = value - *mean;
            *mean += rate * difference;
            *variance = (*variance + rate * (difference * difference - *variance)).max(self.least_variance);
        }
    }

    /// Step 4; gives the place of the new component.
    fn replace(&self, colour: &[f32; 3], weights: &mut [f32], gaussians: &mut [Gaussian]) -> usize {
        let last = weights.iter().position(|weight| *weight <= 0.0).unwrap_or(weights.len() - 1);
        let (weight, variance) = self.initial;
        weights[last] = weight;
        gaussians[last] = Gaussian { mean: *colour, variance: [variance; 3] };
        let scale = 1.0 / weights.iter().sum::<f32>();
        weights.iter_mut().for_each(|weight| *weight *= scale);
        last
    }

    /// Step 6: how many components, from the first on, are background.
    #[inline(always)]
    fn background_components(&self, weights: &[f32]) -> usize {
        let mut sum = 0.0;
        let enough = weights.iter().position(|weight| {
            sum += weight;
            sum > self.background_ratio
        });
        enough.map_or(weights.len(), |k| k + 1)
    }

    /// Step 7: colour = brightness * mean + chromatic distortion.
    fn is_shadow(&self, colour: &[f32; 3], background: &[Gaussian]) -> bool {
        let Some(darkest) = self.darkest_shadow else { return false };
        background.iter().any(|component| {
            let dot = |a: &[f32; 3], b: &[f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let brightness = dot(colour, &component.mean) / dot(&component.mean, &component.mean).max(1.0);
            if !(darkest..1.0).contains(&brightness) {
                return false;
            }
            let of_shadow = component.mean.map(|mean| brightness * mean);
            let distortion: f32 = (0..3).map(|c| (colour[c] - of_shadow[c]).powi(2)).sum();
            distortion < self.match_squared * component.total_variance() * brightness * brightness
        })
    }
}

/// Step 5: moves the component at `k`, the only one out of order, to where it belongs; gives its new place.
#[inline(always)]
fn bring_into_order(mut k: usize, weights: &mut [f32], gaussians: &mut [Gaussian]) -> usize {
    let order = |k: usize, weights: &[f32], gaussians: &[Gaussian]| {
        weights[k] * weights[k] / gaussians[k].total_variance().max(f32::MIN_POSITIVE)
    };
    while k > 0 && order(k - 1, weights, gaussians) < order(k, weights, gaussians) {
        weights.swap(k - 1, k);
        gaussians.swap(k - 1, k);
        k -= 1;
    }
    while k + 1 < weights.len()
        && weights[k + 1] > 0.0
        && order(k + 1, weights, gaussians) > order(k, weights, gaussians)
    {
        weights.swap(k, k + 1);
        gaussians.swap(k, k + 1);
        k += 1;
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn grey(level: f32) -> [f32; 3] {
        [level; 3]
    }

    fn run(parameters: &BackgroundParameters, colours: &[[f32; 3]]) -> (Vec<u8>, Vec<f32>, Vec<Gaussian>) {
        let mut weights = vec![0.0; parameters.components];
        let mut gaussians = vec![Gaussian::default(); parameters.components];
        let labels = colours
            .iter()
            .enumerate()
            .map(|(i, colour)| {
                Update::new(parameters, i as u64 + 1).apply(
                    *colour,
                    Learning::Usual,
                    &mut weights,
                    &mut gaussians,
                )
            })
            .collect();
        (labels, weights, gaussians)
    }

    #[test]
    fn the_first_component_is_the_mean_of_what_it_explained() {
        let parameters = BackgroundParameters { noise_sigma: 1.0, ..BackgroundParameters::default() };
        let (labels, weights, gaussians) = run(&parameters, &[100.0, 110.0, 90.0, 104.0].map(grey));
        assert_eq!(labels, [BACKGROUND; 4]);
        assert!((weights[0] - 1.0).abs() < 1e-6 && weights[1] == 0.0);
        assert!((gaussians[0].mean[1] - 101.0).abs() < 1e-4);
    }

    #[test]
    fn a_rare_colour_is_foreground_until_it_is_there_often_enough() {
        let parameters = BackgroundParameters { history: 20, ..BackgroundParameters::default() };
        let colours: Vec<_> = (0..60).map(|i| if i < 30 { grey(50.0) } else { grey(220.0) }).collect();
        let (labels, weights, gaussians) = run(&parameters, &colours);
        assert!(labels[..30].iter().all(|label| *label == BACKGROUND));
        assert_eq!(labels[30], FOREGROUND);
        // Its weight passes 1 - T = 0.3 after ln(0.7) / ln(1 - 1/20) = 7 frames or a few less, as it starts above 0.
        let frames = labels[30..].iter().filter(|label| **label == FOREGROUND).count();
        assert!((4..=8).contains(&frames), "{frames}");
        assert!((gaussians[0].mean[0] - 220.0).abs() < 0.1 && weights[0] > 0.7);
    }

    #[test]
    fn by_its_own_rate_a_new_component_settles_sooner() {
        let parameters = |component_rate| BackgroundParameters { component_rate, ..Default::default() };
        let mut colours = vec![grey(50.0); 200];
        colours.extend([200.0, 220.0, 220.0, 220.0, 220.0, 220.0].map(grey));
        let level = |rate| run(&parameters(rate), &colours).2[1].mean[0];
        assert!(level(ComponentRate::Shared) < 201.0 && level(ComponentRate::Owned) > 205.0);
    }

    #[test]
    fn a_darker_background_of_the_same_colour_is_shadow_and_another_colour_is_not() {
        let parameters =
            BackgroundParameters { shadows: true, noise_sigma: 4.0, ..BackgroundParameters::default() };
        let seen = |last: [f32; 3]| {
            let mut colours = vec![[200.0, 160.0, 120.0]; 50];
            colours.push(last);
            run(&parameters, &colours).0[50]
        };
        assert_eq!(seen([160.0, 128.0, 96.0]), SHADOW);
        assert_eq!(seen([80.0, 64.0, 48.0]), FOREGROUND, "darker than a shadow may be");
        assert_eq!(seen([96.0, 128.0, 160.0]), FOREGROUND, "another colour");
        assert_eq!(seen([240.0, 192.0, 144.0]), FOREGROUND, "brighter");
    }

    proptest! {
        #[test]
        fn weights_stay_a_distribution_and_components_in_order(
            levels in prop::collection::vec(0u8..=255, 1..120), components in 1usize..=8
        ) {
            let parameters = BackgroundParameters { components, history: 30, ..Default::default() };
            let colours: Vec<_> = levels.iter().map(|level| grey(f32::from(*level))).collect();
            let (labels, weights, gaussians) = run(&parameters, &colours);
            prop_assert_eq!(labels[0], BACKGROUND);
            prop_assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-4);
            let order: Vec<f32> = weights
                .iter()
                .zip(&gaussians)
                .filter(|(weight, _)| **weight > 0.0)
                .map(|(weight, gaussian)| weight * weight / gaussian.total_variance())
                .collect();
            prop_assert!(order.windows(2).all(|pair| pair[0] >= pair[1] * 0.999), "{:?}", order);
            prop_assert!(gaussians.iter().zip(&weights).all(|(g, w)| *w == 0.0 || g.variance[0] >= 224.9));
        }
    }
}
