//! Gentle AdaBoost (Algorithm 4; Friedman, Hastie, Tibshirani 2000) and its score (Algorithm 3).
//!
//! Steps:
//! 1. weights omega_i = 1 / N, or such that both labels weigh the same,
//! 2. s rounds: over every feature k and every threshold theta, the stump that minimises
//!    J = sum omega_i (y_i - f(x_i))^2; ties go to the smallest (J, k, theta); if no threshold splits any
//!    feature, f = sum(omega y) / sum(omega),
//! 3. add it to F, omega_i *= exp(-y_i f(x_i)), and renormalise.
//!
//! The update of an online classifier is a new training on the memory's samples.

use super::{
    memory::{Label, SampleMemory},
    stump::{LANES, Rank, Split, Stump, TIED, best_splits, low_side, stump},
};
use crate::parallel::{Chunks, ChunksMut, for_each, for_each_with};

/// Blocks of features that are worth a thread.
const LEAST_BLOCKS: usize = 4;

/// F: a sum of stumps.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct StrongClassifier {
    stumps: Vec<Stump>,
}

impl StrongClassifier {
    /// The stumps, in the order they were found.
    pub fn stumps(&self) -> &[Stump] {
        &self.stumps
    }

    /// conf = F(x), in [-s, s], `value` giving feature k of the sample. Its sign is the label, its size the confidence.
    pub fn score(&self, value: impl Fn(usize) -> f32) -> f32 {
        self.stumps.iter().map(|stump| stump.answer(value(stump.feature))).sum()
    }
}

/// How a strong classifier is trained.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct BoostingOptions {
    /// s: rounds, and so stumps.
    pub rounds: usize,
    /// Start with both labels weighing the same in total, however many samples each has; otherwise each sample with 1 / N.
    pub balanced: bool,
    /// Each round searches every so many-th block of features, the next round the blocks after those (LazyBoost; Escudero,
    /// Marquez, Rigau 2000, with turns instead of draws); 1 searches all.
    pub turns: usize,
}

/// Trains strong classifiers; holds the scratch that training needs, so that a second training of the same size
/// allocates nothing.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct GentleAdaBoost {
    options: BoostingOptions,
    /// omega y of every sample; the weights sum to 1.
    #[cfg_attr(feature = "save", serde(skip))]
    signed: Vec<f64>,
    /// For each block of features, the samples by rank.
    #[cfg_attr(feature = "save", serde(skip))]
    ranks: Vec<Rank>,
    #[cfg_attr(feature = "save", serde(skip))]
    splits: Vec<[Split; LANES]>,
}

impl GentleAdaBoost {
    /// A trainer.
    pub fn new(options: BoostingOptions) -> Self {
        Self { options, signed: Vec::new(), ranks: Vec::new(), splits: Vec::new() }
    }

    /// Trains on all samples of the memory. Without samples the classifier is empty and scores 0.
    pub fn train(&mut self, memory: &SampleMemory, out: &mut StrongClassifier) {
        out.stumps.clear();
        if memory.is_empty() {
            return;
        }
        self.rank(memory);
        self.start_weights(memory.labels());
        for round in 0..self.options.rounds {
            let stump = self.best_stump(memory, round);
            out.stumps.push(stump);
            self.reweigh(memory, &stump);
        }
    }

    /// Sorts the samples by each feature, as keys that hold value and sample.
    fn rank(&mut self, memory: &SampleMemory) {
        let n = memory.len();
        let blocks = memory.features().div_ceil(LANES);
        self.ranks.resize(blocks * n, [0; LANES]);
        self.splits.resize(blocks, [Split { gain: -1.0, last_low: 0 }; LANES]);
        for_each_with(
            ChunksMut(&mut self.ranks, n),
            LEAST_BLOCKS,
            || Vec::with_capacity(n),
            |keys: &mut Vec<u64>, block, ranks| {
                for lane in 0..LANES {
                    // The last block repeats the last feature, which then loses every tie to itself.
                    let row = memory.row((block * LANES + lane).min(memory.features() - 1));
                    keys.clear();
                    keys.extend(row.iter().zip(0..).map(|(value, sample)| sort_key(*value, sample)));
                    keys.sort_unstable();
                    for (i, rank) in ranks.iter_mut().enumerate() {
                        let sample = keys[i] as u32;
                        let next = keys.get(i + 1).map(|key| row[*key as u32 as usize]);
                        let tied = next == Some(row[sample as usize]);
                        rank[lane] = sample | if tied { TIED } else { 0 };
                    }
                }
            },
        );
    }

    /// Step 1.
    fn start_weights(&mut self, labels: &[Label]) {
        let targets = labels.iter().filter(|l| **l == Label::Target).count();
        let of_each = [labels.len() - targets, targets];
        let present = of_each.iter().filter(|count| **count > 0).count() as f64;
        self.signed.clear();
        self.signed.extend(labels.iter().map(|label| {
            let weight = if self.options.balanced {
                1.0 / (present * of_each[usize::from(*label == Label::Target)] as f64)
            } else {
                1.0 / labels.len() as f64
            };
            weight * label.sign()
        }));
    }

    /// Step 2.
    fn best_stump(&mut self, memory: &SampleMemory, round: usize) -> Stump {
        let (n, signed) = (memory.len(), &self.signed);
        let total = signed.iter().sum::<f64>();
        let turns = self.options.turns.min(self.splits.len()).max(1);
        let turn = round % turns;
        let blocks = (self.splits.as_mut_slice(), Chunks(&self.ranks, n));
        for_each(blocks, LEAST_BLOCKS * turns, |block, (splits, ranks)| {
            if block % turns == turn {
                *splits = best_splits(ranks, signed, total);
            }
        });
        let mut best: Option<(usize, Split)> = None;
        for (block, splits) in self.splits.iter().enumerate().skip(turn).step_by(turns) {
            for (lane, split) in splits.iter().enumerate() {
                if split.gain > best.map_or(-1.0, |(_, best)| best.gain) {
                    best = Some((block * LANES + lane, *split));
                }
            }
        }
        let all = (1.0, total);
        match best {
            Some((feature, split)) => {
                let (ranks, lane) = (&self.ranks[feature / LANES * n..][..n], feature % LANES);
                let value = |rank: usize| memory.row(feature)[(ranks[rank][lane] & !TIED) as usize];
                let sides = (value(split.last_low), value(split.last_low + 1));
                stump(feature, sides, low_side(ranks, lane, split.last_low, signed), all)
            }
            None => {
                let answer = all.1 as f32;
                Stump { feature: 0, threshold: f32::INFINITY, low: answer, high: answer }
            }
        }
    }

    /// Step 3. The floor keeps every weight positive.
    fn reweigh(&mut self, memory: &SampleMemory, stump: &Stump) {
        let factors = [stump.low, stump.high].map(|f| [f64::from(f).exp(), f64::from(-f).exp()]);
        let row = memory.row(stump.feature);
        let mut sum = 0.0;
        for ((signed, label), value) in self.signed.iter_mut().zip(memory.labels()).zip(row) {
            let side = usize::from(*value > stump.threshold);
            *signed *= factors[side][usize::from(*label == Label::Target)];
            sum += signed.abs();
        }
        let floor = f64::MIN_POSITIVE.sqrt();
        for signed in &mut self.signed {
            *signed = signed.signum() * (signed.abs() / sum).max(floor);
        }
    }
}

/// A key that sorts by value, then by sample.
fn sort_key(value: f32, sample: u32) -> u64 {
    let bits = value.to_bits();
    let ordered = if bits >> 31 == 1 { !bits } else { bits | 1 << 31 };
    u64::from(ordered) << 32 | u64::from(sample)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn memory_of(samples: &[(Vec<f32>, Label)]) -> SampleMemory {
        let mut memory = SampleMemory::new(samples[0].0.len(), samples.len(), 0);
        samples.iter().for_each(|(sample, label)| memory.add(sample, *label));
        memory
    }

    fn train(samples: &[(Vec<f32>, Label)], rounds: usize, balanced: bool) -> StrongClassifier {
        let mut classifier = StrongClassifier::default();
        GentleAdaBoost::new(BoostingOptions { rounds, balanced, turns: 1 })
            .train(&memory_of(samples), &mut classifier);
        classifier
    }

    /// Noisy samples that no single stump separates: the label is whether two features have the same sign.
    fn exclusive_or(count: usize) -> Vec<(Vec<f32>, Label)> {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        (0..count)
            .map(|_| {
                let sample: Vec<f32> = (0..6).map(|_| rng.random_range(-1.0..1.0)).collect();
                let same = sample[1] + sample[4] > 0.3 * sample[0];
                (sample, if same { Label::Target } else { Label::Background })
            })
            .collect()
    }

    fn training_error(samples: &[(Vec<f32>, Label)], classifier: &StrongClassifier) -> f64 {
        let wrong = samples
            .iter()
            .filter(|(sample, label)| f64::from(classifier.score(|k| sample[k])) * label.sign() <= 0.0)
            .count();
        wrong as f64 / samples.len() as f64
    }

    /// Algorithm 4 word for word: every feature, every midpoint, J summed over the samples.
    fn naive(samples: &[(Vec<f32>, Label)], rounds: usize) -> Vec<Stump> {
        let n = samples.len();
        let mut weights = vec![1.0 / n as f64; n];
        let mut stumps = Vec::new();
        for _ in 0..rounds {
            let mut best: Option<(f64, Stump)> = None;
            for feature in 0..samples[0].0.len() {
                let mut values: Vec<f32> = samples.iter().map(|(s, _)| s[feature]).collect();
                values.sort_by(f32::total_cmp);
                values.dedup();
                for pair in values.windows(2) {
                    let threshold = pair[0] + (pair[1] - pair[0]) / 2.0;
                    let answer = |high: bool| {
                        let (mut signed, mut weight) = (0.0, 0.0);
                        for ((s, l), w) in samples.iter().zip(&weights) {
                            if (s[feature] > threshold) == high {
                                signed += w * l.sign();
                                weight += w;
                            }
                        }
                        signed / weight
                    };
                    let (low, high) = (answer(false), answer(true));
                    let error: f64 = samples
                        .iter()
                        .zip(&weights)
                        .map(|((s, l), w)| {
                            w * (l.sign() - if s[feature] > threshold { high } else { low }).powi(2)
                        })
                        .sum();
                    if best.as_ref().is_none_or(|(e, _)| error < *e - 1e-12) {
                        best =
                            Some((error, Stump { feature, threshold, low: low as f32, high: high as f32 }));
                    }
                }
            }
            let (_, stump) = best.unwrap();
            for ((s, l), w) in samples.iter().zip(&mut weights) {
                *w *= (-l.sign() * f64::from(stump.answer(s[stump.feature]))).exp();
            }
            let sum: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|w| *w /= sum);
            stumps.push(stump);
        }
        stumps
    }

    #[test]
    fn it_finds_the_stumps_of_the_algorithm_written_out() {
        let samples = exclusive_or(60);
        let found = train(&samples, 8, false);
        for (found, expected) in found.stumps().iter().zip(naive(&samples, 8)) {
            assert_eq!((found.feature, found.threshold), (expected.feature, expected.threshold));
            assert!((found.low - expected.low).abs() < 1e-5 && (found.high - expected.high).abs() < 1e-5);
        }
    }

    #[test]
    fn the_training_error_falls_with_the_rounds() {
        let samples = exclusive_or(300);
        let errors: Vec<f64> =
            [1, 5, 60].iter().map(|r| training_error(&samples, &train(&samples, *r, false))).collect();
        assert!(errors[0] > errors[1] && errors[1] > errors[2], "{errors:?}");
        assert!(errors[2] < 0.03, "{errors:?}");
    }

    #[test]
    fn sort_keys_follow_the_values() {
        let values = [f32::NEG_INFINITY, -2.0, -1.0, 0.0, 0.5, 3.0, f32::INFINITY];
        assert!(values.map(|v| sort_key(v, 9)).is_sorted());
        assert!(sort_key(1.0, 3) < sort_key(1.0, 4));
    }

    #[test]
    fn ties_go_to_the_smallest_feature_and_threshold() {
        let samples = vec![
            (vec![0.0, 0.0, 0.0], Label::Background),
            (vec![0.0, 1.0, 1.0], Label::Target),
            (vec![0.0, 2.0, 2.0], Label::Background),
        ];
        let stump = train(&samples, 1, false).stumps()[0];
        assert_eq!((stump.feature, stump.threshold), (1, 0.5));
    }

    #[test]
    fn samples_that_nothing_splits_get_the_mean_label() {
        let samples =
            vec![(vec![1.0], Label::Target), (vec![1.0], Label::Target), (vec![1.0], Label::Background)];
        let classifier = train(&samples, 2, false);
        assert!((classifier.stumps()[0].answer(1.0) - 1.0 / 3.0).abs() < 1e-6);
        assert!(classifier.stumps()[0].low.is_finite());
    }

    #[test]
    fn balanced_labels_weigh_the_same_however_many_there_are() {
        let mut samples = vec![(vec![0.0], Label::Target)];
        samples.extend((0..9).map(|_| (vec![0.0], Label::Background)));
        assert!(train(&samples, 1, true).score(|_| 0.0).abs() < 1e-6);
        assert!((train(&samples, 1, false).score(|_| 0.0) + 0.8).abs() < 1e-6);
    }

    #[test]
    fn one_label_alone_is_learnt_and_no_sample_gives_no_classifier() {
        let only = vec![(vec![0.0], Label::Target), (vec![3.0], Label::Target)];
        for balanced in [false, true] {
            assert_eq!(train(&only, 3, balanced).score(|_| 1.0), 3.0);
        }
        let mut classifier = StrongClassifier::default();
        GentleAdaBoost::new(BoostingOptions { rounds: 3, balanced: true, turns: 1 })
            .train(&SampleMemory::new(4, 2, 2), &mut classifier);
        assert_eq!(classifier.score(|_| 1.0), 0.0);
    }

    #[test]
    fn in_turns_a_round_finds_the_best_of_its_own_features() {
        // Feature 0 separates the labels; the features of the second block of lanes only tell most of them apart.
        let sample = |i: usize| {
            let mut values = vec![0.0; 2 * LANES];
            values[0] = i as f32;
            values[LANES] = if i.is_multiple_of(5) { 0.0 } else { i as f32 };
            (values, if i < 10 { Label::Background } else { Label::Target })
        };
        let samples: Vec<_> = (0..20).map(sample).collect();
        let features = |turns| {
            let mut classifier = StrongClassifier::default();
            let options = BoostingOptions { rounds: 4, balanced: true, turns };
            GentleAdaBoost::new(options).train(&memory_of(&samples), &mut classifier);
            classifier.stumps().iter().map(|stump| stump.feature).collect::<Vec<_>>()
        };
        assert_eq!(features(1), [0, 0, 0, 0]);
        assert_eq!(features(2), [0, LANES, 0, LANES]);
        assert_eq!(features(100), features(2), "there are no more turns than blocks");
    }

    #[test]
    fn training_for_long_on_separable_samples_stays_finite() {
        let samples: Vec<_> = (0..20)
            .map(|i| (vec![i as f32], if i < 10 { Label::Background } else { Label::Target }))
            .collect();
        let classifier = train(&samples, 2000, true);
        assert!(classifier.stumps().iter().all(|s| s.low.is_finite() && s.high.is_finite()));
        assert!((classifier.score(|_| 15.0) - 2000.0).abs() < 1.0);
    }
}
