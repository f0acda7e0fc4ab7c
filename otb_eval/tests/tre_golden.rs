//! A published tracker's TRE: its runs start where the archive says, and score as the Python benchmark scores them.

#[path = "../../tests/common/mod.rs"]
mod common;

use std::{fs, path::PathBuf};

use otb_eval::{
    convert::{Layout, read, write},
    dataset::Dataset,
    protocol::{HiddenFrames, Protocol},
    results::Results,
    scoring::{ScoreOptions, ScoreProblem, Table, score},
    toolkits::Toolkit,
};
use tempfile::TempDir;

/// AUC and precision at 20 pixels of IVT's runs by an independent script that follows the benchmark's code.
const EXPECTED: [(&str, f64, f64); 10] = [
    ("Basketball", 0.260176, 0.619713),
    ("ClifBar", 0.320046, 0.502022),
    ("Couple", 0.130417, 0.180625),
    ("Crossing", 0.490374, 0.951429),
    ("David3", 0.436708, 0.638992),
    ("Jogging-1", 0.491661, 0.624089),
    ("Subway", 0.257368, 0.381579),
    ("Tiger1", 0.164735, 0.125301),
    ("Walking2", 0.775323, 1.0),
    ("Woman", 0.210357, 0.310028),
];

/// The truth, the archive as the benchmark has it on disk, and the number of the first frame of each run.
fn archive() -> Option<(Dataset, TempDir)> {
    let data = common::data_dir()?;
    let (dataset, problems) = Dataset::open(&[data.join("otb_meta/OTB100.json")]).unwrap();
    assert!(problems.is_empty());
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("TRE/IVT");
    fs::create_dir_all(&folder).unwrap();
    let mut files = 0;
    for entry in fs::read_dir(data.join("otb_results_tre/IVT")).ok()? {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
        files += 1;
    }
    (files == EXPECTED.len()).then_some((dataset, root))
}

fn converted(root: &TempDir) -> PathBuf {
    let (tracks, problems) = read(Layout::Jwlim, root.path()).unwrap();
    assert!(problems.is_empty() && tracks.len() == 200, "{problems:?}");
    let out = root.path().join("run");
    write(Layout::Run, &out, &tracks).unwrap();
    out
}

fn scored(dataset: &Dataset, results: &Results, toolkit: Toolkit) -> (Table, Vec<ScoreProblem>) {
    let options = ScoreOptions {
        rules: toolkit.rules(),
        protocol: Protocol::Tre,
        sequences: None,
        attributes: None,
        undo_scale: false,
        accept_lengths: true,
    };
    score(dataset, results, &options)
}

#[test]
fn runs_of_a_published_tracker_are_scored_from_where_they_start() {
    let Some((dataset, root)) = archive() else { return };
    let results = Results::open(&converted(&root), Protocol::Tre).unwrap();
    let (table, problems) = scored(&dataset, &results, Toolkit::Jwlim);
    assert!(problems.is_empty(), "{problems:?}");
    let rows = &table.trackers[0].sequences;
    assert_eq!(rows.len(), EXPECTED.len());
    for (row, (sequence, auc, precision)) in rows.iter().zip(EXPECTED) {
        let scores = row.scores.unwrap();
        assert_eq!(row.sequence, sequence);
        assert!((scores.auc.mean - auc).abs() < 6e-7, "{sequence}: AUC {}", scores.auc.mean);
        let found = scores.precision_20.mean;
        assert!((found - precision).abs() < 6e-7, "{sequence}: precision {found}");
    }
    let overall = table.trackers[0].overall.unwrap();
    assert!(
        (overall.auc.mean - 0.353717).abs() < 6e-7 && (overall.precision_20.mean - 0.533378).abs() < 6e-7
    );
}

#[test]
fn without_its_start_a_run_of_other_rows_is_refused_and_no_start_is_guessed() {
    let Some((dataset, root)) = archive() else { return };
    let out = converted(&root);
    for entry in fs::read_dir(out.join("tre/IVT/seed_0")).unwrap() {
        let path = entry.unwrap().path();
        if path.to_string_lossy().ends_with(".result.json") {
            fs::remove_file(path).unwrap();
        }
    }
    let results = Results::open(&out, Protocol::Tre).unwrap();
    let (table, problems) = scored(&dataset, &results, Toolkit::Plain);
    assert!(problems.iter().all(|problem| problem.to_string().contains("nothing tells where it starts")));
    let left_out = table.trackers[0].sequences.iter().filter(|row| row.scores.is_none());
    let left_out: Vec<&str> = left_out.map(|row| row.sequence.as_str()).collect();
    assert!(left_out.contains(&"ClifBar"), "{left_out:?}");
    for (row, (_, auc, _)) in table.trackers[0].sequences.iter().zip(EXPECTED) {
        // Plain rules differ in the first row only, which is not overwritten.
        let found = row.scores.map(|scores| scores.auc.mean);
        assert!(found.is_none_or(|found| (found - auc).abs() < 0.002), "{}: {found:?}", row.sequence);
    }
}

#[test]
fn with_the_lists_of_hidden_frames_the_rule_gives_the_published_starts() {
    let Some((mut dataset, root)) = archive() else { return };
    let (tracks, _) = read(Layout::Jwlim, root.path()).unwrap();
    let mut same_starts = || -> Vec<&str> {
        let is_same = |(sequence, _, _): &(&str, f64, f64)| {
            let published =
                tracks.iter().filter(|track| track.sequence == *sequence).map(|track| track.start);
            let ruled = dataset.target(sequence).unwrap().starts(Protocol::Tre).unwrap();
            published.eq(ruled.into_iter().map(|(_, start)| Some(start)))
        };
        let same = EXPECTED.iter().filter(|one| is_same(one)).map(|(sequence, _, _)| *sequence).collect();
        dataset.hide(&HiddenFrames::none());
        same
    };
    let with_lists = same_starts();
    let without = same_starts();
    eprintln!("{with_lists:?} {without:?}");
    assert_eq!(without, ["Couple", "Crossing"]);
    assert_eq!(with_lists.len(), 9, "all but ClifBar, which was run on 329 of its 472 frames");
}
