//! Bad input: named, with the remedy and exit code 2, and nothing written.

use std::{fs, path::Path};

mod common;

/// A file in `folder`, by its path.
fn file(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn assert_refused(words: &[&str], parts: &[&str]) {
    let (code, output, complaints) = common::mot(words);
    assert_eq!((code, output.as_str()), (2, ""), "{words:?}: {complaints}");
    for part in parts {
        assert!(complaints.contains(part), "{words:?}: {part:?} is not in {complaints}");
    }
}

#[test]
fn detections_that_cannot_be_used_are_named_by_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let good = "1,-1,10,10,5,9,0.9\n";
    for (rows, parts) in [
        ("2,-1,10,10,5\n", ["line 2", "5 fields where 6 are needed"]),
        ("2,-1,ten,10,5,9,0.9\n", ["line 2", "x is \"ten\""]),
        ("2,-1,10,10,-5,9,0.9\n", ["line 2", "width and height must be above 0"]),
        ("2,-1,10,10,inf,9,0.9\n", ["line 2", "the width is \"inf\""]),
        ("0,-1,10,10,5,9,0.9\n", ["line 2", "counts frames from 1"]),
        ("2,-1,10,10,1e30,9,0.9\n", ["line 2", "fits no picture"]),
        ("2,-1,10,10,1e308,1e308,0.9\n", ["line 2", "1e308 x 1e308 at 10.0, 10.0 fits no picture"]),
        ("2,-1,1e30,10,5,9,0.9\n", ["line 2", "fits no picture"]),
        ("3,-1,10,10,5,9,0.9\n2,-1,10,10,5,9,0.9\n", ["line 3", "frame 2 comes after frame 3"]),
    ] {
        let path = file(folder.path(), "det.txt", &format!("{good}{rows}"));
        let out = folder.path().join("out.txt").display().to_string();
        assert_refused(&["sort", &path, "--out", &out], &[&[path.as_str()], &parts[..]].concat());
        assert!(!Path::new(&out).exists());
    }
    let empty = file(folder.path(), "empty.txt", "\n\n");
    assert_refused(&["sort", &empty], &["empty.txt: no detection in it", "give rows"]);
    assert_refused(&["sort", "no/such/det.txt"], &["no/such/det.txt", "check the path"]);
}

#[test]
fn tracks_that_cannot_be_scored_are_named_by_file_and_line() {
    let folder = tempfile::tempdir().unwrap();
    let truth = file(folder.path(), "gt.txt", "1,1,10,10,5,9,1\n2,1,10,10,5,9,1\n");
    for (rows, parts) in [
        ("1,3,1,1,5,9,1\n1,3,8,8,5,9,1\n", ["line 2", "identity 3 is already in frame 1, at line 1"]),
        ("1,-1,1,1,5,9,1\n", ["line 1", "a file of tracks needs one in every row"]),
        ("1,3,1,1,5,0,1\n", ["line 1", "has no area"]),
    ] {
        let result = file(folder.path(), "result.txt", rows);
        assert_refused(&["score", &truth, &result], &[&["result.txt"], &parts[..]].concat());
    }
    let result = file(folder.path(), "result.txt", "1,3,1,1,5,9,1\n");
    let uncounted = file(folder.path(), "uncounted.txt", "1,1,10,10,5,9,0\n");
    assert_refused(&["score", &uncounted, &result], &["uncounted.txt: no row with confidence 1"]);
    let short = file(folder.path(), "short.txt", "1,1,10,10,5,9\n");
    assert_refused(&["score", &short, &result], &["short.txt, line 1: 6 fields where 7 are needed"]);
    assert_refused(&["score", &truth, &result, &truth], &["gt.txt: ground truth without a result"]);
}

#[test]
fn an_empty_result_is_scored_as_nothing_found_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let truth = file(folder.path(), "gt.txt", "1,1,10,10,5,9,1\n");
    let result = file(folder.path(), "result.txt", "");
    let (code, table, complaints) = common::mot(&["score", &truth, &result]);
    assert_eq!(code, 0);
    assert!(
        complaints.contains("warning") && complaints.contains("result.txt: no row in it"),
        "{complaints}"
    );
    assert!(table.contains(" 0.0%"), "{table}");
}

#[test]
fn a_result_is_read_from_standard_input_once() {
    let folder = tempfile::tempdir().unwrap();
    let truth = file(folder.path(), "gt.txt", "1,1,10,10,5,9,-1\n");
    let mut program = assert_cmd::Command::cargo_bin("mot").unwrap();
    let done = program.args(["score", &truth, "-"]).write_stdin("1,4,10,10,5,9,1\n").output().unwrap();
    let table = String::from_utf8(done.stdout).unwrap();
    assert!(done.status.success() && table.contains("100.0%"), "{table}");
    assert_refused(&["score", &truth, "-", &truth, "-"], &["- twice"]);
}

#[test]
fn flags_out_of_range_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let detections = file(folder.path(), "det.txt", "1,-1,10,10,5,9,0.9\n");
    assert_refused(&["sort", &detections, "--iou", "1.5"], &["--iou 1.5", "from 0 to 1"]);
    assert_refused(&["sort", &detections, "--particles", "0"], &["--particles 0"]);
    assert_refused(&["sort", &detections, "--frames", "no/such/folder"], &["--frames", "no/such/folder"]);
}

#[test]
fn folders_of_sequences_are_scored_by_name_and_a_missing_result_is_told() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["A", "B"] {
        fs::create_dir_all(folder.path().join("train").join(name).join("gt")).unwrap();
        file(folder.path(), &format!("train/{name}/gt/gt.txt"), "1,1,10,10,5,9,1\n");
    }
    fs::create_dir(folder.path().join("results")).unwrap();
    file(folder.path(), "results/A.txt", "1,1,10,10,5,9,1\n");
    let path = |name: &str| folder.path().join(name).display().to_string();
    // B is missing: A is scored all the same.
    let names_in = |table: &str| -> Vec<String> {
        let first = |line: &str| line.split_whitespace().next().map(str::to_owned);
        table.lines().skip(1).filter_map(first).collect()
    };
    let damaged = [None, Some("1,1,90,90,5\n"), Some("1,1,90,90,-5,9,1\n"), Some("\u{0}\u{1}")];
    for rows in damaged {
        if let Some(rows) = rows {
            file(folder.path(), "results/B.txt", rows);
        }
        let (code, table, complaints) = common::mot(&["score", &path("train"), &path("results")]);
        assert_eq!((code, names_in(&table)), (2, vec!["A".to_owned()]), "{complaints}");
        assert!(complaints.contains("B.txt") && complaints.contains("1 of 2 sequences"), "{complaints}");
    }
    // A map may name what is not there, and leave out what is damaged.
    for (map, code, names) in [("name\nA\n", 0, vec!["A"]), ("name\nA\nC\n", 2, vec!["A"])] {
        let map = file(folder.path(), "map.txt", map);
        let words = ["score", &path("train"), &path("results"), "--sequence-map", &map];
        let (given, table, complaints) = common::mot(&words);
        assert_eq!((given, names_in(&table)), (code, names.iter().map(|&name| name.to_owned()).collect()));
        assert_eq!(complaints.contains("C/gt/gt.txt"), code == 2, "{complaints}");
    }
    file(folder.path(), "results/B.txt", "1,1,90,90,5,9,1\n");
    // No row of A may be beyond its two frames; of B nothing is known.
    file(folder.path(), "train/A/seqinfo.ini", "[Sequence]\nname=A\nseqLength=2\n");
    file(folder.path(), "results/A.txt", "1,1,10,10,5,9,1\n3,1,10,10,5,9,1\n");
    let (code, table, complaints) = common::mot(&["score", &path("train"), &path("results")]);
    assert_eq!((code, names_in(&table)), (2, vec!["B".to_owned()]));
    assert!(complaints.contains("A.txt, line 2: frame 3 is beyond the 2 frames"), "{complaints}");
    // One false positive in two frames.
    file(folder.path(), "results/A.txt", "1,1,90,90,5,9,1\n");
    let (_, table, _) = common::mot(&["score", &path("train"), &path("results"), "--rules", "trackeval"]);
    let rate = |line: &str| line.split_whitespace().rev().nth(3).map(str::to_owned);
    let rates: Vec<_> = table.lines().skip(1).filter_map(rate).collect();
    assert_eq!(rates, ["0.500", "1.000", "0.667"], "{table}");
    file(folder.path(), "results/A.txt", "1,1,10,10,5,9,1\n");
    let json = path("scores.json");
    let (code, table, complaints) =
        common::mot(&["score", &path("train"), &path("results"), "--json", &json]);
    assert_eq!(code, 0, "{complaints}");
    assert_eq!(names_in(&table), ["A", "B", "OVERALL"]);
    let scores: serde_json::Value = serde_json::from_str(&fs::read_to_string(json).unwrap()).unwrap();
    assert_eq!(scores["sequences"][2]["scores"]["mota"], 0.0);
    assert_eq!(scores["sequences"][0]["scores"]["mota"], 1.0);
}
