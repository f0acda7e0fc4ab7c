//! Scores from counts.

use serde::Serialize;

use super::{Counts, Rules, hota::AtThreshold};

/// Every score. Shares are in [0, 1] (MOTA may be below 0), and `None` where nothing was there to divide by.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Scores {
    /// IDF1 = 2 IDTP / (true boxes + boxes of the result).
    pub idf1: Option<f64>,
    /// IDP = IDTP / boxes of the result.
    pub idp: Option<f64>,
    /// IDR = IDTP / true boxes.
    pub idr: Option<f64>,
    /// Matches / true boxes.
    pub recall: Option<f64>,
    /// Matches / boxes of the result.
    pub precision: Option<f64>,
    /// True objects.
    pub objects: usize,
    /// Objects matched in 80 % of their own frames (MT).
    pub mostly_tracked: usize,
    /// Objects matched in 20 % to 80 % of their own frames (PT).
    pub partially_tracked: usize,
    /// Objects matched in less than 20 % of their own frames (ML).
    pub mostly_lost: usize,
    /// Boxes of the result without an object (FP).
    pub false_positives: usize,
    /// True boxes without a track (FN).
    pub misses: usize,
    /// Changes of an object's track (IDSW).
    pub switches: usize,
    /// Interruptions of an object's tracking (FM).
    pub fragments: usize,
    /// MOTA = 1 - (FN + FP + IDSW) / true boxes.
    pub mota: Option<f64>,
    /// MOTP as a distance: the mean of 1 - overlap over the matches.
    pub motp_distance: Option<f64>,
    /// MOTP as an overlap: the mean overlap over the matches.
    pub motp_overlap: Option<f64>,
    /// Tracks given to another object than before (IDt); only py-motmetrics counts it.
    pub transfers: Option<usize>,
    /// Switches to a track that was never matched before (IDa); only py-motmetrics counts it.
    pub ascents: Option<usize>,
    /// Transfers to an object that was never matched before (IDm); only py-motmetrics counts it.
    pub migrations: Option<usize>,
    /// False positives a frame (FAR).
    pub false_positives_per_frame: Option<f64>,
    /// HOTA, the mean over 19 thresholds.
    pub hota: Option<f64>,
    /// Detection accuracy, the mean over 19 thresholds.
    pub deta: Option<f64>,
    /// Association accuracy, the mean over 19 thresholds.
    pub assa: Option<f64>,
    /// Frames: under py-motmetrics's rules those that have a box, under TrackEval's the sequence's
    /// length, or the number of the last that has one.
    pub frames: usize,
    /// Boxes of the ground truth.
    pub truth_boxes: usize,
    /// Boxes of the result.
    pub result_boxes: usize,
}

pub(super) fn of(counts: &Counts) -> Scores {
    let errors = counts.misses + counts.false_positives + counts.switches;
    let boxes = counts.truth_boxes + counts.result_boxes;
    let motp_distance = share(counts.distance_sum, counts.matches);
    let only_motmetrics = |count| (counts.rules == Rules::Motmetrics).then_some(count);
    let identity = counts.identity_true_positives as f64;
    Scores {
        idf1: share(2.0 * identity, boxes),
        idp: share(identity, counts.result_boxes),
        idr: share(identity, counts.truth_boxes),
        recall: share(counts.matches as f64, counts.truth_boxes),
        precision: share(counts.matches as f64, counts.result_boxes),
        objects: counts.objects,
        mostly_tracked: counts.mostly_tracked,
        partially_tracked: counts.partially_tracked,
        mostly_lost: counts.mostly_lost,
        false_positives: counts.false_positives,
        misses: counts.misses,
        switches: counts.switches,
        fragments: counts.fragments,
        mota: share(errors as f64, counts.truth_boxes).map(|share| 1.0 - share),
        motp_distance,
        motp_overlap: motp_distance.map(|distance| 1.0 - distance),
        transfers: only_motmetrics(counts.transfers),
        ascents: only_motmetrics(counts.ascents),
        migrations: only_motmetrics(counts.migrations),
        false_positives_per_frame: share(counts.false_positives as f64, counts.frames),
        hota: over_thresholds(counts, |at| (detection(at) * association(at)).sqrt()),
        deta: over_thresholds(counts, detection),
        assa: over_thresholds(counts, association),
        frames: counts.frames,
        truth_boxes: counts.truth_boxes,
        result_boxes: counts.result_boxes,
    }
}

fn share(part: f64, of: usize) -> Option<f64> {
    (of > 0).then(|| part / of as f64)
}

fn over_thresholds(counts: &Counts, score: impl Fn(&AtThreshold) -> f64) -> Option<f64> {
    let sum: f64 = counts.hota.iter().map(score).sum();
    (counts.truth_boxes + counts.result_boxes > 0).then(|| sum / counts.hota.len() as f64)
}

fn detection(at: &AtThreshold) -> f64 {
    at.true_positives as f64 / (at.true_positives + at.misses + at.false_positives).max(1) as f64
}

fn association(at: &AtThreshold) -> f64 {
    at.association_sum / at.true_positives.max(1) as f64
}
