//! Regression stumps: f(x) = a [x(k) > theta] + b, the weak classifiers of Algorithm 4.
//!
//! For a given split the least squares solution is closed:
//!   b = sum(omega y [x(k) <= theta]) / sum(omega [x(k) <= theta]),
//!   a = sum(omega y [x(k) > theta]) / sum(omega [x(k) > theta]) - b,
//! and with y = +-1 and weights that sum to 1 the error is J = 1 - gain,
//!   gain = sum(omega y [<=])^2 / sum(omega [<=]) + sum(omega y [>])^2 / sum(omega [>]).

use multiversion::multiversion;

/// A weak classifier.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Stump {
    /// k: which feature it reads.
    pub feature: usize,
    /// theta: values above it are on the high side.
    pub threshold: f32,
    /// b: the answer on the low side, in [-1, 1].
    pub low: f32,
    /// a + b: the answer on the high side, in [-1, 1].
    pub high: f32,
}

impl Stump {
    /// f(x) for a sample whose feature k is `value`, in [-1, 1].
    pub fn answer(&self, value: f32) -> f32 {
        if value > self.threshold { self.high } else { self.low }
    }
}

/// Features that are scanned side by side: independent sums keep the processor busy.
pub(super) const LANES: usize = 4;

/// One rank of [`LANES`] features: for each, the index of the sample at that rank in ascending order of value, and whether
/// the sample at the next rank has the same value, so that no threshold fits between them.
pub(super) type Rank = [u32; LANES];

/// Set in a [`Rank`] where the next rank has the same value.
pub(super) const TIED: u32 = 1 << 31;

/// A way to split the samples by one feature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Split {
    /// 1 - J.
    pub gain: f64,
    /// Rank of the last sample on the low side.
    pub last_low: usize,
}

/// A split whose sides' weights have a smaller product than this is rounding error. All weights sum to 1.
const LIGHTEST: f64 = 1e-14;

/// The best threshold of each of some features, `signed` holding omega y of every sample and `total` their sum; weights sum to
/// 1. A gain below 0 means that nothing splits. Among equal gains the smallest threshold wins. Compiled for
/// processors with and without AVX2.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn best_splits(ranks: &[Rank], signed: &[f64], total: f64) -> [Split; LANES] {
    let (mut low_weight, mut low_signed) = ([0.0f64; LANES], [0.0f64; LANES]);
    // The best gain as a fraction (comparing fractions needs no division), and its rank.
    let (mut best_over, mut best_under, mut best_rank) = ([-1.0; LANES], [1.0; LANES], [0.0; LANES]);
    for (rank, samples) in ranks[..ranks.len().saturating_sub(1)].iter().enumerate() {
        let weights: [f64; LANES] = std::array::from_fn(|lane| signed[(samples[lane] & !TIED) as usize]);
        for lane in 0..LANES {
            low_signed[lane] += weights[lane];
            low_weight[lane] += weights[lane].abs();
            let (high_weight, high_signed) = (1.0 - low_weight[lane], total - low_signed[lane]);
            let over = low_signed[lane] * low_signed[lane] * high_weight
                + high_signed * high_signed * low_weight[lane];
            let under = low_weight[lane] * high_weight;
            let better = (over * best_under[lane] > best_over[lane] * under)
                & (under > LIGHTEST)
                & (samples[lane] & TIED == 0);
            best_over[lane] = if better { over } else { best_over[lane] };
            best_under[lane] = if better { under } else { best_under[lane] };
            best_rank[lane] = if better { rank as f64 } else { best_rank[lane] };
        }
    }
    std::array::from_fn(|lane| Split {
        gain: best_over[lane] / best_under[lane],
        last_low: best_rank[lane] as usize,
    })
}

/// Sums of omega and omega y over the samples up to `last_low`, of one lane.
pub(super) fn low_side(ranks: &[Rank], lane: usize, last_low: usize, signed: &[f64]) -> (f64, f64) {
    ranks[..=last_low].iter().fold((0.0, 0.0), |(weight, sum), samples| {
        let signed = signed[(samples[lane] & !TIED) as usize];
        (weight + signed.abs(), sum + signed)
    })
}

/// The stump of a split of `feature`: its values on both sides of the split, and (omega, omega y) of the low side and of all.
pub(super) fn stump(feature: usize, (below, above): (f32, f32), low: (f64, f64), all: (f64, f64)) -> Stump {
    let middle = below + (above - below) / 2.0;
    // Between neighbouring floats there is no middle: the lower one splits them as well.
    let threshold = if middle < above { middle } else { below };
    let answer = |weight: f64, signed: f64| (signed / weight).clamp(-1.0, 1.0) as f32;
    Stump { feature, threshold, low: answer(low.0, low.1), high: answer(all.0 - low.0, all.1 - low.1) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    struct Case {
        values: Vec<f32>,
        signed: Vec<f64>,
    }

    impl Case {
        fn new(values: &[f32], labels: &[f64], weights: &[f64]) -> Self {
            let sum: f64 = weights.iter().sum();
            Self {
                values: values.to_vec(),
                signed: labels.iter().zip(weights).map(|(y, w)| y * w / sum).collect(),
            }
        }

        fn best(&self) -> Option<(Split, Stump)> {
            let mut order: Vec<usize> = (0..self.values.len()).collect();
            order.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
            let value = |rank: usize| self.values[order[rank]];
            let tied = |i: usize| i + 1 < order.len() && value(i) == value(i + 1);
            let ranks: Vec<Rank> =
                (0..order.len()).map(|i| [order[i] as u32 | if tied(i) { TIED } else { 0 }; LANES]).collect();
            let splits = best_splits(&ranks, &self.signed, self.signed.iter().sum());
            assert!(splits.iter().all(|split| *split == splits[0]), "lanes agree");
            let split = splits[0];
            if split.gain < 0.0 {
                return None;
            }
            let sides = (value(split.last_low), value(split.last_low + 1));
            let low = low_side(&ranks, 1, split.last_low, &self.signed);
            Some((split, stump(5, sides, low, (1.0, self.signed.iter().sum()))))
        }

        fn error(&self, stump: &Stump) -> f64 {
            let of = |(v, s): (&f32, &f64)| s.abs() * (s.signum() - f64::from(stump.answer(*v))).powi(2);
            self.values.iter().zip(&self.signed).map(of).sum()
        }
    }

    #[test]
    fn a_literal_case_has_the_answers_of_a_hand_count() {
        let case = Case::new(&[1.0, 2.0, 3.0, 4.0], &[-1.0, -1.0, 1.0, -1.0], &[1.0; 4]);
        let (split, stump) = case.best().unwrap();
        assert_eq!(stump, Stump { feature: 5, threshold: 2.5, low: -1.0, high: 0.0 });
        assert!((1.0 - split.gain - 0.5).abs() < 1e-15);
    }

    #[test]
    fn equal_values_cannot_be_split() {
        assert!(Case::new(&[2.0, 2.0], &[1.0, -1.0], &[1.0; 2]).best().is_none());
        assert!(Case::new(&[2.0], &[1.0], &[1.0]).best().is_none());
    }

    #[test]
    fn a_threshold_between_neighbouring_floats_still_splits_them() {
        let below = 1.0f32;
        let above = f32::from_bits(below.to_bits() + 1);
        let (_, stump) = Case::new(&[below, above], &[-1.0, 1.0], &[1.0; 2]).best().unwrap();
        assert_eq!((stump.answer(below), stump.answer(above)), (-1.0, 1.0));
    }

    #[test]
    fn a_side_that_weighs_nothing_is_no_side() {
        assert!(Case::new(&[1.0, 2.0], &[-1.0, 1.0], &[1.0, 1e-20]).best().is_none());
    }

    proptest! {
        /// No (a, b, theta) on a fine grid, theta also outside the samples, has a smaller error.
        #[test]
        fn the_closed_form_beats_every_other_stump(
            cases in prop::collection::vec((0i8..8, any::<bool>(), 1u8..20), 2..9)
        ) {
            let values: Vec<f32> = cases.iter().map(|c| f32::from(c.0)).collect();
            let labels: Vec<f64> = cases.iter().map(|c| if c.1 { 1.0 } else { -1.0 }).collect();
            let weights: Vec<f64> = cases.iter().map(|c| f64::from(c.2)).collect();
            let case = Case::new(&values, &labels, &weights);
            if let Some((split, found)) = case.best() {
                let found_error = case.error(&found);
                prop_assert!((found_error - (1.0 - split.gain)).abs() < 1e-6);
                for half_steps in 0..16 {
                    let threshold = half_steps as f32 / 2.0 + 0.25;
                    for low in -10..=10 {
                        for high in -10..=10 {
                            let (low, high) = (low as f32 / 10.0, high as f32 / 10.0);
                            let other = Stump { feature: 5, threshold, low, high };
                            prop_assert!(case.error(&other) >= found_error - 1e-6);
                        }
                    }
                }
            }
        }
    }
}
