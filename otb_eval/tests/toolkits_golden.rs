//! Numbers that the toolkits themselves gave, or that were published, on real files.

#[path = "../../tests/common/mod.rs"]
mod common;

use std::path::{Path, PathBuf};

use infopart::geometry::Rect;
use otb_eval::{
    catalogue::SequenceList,
    dataset::Dataset,
    protocol::Protocol,
    results::Results,
    scoring::{ScoreOptions, Table, score},
    toolkits::{Curves, Rules, Toolkit, evaluate},
};

/// The truth of all 100 targets, and the folder of published results.
fn published() -> Option<(Dataset, PathBuf)> {
    let data = common::data_dir()?;
    let (dataset, problems) = Dataset::open(&[data.join("otb_meta/OTB100.json")]).unwrap();
    assert!(problems.is_empty() && dataset.targets.len() == 100);
    Some((dataset, data.join("otb_results")))
}

fn truth<'a>(dataset: &'a Dataset, sequence: &str) -> &'a [Rect] {
    &dataset.target(sequence).unwrap().truth
}

fn struck(results: &Path, sequence: &str) -> Vec<Rect> {
    let results = Results::open(&results.join("STRUCK"), Protocol::Ope).unwrap();
    results.trackers[0].seeds[0].read(sequence, None).unwrap().unwrap().rows
}

fn curves(rules: &Rules, truth: &[Rect], result: &[Rect]) -> Curves {
    evaluate(rules, truth, result).unwrap().curves(rules)
}

#[track_caller]
fn close(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() < 6e-7, "{what}: {found:.6} instead of {expected:.6}");
}

/// The six toolkits and pytracking without invalid frames, in the order of the tables below.
fn six_and_excluding() -> Vec<(String, Rules)> {
    let mut rules: Vec<(String, Rules)> =
        Toolkit::SIX.iter().map(|toolkit| (toolkit.to_string(), toolkit.rules())).collect();
    let excluding = Toolkit::Pytracking.rules().with_invalid_frames_excluded();
    rules.push(("pytracking, invalid frames excluded".into(), excluding));
    rules
}

#[track_caller]
fn expect(truth: &[Rect], result: &[Rect], expected: [(f64, f64); 7], what: &str) {
    for ((name, rules), (auc, precision)) in six_and_excluding().iter().zip(expected) {
        let curves = curves(rules, truth, result);
        close(curves.auc(), auc, &format!("{what}: AUC of {name}"));
        close(curves.precision_at_20(), precision, &format!("{what}: precision of {name}"));
    }
}

#[test]
fn on_clean_frames_all_six_agree() {
    let Some((dataset, results)) = published() else { return };
    let truth = truth(&dataset, "Couple");
    expect(truth, &struck(&results, "Couple"), [(0.532313, 0.735714); 7], "Couple");
    expect(truth, truth, [(0.952381, 1.0); 7], "a perfect tracker");
}

#[test]
fn a_first_row_that_is_not_the_truths_counts_in_two() {
    let Some((dataset, results)) = published() else { return };
    let (football, crossing) = (struck(&results, "Football1"), struck(&results, "Crossing"));
    for toolkit in Toolkit::SIX {
        let as_given = matches!(toolkit, Toolkit::Pysot | Toolkit::Stvir);
        let found = curves(&toolkit.rules(), truth(&dataset, "Football1"), &football);
        close(found.auc(), if as_given { 0.660232 } else { 0.660875 }, toolkit.name());
        let found = curves(&toolkit.rules(), truth(&dataset, "Crossing"), &crossing);
        let mean_precision = found.precision.iter().sum::<f64>() / 51.0;
        close(mean_precision, if as_given { 0.934967 } else { 0.935131 }, toolkit.name());
    }
}

#[test]
fn frames_without_truth_are_misses_and_hits() {
    let Some((dataset, results)) = published() else { return };
    let mut truth = truth(&dataset, "Couple").to_vec();
    let result = struck(&results, "Couple");
    truth[60..80].fill(Rect::new(0.0, 0.0, 0.0, 0.0));
    let (hit, miss) = ((0.453061, 0.735714), (0.453061, 0.592857));
    expect(&truth, &result, [hit, hit, hit, hit, miss, miss, (0.528571, 0.691667)], "20 rows of zeros");
    truth[60..80].fill(Rect::new(f64::NAN, f64::NAN, f64::NAN, f64::NAN));
    for (toolkit, (auc, precision)) in Toolkit::SIX.iter().zip([hit, hit, hit, hit, miss]) {
        let curves = curves(&toolkit.rules(), &truth, &result);
        close(curves.auc(), auc, toolkit.name());
        close(curves.precision_at_20(), precision, toolkit.name());
    }
    assert!(evaluate(&Toolkit::Pytracking.rules(), &truth, &result).is_err());
}

#[test]
fn a_box_at_the_left_edge_is_invalid_to_some() {
    let Some((dataset, _)) = published() else { return };
    let mut truth = truth(&dataset, "Couple").to_vec();
    truth[60..80].iter_mut().for_each(|row| row.x = 0.0);
    let (some, all, pytracking) = ((0.816327, 1.0), (0.952381, 1.0), (0.816326, 0.857143));
    expect(&truth, &truth, [some, some, some, all, all, pytracking, all], "x = 0");
}

#[test]
fn boxes_of_zeros_are_carried_by_two() {
    let Some((dataset, results)) = published() else { return };
    let mut result = struck(&results, "Couple");
    result[50..60].fill(Rect::new(0.0, 0.0, 0.0, 0.0));
    let expected = [0.515646, 0.484014, 0.484014, 0.484014, 0.484014, 0.515646];
    for (toolkit, auc) in Toolkit::SIX.iter().zip(expected) {
        close(curves(&toolkit.rules(), truth(&dataset, "Couple"), &result).auc(), auc, toolkit.name());
    }
}

fn table(dataset: &Dataset, results: &Path, rules: Rules) -> Table {
    let results = Results::open(results, Protocol::Ope).unwrap();
    let options = ScoreOptions {
        rules,
        protocol: Protocol::Ope,
        sequences: None,
        attributes: None,
        undo_scale: false,
        // Three of the published files have other lengths than the truth; the rules say what becomes of them.
        accept_lengths: true,
    };
    let (table, problems) = score(dataset, &results, &options);
    assert_eq!((table.trackers.len(), table.sequences.len(), problems.len()), (11, 100, 0));
    table
}

#[test]
fn eleven_published_trackers_score_as_known() {
    let Some((dataset, results)) = published() else { return };
    let known = [
        ("KCF", 0.477, 0.695),
        ("DSST", 0.513, 0.679),
        ("Staple", 0.581, 0.783),
        ("SRDCF", 0.598, 0.789),
        ("MDNet", 0.678, 0.909),
        ("STRUCK", 0.462, 0.640),
        ("SiamFC", 0.587, 0.772),
        ("SiamRPN++", 0.696, 0.905),
        ("CSRDCF", 0.592, 0.775),
        ("ATOM", 0.667, 0.879),
        ("TLD", 0.357, 0.501),
    ];
    let plain = table(&dataset, &results, Toolkit::Plain.rules());
    let misses = table(&dataset, &results, Toolkit::Plain.rules().with_missing_rows_as_misses());
    let carried = table(&dataset, &results, Toolkit::Plain.rules().with_lost_boxes_carried());
    let other_rules = [(&misses, "STRUCK", 0.461, 0.638), (&carried, "TLD", 0.406, 0.545)];
    let plainly = known.iter().map(|&(name, auc, precision)| (&plain, name, auc, precision));
    for (table, name, auc, precision) in plainly.chain(other_rules) {
        let scores = table.trackers.iter().find(|one| one.tracker == name).unwrap().overall.unwrap();
        let (found, at_20) = (scores.auc.mean, scores.precision_20.mean);
        assert!((found - auc).abs() <= 0.001, "{name}: AUC {found:.4} instead of {auc}");
        assert!((at_20 - precision).abs() <= 0.001, "{name}: precision {at_20:.4} instead of {precision}");
    }
}

#[test]
fn struck_overlaps_as_in_the_benchmarks_own_archive_but_for_six() {
    let Some((dataset, results)) = published() else { return };
    let path = common::data_dir().unwrap().join("otb_meta/official_scores/STRUCK/scores_tb100/ALL.json");
    let archived: serde_json::Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let names = archived["seqs"].as_array().unwrap();
    let overlaps = archived["overlapScores"].as_array().unwrap();
    let rules = Toolkit::Jwlim.rules();
    let mut differing: Vec<(&str, f64)> = Vec::new();
    for (name, overlap) in names.iter().zip(overlaps) {
        let name = otb_eval::catalogue::find(name.as_str().unwrap()).unwrap().name;
        let mean = curves(&rules, truth(&dataset, name), &struck(&results, name)).mean_overlap;
        let difference = mean - overlap.as_f64().unwrap();
        if difference.abs() > 0.001 {
            differing.push((name, difference));
        }
    }
    assert_eq!(names.len(), SequenceList::Tb100.sequences().len());
    // The archive leaves rows of ground truth that are not positive out of its mean (Biker, Board, Crowds, Twinnings),
    // has a result of all rows (ClifBar), and another number of frames (Tiger1).
    let mut found: Vec<&str> = differing.iter().map(|(name, _)| *name).collect();
    found.sort_unstable();
    assert_eq!(found, ["Biker", "Board", "ClifBar", "Crowds", "Tiger1", "Twinnings"], "{differing:?}");
}
