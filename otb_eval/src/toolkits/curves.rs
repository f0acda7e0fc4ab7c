//! Hits of a sequence, the curves they give, and the mean of curves.

use infopart::metrics::{PRECISION_THRESHOLDS, R1_PIXELS, SUCCESS_THRESHOLDS};
use serde::Serialize;

use super::{
    Rules,
    thresholds::{NORMALISED_THRESHOLDS, first_hundredth, first_pixel, passed},
};

/// Index of the overlap threshold 0.5.
const HALF: usize = 10;
/// Index of the overlap threshold 0.75.
const THREE_QUARTERS: usize = 15;
/// Index of the normalised threshold 0.2.
const NORMALISED_02: usize = 20;

/// How many frames of a sequence are hits at each threshold. Hits of a sequence's segments can be added up.
#[derive(Debug, Clone, PartialEq)]
pub struct Hits {
    /// The denominator of every share, frames.
    pub frames: usize,
    /// Frames with an overlap above each of the 21 thresholds.
    pub success: [usize; SUCCESS_THRESHOLDS],
    /// Frames with a centre error of at most 0, 1, ..., 50 pixels.
    pub precision: [usize; PRECISION_THRESHOLDS],
    /// Frames with a normalised centre error of at most 0, 0.01, ..., 0.5, where the toolkit has that measure.
    pub normalised: Option<[usize; NORMALISED_THRESHOLDS]>,
    /// Sum of the overlaps of frames with a valid truth.
    pub overlap_sum: f64,
}

impl Hits {
    /// Adds another segment's.
    pub fn merge(&mut self, other: &Self) {
        fn add<const N: usize>(to: &mut [usize; N], from: &[usize; N]) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
        }
        self.frames += other.frames;
        add(&mut self.success, &other.success);
        add(&mut self.precision, &other.precision);
        if let (Some(to), Some(from)) = (&mut self.normalised, &other.normalised) {
            add(to, from);
        }
        self.overlap_sum += other.overlap_sum;
    }

    /// The shares of hits.
    pub fn curves(&self, rules: &Rules) -> Curves {
        let frames = self.frames.max(1);
        let share = |hits: usize| match rules.single_precision {
            true => f64::from(hits as f32 / frames as f32),
            false => hits as f64 / frames as f64,
        };
        Curves {
            success: self.success.map(share),
            precision: self.precision.map(share),
            normalised: self.normalised.map(|hits| hits.map(share)),
            mean_overlap: self.overlap_sum / frames as f64,
            frames: self.frames,
        }
    }
}

/// Counts frames by the thresholds they reach.
pub(super) struct Histogram<'a> {
    rules: &'a Rules,
    /// By how many thresholds the overlap is above.
    success: [usize; SUCCESS_THRESHOLDS + 1],
    /// By the first threshold that the error is within.
    precision: [usize; PRECISION_THRESHOLDS + 1],
    normalised: [usize; NORMALISED_THRESHOLDS + 1],
    overlap_sum: f64,
}

impl<'a> Histogram<'a> {
    pub(super) fn new(rules: &'a Rules) -> Self {
        Self {
            rules,
            success: [0; SUCCESS_THRESHOLDS + 1],
            precision: [0; PRECISION_THRESHOLDS + 1],
            normalised: [0; NORMALISED_THRESHOLDS + 1],
            overlap_sum: 0.0,
        }
    }

    /// An overlap of -1 is a miss at every threshold, an error of -1 a hit; a NaN misses.
    pub(super) fn count(&mut self, overlap: f64, error: f64, normalised_error: f64) {
        self.success[passed(self.rules.thresholds, overlap)] += 1;
        self.precision[first_pixel(error)] += 1;
        self.normalised[first_hundredth(normalised_error)] += 1;
        if overlap > 0.0 {
            self.overlap_sum += overlap;
        }
    }

    pub(super) fn hits(self, frames: usize) -> Hits {
        let mut above = 0;
        let mut success = [0; SUCCESS_THRESHOLDS];
        for index in (0..SUCCESS_THRESHOLDS).rev() {
            above += self.success[index + 1];
            success[index] = above;
        }
        Hits {
            frames,
            success,
            precision: cumulated(&self.precision),
            normalised: self.rules.normalisation.map(|_| cumulated(&self.normalised)),
            overlap_sum: self.overlap_sum,
        }
    }
}

fn cumulated(counts: &[usize; PRECISION_THRESHOLDS + 1]) -> [usize; PRECISION_THRESHOLDS] {
    let mut within = 0;
    std::array::from_fn(|index| {
        within += counts[index];
        within
    })
}

/// Success and precision curves.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Curves {
    /// Share of frames with an overlap above 0, 0.05, ..., 1.
    pub success: [f64; SUCCESS_THRESHOLDS],
    /// Share of frames with a centre error of at most 0, 1, ..., 50 pixels.
    #[serde(serialize_with = "as_slice")]
    pub precision: [f64; PRECISION_THRESHOLDS],
    /// Share of frames with a normalised centre error of at most 0, 0.01, ..., 0.5.
    #[serde(serialize_with = "as_optional_slice")]
    pub normalised: Option<[f64; NORMALISED_THRESHOLDS]>,
    /// Mean overlap over all frames, those with an invalid truth counting as 0.
    pub mean_overlap: f64,
    /// Frames that they are shares of.
    #[serde(skip)]
    pub frames: usize,
}

fn as_slice<S: serde::Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(values)
}

fn as_optional_slice<S: serde::Serializer>(
    values: &Option<[f64; NORMALISED_THRESHOLDS]>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    values.as_ref().map(|values| values.as_slice()).serialize(serializer)
}

impl Curves {
    /// Area under the success curve: the plain mean of its 21 values, at most 20/21.
    pub fn auc(&self) -> f64 {
        self.success.iter().sum::<f64>() / SUCCESS_THRESHOLDS as f64
    }

    /// Precision at 20 pixels.
    pub fn precision_at_20(&self) -> f64 {
        self.precision[R1_PIXELS]
    }

    /// Success at an overlap of 0.5.
    pub fn success_at_half(&self) -> f64 {
        self.success[HALF]
    }

    /// Success at an overlap of 0.75.
    pub fn success_at_three_quarters(&self) -> f64 {
        self.success[THREE_QUARTERS]
    }

    /// Area under the normalised precision curve: the plain mean of its 51 values.
    pub fn normalised_precision_area(&self) -> Option<f64> {
        self.normalised.map(|curve| curve.iter().sum::<f64>() / NORMALISED_THRESHOLDS as f64)
    }

    /// Normalised precision at 0.2, which toolkits print.
    pub fn normalised_precision_at_02(&self) -> Option<f64> {
        self.normalised.map(|curve| curve[NORMALISED_02])
    }

    /// The mean of sequences' curves, each weighing the same, or each frame where the rules have it so; `None` of none. Some toolkits
    /// leave curves of zeros out.
    pub fn mean<'a>(rules: &Rules, sequences: impl Iterator<Item = &'a Self>) -> Option<Self> {
        let sequences: Vec<&Self> = sequences.collect();
        if sequences.is_empty() {
            return None;
        }
        let weight = |one: &&Self| if rules.pools_frames { one.frames as f64 } else { 1.0 };
        let weights: Vec<f64> = sequences.iter().map(weight).collect();
        let total = weights.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let mean_overlap =
            sequences.iter().zip(&weights).map(|(one, weight)| one.mean_overlap * weight).sum::<f64>()
                / total;
        let all_normalised: Option<Vec<_>> = sequences.iter().map(|one| one.normalised.as_ref()).collect();
        Some(Self {
            success: mean_of(rules, &weights, sequences.iter().map(|one| &one.success)),
            precision: mean_of(rules, &weights, sequences.iter().map(|one| &one.precision)),
            normalised: all_normalised.map(|curves| mean_of(rules, &weights, curves.into_iter())),
            mean_overlap,
            frames: sequences.iter().map(|one| one.frames).sum(),
        })
    }
}

fn mean_of<'a, const N: usize>(
    rules: &Rules,
    weights: &[f64],
    curves: impl Iterator<Item = &'a [f64; N]>,
) -> [f64; N] {
    let (mut total, mut count) = ([0.0; N], 0.0);
    for (curve, weight) in curves.zip(weights) {
        if !rules.counts(curve) {
            continue;
        }
        total.iter_mut().zip(curve).for_each(|(total, value)| *total += value * weight);
        count += weight;
    }
    total.map(|total| if count > 0.0 { total / count } else { 0.0 })
}
