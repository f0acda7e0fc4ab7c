//! Regression stumps: f(x) = a [x(k) > theta] + b, the weak classifiers of Algorithm 4.
//!
//! For a given split the least squares solution is closed:
//!   b = sum(omega y [x(k) <= theta]) / sum(omega [x(k) <= theta]),
//!   a = sum(omega y [x(k) > theta]) / sum(omega [x(k) > theta]) - b,
//! and with y = +-1 and weights that sum to 1 the error is J = 1 - gain,
//!   gain = sum(omega y [<=])^2 / sum(omega [<=]) + sum(omega y [>])^2 / sum(omega [>]).

/// A weak classifier.
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// Weight and weighted label of a sample.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Weighted {
    /// omega, > 0.
    pub weight: f64,
    /// omega * y.
    pub signed: f64,
}

/// A way to split the samples by one feature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Split {
    /// 1 - J.
    pub gain: f64,
    /// Samples on the low side, in sorted order.
    pub low_count: usize,
    /// Sums over the low side.
    pub low: Weighted,
}

/// The best threshold of a feature: `sorted` holds (value, sample) in ascending order. `None` if all values are equal.
/// Among equal gains the smallest threshold wins.
pub(super) fn best_split(sorted: &[(f32, u32)], samples: &[Weighted], total: Weighted) -> Option<Split> {
    let mut best: Option<Split> = None;
    let mut best_gain = f64::NEG_INFINITY;
    let mut low = Weighted::default();
    for (count, pair) in sorted.windows(2).enumerate() {
        let sample = samples[pair[0].1 as usize];
        low.weight += sample.weight;
        low.signed += sample.signed;
        if pair[0].0 < pair[1].0 {
            let gain = gain(low, total);
            if gain > best_gain {
                best_gain = gain;
                best = Some(Split { gain, low_count: count + 1, low });
            }
        }
    }
    best
}

/// 1 - J of a split, given the sums on its low side; one division for both sides.
fn gain(low: Weighted, total: Weighted) -> f64 {
    let high_weight = total.weight - low.weight;
    let high_signed = total.signed - low.signed;
    (low.signed * low.signed * high_weight + high_signed * high_signed * low.weight)
        / (low.weight * high_weight)
}

/// The stump of a split.
pub(super) fn stump_of(feature: usize, split: &Split, sorted: &[(f32, u32)], total: Weighted) -> Stump {
    let (below, above) = (sorted[split.low_count - 1].0, sorted[split.low_count].0);
    let middle = below + (above - below) / 2.0;
    // Between neighbouring floats there is no middle: the lower one splits them as well.
    let threshold = if middle < above { middle } else { below };
    let answer =
        |signed: f64, weight: f64| if weight > 0.0 { (signed / weight).clamp(-1.0, 1.0) } else { 0.0 };
    Stump {
        feature,
        threshold,
        low: answer(split.low.signed, split.low.weight) as f32,
        high: answer(total.signed - split.low.signed, total.weight - split.low.weight) as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sorted(values: &[f32]) -> Vec<(f32, u32)> {
        let mut pairs: Vec<(f32, u32)> = values.iter().zip(0..).map(|(v, i)| (*v, i)).collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        pairs
    }

    fn weighted(labels: &[f64], weights: &[f64]) -> (Vec<Weighted>, Weighted) {
        let sum: f64 = weights.iter().sum();
        let samples: Vec<Weighted> = labels
            .iter()
            .zip(weights)
            .map(|(y, w)| Weighted { weight: w / sum, signed: y * w / sum })
            .collect();
        let total = samples.iter().fold(Weighted::default(), |t, s| Weighted {
            weight: t.weight + s.weight,
            signed: t.signed + s.signed,
        });
        (samples, total)
    }

    fn error(stump: &Stump, values: &[f32], samples: &[Weighted]) -> f64 {
        values
            .iter()
            .zip(samples)
            .map(|(v, s)| s.weight * (s.signed / s.weight - f64::from(stump.answer(*v))).powi(2))
            .sum()
    }

    #[test]
    fn a_literal_case_has_the_answers_of_a_hand_count() {
        let values = [1.0, 2.0, 3.0, 4.0];
        let (samples, total) = weighted(&[-1.0, -1.0, 1.0, -1.0], &[1.0; 4]);
        let pairs = sorted(&values);
        let split = best_split(&pairs, &samples, total).unwrap();
        let stump = stump_of(5, &split, &pairs, total);
        assert_eq!(stump, Stump { feature: 5, threshold: 2.5, low: -1.0, high: 0.0 });
        assert!((1.0 - split.gain - 0.5).abs() < 1e-15);
    }

    #[test]
    fn equal_values_cannot_be_split() {
        let (samples, total) = weighted(&[1.0, -1.0], &[1.0, 1.0]);
        assert_eq!(best_split(&sorted(&[2.0, 2.0]), &samples, total), None);
        assert_eq!(best_split(&sorted(&[2.0]), &samples[..1], total), None);
    }

    #[test]
    fn a_threshold_between_neighbouring_floats_still_splits_them() {
        let below = 1.0f32;
        let above = f32::from_bits(below.to_bits() + 1);
        let (samples, total) = weighted(&[-1.0, 1.0], &[1.0, 1.0]);
        let pairs = sorted(&[below, above]);
        let stump = stump_of(0, &best_split(&pairs, &samples, total).unwrap(), &pairs, total);
        assert_eq!((stump.answer(below), stump.answer(above)), (-1.0, 1.0));
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
            let (samples, total) = weighted(&labels, &weights);
            let pairs = sorted(&values);
            if let Some(split) = best_split(&pairs, &samples, total) {
                let found = stump_of(0, &split, &pairs, total);
                let found_error = error(&found, &values, &samples);
                prop_assert!((found_error - (1.0 - split.gain)).abs() < 1e-6);
                for half_steps in 0..16 {
                    let threshold = half_steps as f32 / 2.0 + 0.25;
                    for low in -10..=10 {
                        for high in -10..=10 {
                            let (low, high) = (low as f32 / 10.0, high as f32 / 10.0);
                            let other = Stump { feature: 0, threshold, low, high };
                            prop_assert!(error(&other, &values, &samples) >= found_error - 1e-6);
                        }
                    }
                }
            }
        }
    }
}
