//! Real MOTChallenge sequences: scores of trusted implementations, and the reference's tracks.

use std::{collections::HashMap, fs, path::Path};

use multi_object::{
    motchallenge::{TrackRow, read_ground_truth, read_tracks},
    scoring::{Counts, Rules, Scores},
};

mod common;

const SEQUENCES: [&str; 2] = ["TUD-Stadtmitte", "PETS09-S2L1"];

/// The cells of a table, row by row, without its heading.
fn cells(table: &str, columns: usize) -> Vec<Vec<String>> {
    let row = |line: &str| line.split_whitespace().take(columns).map(str::to_owned).collect();
    table.lines().skip(1).map(row).collect()
}

fn score(mot: &Path, result_of: impl Fn(&str) -> String) -> String {
    let mut words = vec!["score".to_owned()];
    for name in SEQUENCES {
        words.push(mot.join(name).join("gt/gt.txt").display().to_string());
        words.push(result_of(name));
    }
    let (code, table, complaints) = common::mot(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(code, 0, "{complaints}");
    table
}

#[test]
fn every_column_is_that_of_py_motmetrics() {
    let Some(mot) = common::data("mot") else { return };
    for (result, expected) in [("cem", "expected_cem_metrics.txt"), ("sort", "expected_sort_scores.txt")] {
        let expected = cells(&fs::read_to_string(mot.join(expected)).unwrap(), 19);
        let table = score(&mot, |name| mot.join(name).join(result).join("result.txt").display().to_string());
        let ours = cells(&table, 19);
        assert_eq!(ours[..2], expected[..], "{table}");
        assert_eq!(ours[2][0], "OVERALL");
    }
}

/// What TrackEval 1.3.0 printed: HOTA, DetA, AssA, MOTA, MOTP; IDSW, Frag, MT, PT, ML.
const TRACKEVAL: [(&str, [f64; 5], [usize; 5]); 4] = [
    ("PETS09-S2L1/cem", [0.516297, 0.622294, 0.432854, 0.828865, 0.730735], [31, 39, 18, 1, 0]),
    ("TUD-Stadtmitte/cem", [0.397849, 0.392268, 0.408841, 0.564014, 0.654096], [7, 6, 5, 4, 1]),
    ("PETS09-S2L1/sort", [0.305809, 0.488565, 0.196657, 0.618633, 0.677384], [103, 190, 8, 11, 0]),
    ("TUD-Stadtmitte/sort", [0.530335, 0.549044, 0.512758, 0.717128, 0.752350], [10, 16, 6, 4, 0]),
];
/// The same over both sequences of `cem` and of `sort`: HOTA, DetA, AssA, MOTA, IDF1.
const TRACKEVAL_COMBINED: [(&str, [f64; 5]); 2] = [
    ("cem", [0.496154, 0.575798, 0.433063, 0.774503, 0.662369]),
    ("sort", [0.360261, 0.498866, 0.267119, 0.638849, 0.426571]),
];

fn counts(mot: &Path, name: &str, result: &str) -> Counts {
    let truth = read_ground_truth(&mot.join(name).join("gt/gt.txt")).unwrap();
    let result = read_tracks(&mot.join(name).join(result).join("result.txt"), None).unwrap();
    Counts::of(&truth, &result, Rules::Trackeval)
}

fn assert_close(what: &str, ours: &[Option<f64>], theirs: &[f64]) {
    for (ours, theirs) in ours.iter().zip(theirs) {
        assert!((ours.unwrap() - theirs).abs() < 1e-6, "{what}: {ours:?} against {theirs}");
    }
}

#[test]
fn hota_and_clear_are_those_of_trackeval() {
    let Some(mot) = common::data("mot") else { return };
    for (which, shares, whole) in TRACKEVAL {
        let (name, result) = which.split_once('/').unwrap();
        let one: Scores = counts(&mot, name, result).scores();
        assert_close(which, &[one.hota, one.deta, one.assa, one.mota, one.motp_overlap], &shares);
        let ours = [one.switches, one.fragments, one.mostly_tracked, one.partially_tracked, one.mostly_lost];
        assert_eq!(ours, whole, "{which}");
    }
    for (result, shares) in TRACKEVAL_COMBINED {
        let all = SEQUENCES.map(|name| counts(&mot, name, result));
        let all = Counts::total(&all).unwrap().scores();
        assert_close(result, &[all.hota, all.deta, all.assa, all.mota, all.idf1], &shares);
    }
}

/// Rows of a frame, for looking up.
fn by_frame(rows: &[TrackRow]) -> HashMap<u32, Vec<&TrackRow>> {
    rows.iter().fold(HashMap::new(), |mut frames, row| {
        frames.entry(row.frame).or_insert_with(Vec::new).push(row);
        frames
    })
}

#[test]
fn sort_gives_the_tracks_and_scores_of_the_reference() {
    let Some(mot) = common::data("mot") else { return };
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(format!("{name}.txt")).display().to_string();
    for name in SEQUENCES {
        let detections = mot.join(name).join("det/det.txt").display().to_string();
        let (code, _, complaints) = common::mot(&["sort", &detections, "--out", &out(name)]);
        assert_eq!(code, 0, "{complaints}");
        let ours = read_tracks(Path::new(&out(name)), None).unwrap();
        let theirs = read_tracks(&mot.join(name).join("sort/result.txt"), None).unwrap();
        assert_eq!(ours.len(), theirs.len(), "{name}");
        let theirs_by_frame = by_frame(&theirs);
        // Each of our identities is one of theirs, always the same, and no two of ours are the same of theirs.
        let (mut name_of, mut ours_of) = (HashMap::new(), HashMap::new());
        for row in &ours {
            let near = |other: &&&TrackRow| {
                let (a, b) = (row.box_in_file, other.box_in_file);
                [a.x - b.x, a.y - b.y, a.w - b.w, a.h - b.h].iter().all(|gap| gap.abs() <= 0.05)
            };
            let same: Vec<_> = theirs_by_frame[&row.frame].iter().filter(near).collect();
            assert_eq!(same.len(), 1, "{name}: {row:?}");
            assert_eq!(
                *name_of.entry(row.identity).or_insert(same[0].identity),
                same[0].identity,
                "{name}: {row:?}"
            );
            assert_eq!(
                *ours_of.entry(same[0].identity).or_insert(row.identity),
                row.identity,
                "{name}: {row:?}"
            );
        }
    }
    let expected = cells(&fs::read_to_string(mot.join("expected_sort_scores.txt")).unwrap(), 19);
    assert_eq!(cells(&score(&mot, out), 19)[..2], expected[..]);
}
