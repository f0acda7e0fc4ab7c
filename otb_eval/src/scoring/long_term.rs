//! How well trackers follow targets that are absent for a while: VOT-LT's F-score.
//!
//! Steps:
//! 1. a frame is answered at a threshold if it has a box with a confidence of at least that,
//! 2. precision is the mean overlap over answered frames, 0 where the target is absent; 1 if none is answered,
//! 3. recall is the sum of overlaps over answered frames where the target is present, over all frames where it is,
//! 4. both are averaged over sequences, F is their harmonic mean, and the best threshold is the one to quote.
//!
//! A. Lukežič et al., "Now you see me: evaluating performance in long-term visual tracking", 2018.

use infopart::geometry::Rect;
use serde::Serialize;

use super::{ScoreOptions, Spread};
use crate::{
    dataset::{Dataset, Target},
    results::{Results, SeedResults},
    statistics::{deviation, mean},
};

/// Thresholds that are tried; where there are more confidences, that many of them, evenly by rank.
const MOST_THRESHOLDS: usize = 1000;

/// Precision and recall at one threshold.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LongTermPoint {
    /// The confidence from which on a frame is answered.
    pub threshold: f64,
    /// Mean overlap of what was answered.
    pub precision: f64,
    /// Overlap of what was answered, over the frames where the target is present.
    pub recall: f64,
}

impl LongTermPoint {
    /// The harmonic mean of both; 0 if both are.
    pub fn f(&self) -> f64 {
        let sum = self.precision + self.recall;
        if sum > 0.0 { 2.0 * self.precision * self.recall / sum } else { 0.0 }
    }
}

/// A tracker's long-term scores.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LongTermScores {
    /// The tracker.
    pub tracker: String,
    /// The best F, its mean and spread over seeds; `None` without a sequence.
    pub f: Option<Spread>,
    /// The first seed's point of the best F.
    pub best: Option<LongTermPoint>,
    /// The first seed's points, by falling threshold.
    pub curve: Vec<LongTermPoint>,
    /// Each sequence by itself, in the order of the data.
    pub sequences: Vec<LongTermSequence>,
    /// Whether it says how sure it is; else every box is an answer, and there is one threshold.
    pub has_confidence: bool,
}

/// A tracker's best F on one sequence, at a threshold of that sequence's own.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LongTermSequence {
    /// The sequence.
    pub sequence: String,
    /// The mean over seeds.
    pub f: f64,
    /// Each seed's.
    #[serde(skip)]
    pub seeds: Vec<(u64, f64)>,
}

/// Frames of one sequence: how sure the tracker was where it gave a box, and the overlap there.
struct Answers {
    sequence: String,
    /// Confidence and overlap of the frames with a box, the surest first.
    answered: Vec<(f64, f64)>,
    present: usize,
    has_confidence: bool,
}

/// The long-term scores of every tracker on the sequences that it has results of. What cannot be read is told by scoring itself.
pub fn long_term(dataset: &Dataset, results: &Results, options: &ScoreOptions) -> Vec<LongTermScores> {
    let is_wanted = |target: &&Target| {
        let asked = options.sequences.as_ref().is_none_or(|names| names.contains(&target.name));
        asked && !target.annotations.first_only
    };
    let targets: Vec<&Target> = dataset.targets.iter().filter(is_wanted).collect();
    let of_seed = |seed: &SeedResults| -> Vec<Answers> {
        targets.iter().filter_map(|target| answers(target, seed)).collect()
    };
    let of_tracker = |tracker: &crate::results::TrackerResults| {
        let seeds: Vec<(u64, Vec<Answers>)> =
            tracker.seeds.iter().map(|seed| (seed.seed, of_seed(seed))).collect();
        scores(&tracker.name, &seeds)
    };
    results.trackers.iter().map(of_tracker).collect()
}

/// Whether some target is absent in some frame, so that long-term scores say more than others.
pub fn has_absence(dataset: &Dataset) -> bool {
    let is_absent = |target: &Target| {
        let said = target.annotations.absent.contains(&true);
        !target.annotations.first_only && (said || target.truth.iter().any(|row| !row.is_proper()))
    };
    dataset.targets.iter().any(is_absent)
}

fn scores(tracker: &str, seeds: &[(u64, Vec<Answers>)]) -> LongTermScores {
    let curves: Vec<Vec<LongTermPoint>> = seeds.iter().map(|(_, sequences)| curve(sequences)).collect();
    let best_of =
        |curve: &Vec<LongTermPoint>| curve.iter().copied().reduce(|a, b| if b.f() > a.f() { b } else { a });
    let best: Vec<f64> = curves.iter().filter_map(best_of).map(|point| point.f()).collect();
    let mut sequences: Vec<LongTermSequence> = Vec::new();
    for (seed, one) in seeds.iter().flat_map(|(seed, all)| all.iter().map(move |one| (*seed, one))) {
        let Some(f) = best_of(&curve(std::slice::from_ref(one))).map(|point| point.f()) else { continue };
        match sequences.iter_mut().find(|known| known.sequence == one.sequence) {
            Some(known) => known.seeds.push((seed, f)),
            None => {
                sequences.push(LongTermSequence { sequence: one.sequence.clone(), f, seeds: vec![(seed, f)] })
            }
        }
    }
    for one in &mut sequences {
        one.f = mean(one.seeds.iter().map(|(_, f)| *f));
    }
    LongTermScores {
        tracker: tracker.to_owned(),
        f: (!best.is_empty())
            .then(|| Spread { mean: mean(best.iter().copied()), deviation: deviation(&best) }),
        best: curves.first().and_then(best_of),
        curve: curves.into_iter().next().unwrap_or_default(),
        sequences,
        has_confidence: seeds.iter().flat_map(|(_, all)| all).any(|one| one.has_confidence),
    }
}

/// `None` without a result, or where the target is never present.
fn answers(target: &Target, seed: &SeedResults) -> Option<Answers> {
    let mut file = seed.read(&target.name, None)?.ok()?;
    let dropped = target.align(&mut file.rows);
    let said = seed.read_confidences(&target.name, None).and_then(Result::ok).or(file.scores);
    let confidences: Option<Vec<f64>> = said.map(|all| all.into_iter().skip(dropped).collect());
    if file.first_is_given
        && let (Some(first), Some(given)) = (file.rows.first_mut(), target.truth.first())
    {
        *first = *given;
    }
    let is_present = |index: usize| {
        let is_absent = target.annotations.absent.get(index).copied().unwrap_or(false);
        target.truth[index].is_proper() && !is_absent
    };
    let present = (0..target.truth.len()).filter(|index| is_present(*index)).count();
    if present == 0 {
        return None;
    }
    let answer = |(index, row): (usize, &Rect)| {
        // The first frame, whose box is given, is as sure as can be where nothing is said of it.
        let unsaid = if index == 0 { f64::INFINITY } else { f64::NEG_INFINITY };
        let confidence = confidences.as_ref().map_or(1.0, |all| {
            all.get(index).copied().filter(|confidence| !confidence.is_nan()).unwrap_or(unsaid)
        });
        let overlap = if is_present(index) { row.overlap(&target.truth[index]) } else { 0.0 };
        row.is_proper().then_some((confidence, overlap))
    };
    let mut answered: Vec<(f64, f64)> =
        file.rows.iter().take(target.truth.len()).enumerate().filter_map(answer).collect();
    answered.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    Some(Answers { sequence: target.name.clone(), answered, present, has_confidence: confidences.is_some() })
}

/// Steps 2 to 4 at every confidence that occurs, by falling threshold.
fn curve(sequences: &[Answers]) -> Vec<LongTermPoint> {
    let mut thresholds: Vec<f64> =
        sequences.iter().flat_map(|one| one.answered.iter().map(|(confidence, _)| *confidence)).collect();
    thresholds.sort_by(|a, b| b.total_cmp(a));
    thresholds.dedup();
    if thresholds.len() > MOST_THRESHOLDS {
        let last = thresholds.len() - 1;
        thresholds =
            (0..MOST_THRESHOLDS).map(|place| thresholds[place * last / (MOST_THRESHOLDS - 1)]).collect();
    }
    // Each sequence's answers so far, and the sum of their overlaps.
    let mut so_far = vec![(0_usize, 0.0_f64); sequences.len()];
    let mut points = Vec::with_capacity(thresholds.len());
    for threshold in thresholds {
        let (mut precision, mut recall) = (0.0, 0.0);
        for (one, (count, sum)) in sequences.iter().zip(&mut so_far) {
            while let Some((_, overlap)) =
                one.answered.get(*count).filter(|(confidence, _)| *confidence >= threshold)
            {
                *sum += overlap;
                *count += 1;
            }
            precision += if *count == 0 { 1.0 } else { *sum / *count as f64 };
            recall += *sum / one.present as f64;
        }
        let share = sequences.len() as f64;
        points.push(LongTermPoint { threshold, precision: precision / share, recall: recall / share });
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(answered: &[(f64, f64)], present: usize) -> Answers {
        Answers { sequence: "s".into(), answered: answered.to_vec(), present, has_confidence: true }
    }

    #[test]
    fn precision_recall_and_f_are_the_definitions() {
        // Five frames, in four of which the target is there: right, half right, wrong while absent, right but unsure, no box.
        let points = curve(&[of(&[(0.9, 1.0), (0.8, 0.5), (0.6, 0.0), (0.2, 1.0)], 4)]);
        let expected = [(0.9, 1.0, 0.25), (0.8, 0.75, 0.375), (0.6, 0.5, 0.375), (0.2, 0.625, 0.625)];
        for (point, (threshold, precision, recall)) in points.iter().zip(expected) {
            assert_eq!((point.threshold, point.precision, point.recall), (threshold, precision, recall));
        }
        assert_eq!(points.len(), 4);
        assert_eq!(points[3].f(), 0.625);
        assert_eq!(LongTermPoint { threshold: 0.0, precision: 0.0, recall: 0.0 }.f(), 0.0);
    }

    #[test]
    fn sequences_are_averaged_before_f_and_silence_is_precise() {
        let points = curve(&[of(&[(0.9, 1.0)], 1), of(&[(0.5, 0.5)], 2)]);
        assert_eq!((points[0].precision, points[0].recall), (1.0, 0.5), "the second has not answered yet");
        assert_eq!((points[1].precision, points[1].recall), (0.75, 0.625));
        let scores = scores("T", &[(1, vec![of(&[(0.9, 1.0)], 1)]), (2, vec![of(&[(0.9, 0.5)], 1)])]);
        let f = scores.f.unwrap();
        assert_eq!((f.mean, f.deviation.map(|d| (d * d * 8.0).round())), (0.75, Some(1.0)));
        let seeds = vec![(1, 1.0), (2, 0.5)];
        assert_eq!(scores.sequences, [LongTermSequence { sequence: "s".into(), f: 0.75, seeds }]);
    }

    #[test]
    fn many_confidences_are_thinned_out_and_keep_both_ends() {
        let many: Vec<(f64, f64)> = (0..5000).map(|i| (1.0 - f64::from(i) / 5000.0, 0.5)).collect();
        let points = curve(&[of(&many, 5000)]);
        assert_eq!((points.len(), points[0].threshold, points[999].recall), (1000, 1.0, 0.5));
    }
}
