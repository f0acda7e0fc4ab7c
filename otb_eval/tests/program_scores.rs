//! `otb_eval` score, compare, plot, report, convert and check on bad input: it is named, and everything else is done.

mod bench_scene;

use std::{fs, process::Command};

use bench_scene::Scene;

const COMMANDS: [&str; 4] = [
    "score --data boxes.json --results results",
    "compare good other --data boxes.json --results results",
    "plot --data boxes.json --results results --out plots",
    "report --data boxes.json --results results --no-frames --out report.html",
];

/// That a command has done the sequences without a problem.
#[track_caller]
fn others_are_done(scene: &Scene, line: &str, stdout: &str) {
    if line.starts_with("plot") {
        assert!(
            scene.path("plots/success_ope.svg").is_file() && scene.path("plots/precision_ope.csv").is_file()
        );
    } else if line.starts_with("report") {
        let page = scene.read("report.html");
        assert!(page.contains("Ann") && page.contains("Cid"));
    } else {
        assert!(stdout.contains("Ann") && stdout.contains("Cid"), "{line}: {stdout}");
    }
}

#[test]
fn clean_results_are_scored_by_every_command() {
    let scene = Scene::with_results();
    for line in COMMANDS {
        let outcome = scene.accepts(line);
        others_are_done(&scene, line, &outcome.stdout);
    }
    let table = scene.accepts(COMMANDS[0]).stdout;
    assert!(table.contains("0.9524"), "a perfect tracker: {table}");
}

#[test]
fn bad_result_files_are_named_and_the_others_scored() {
    for (text, needles) in [
        ("10,20,30,40\n10,b,30,40\n", &["Bob.txt, line 2", "`10,b,30,40`"][..]),
        ("10;20;30;40\n", &["Bob.txt, line 1"]),
        ("", &["Bob.txt: the file is empty"]),
        ("10,20,30\n", &["Bob.txt, line 1", "3 numbers"]),
        ("10,20,30,40\n10,20,30,40\n", &["good, Bob: the result has 2 rows and the ground truth 6"]),
        (&"10,20,30,40\n".repeat(9), &["good, Bob: the result has 9 rows and the ground truth 6"]),
    ] {
        let scene = Scene::with_results();
        scene.write("results/good/Bob.txt", text);
        for line in COMMANDS {
            let outcome = scene.refuses(line, needles);
            others_are_done(&scene, line, &outcome.stdout);
        }
        let page = scene.read("report.html");
        assert!(page.contains("Bob"), "the page lists what failed");
    }
}

#[test]
fn a_sequence_without_result_or_truth_is_named() {
    let scene = Scene::with_results();
    fs::remove_file(scene.path("results/good/Bob.txt")).unwrap();
    scene.write("results/other/Dan.txt", "1,2,3,4\n");
    for line in COMMANDS {
        let needles: &[&str] = &["good, Bob: no result", "Dan: no ground truth"];
        let outcome = scene.refuses(line, needles);
        others_are_done(&scene, line, &outcome.stdout);
        scene.refuses(&format!("{line} --sequences Ann,Cid,Eve"), &["Eve: no ground truth"]);
    }
}

#[test]
fn lengths_can_be_accepted() {
    let scene = Scene::with_results();
    scene.write("results/good/Bob.txt", &"10,20,30,40\n".repeat(3));
    let half = |rows: &str| {
        let line =
            format!("score --data boxes.json --results results/good --sequences Bob --missing-rows {rows}");
        scene.accepts(&line).stdout
    };
    assert!(half("drop").contains("0.9524"));
    assert!(half("miss").contains("0.4762"));
    scene.refuses(
        "score --data boxes.json --results results --toolkit pysot",
        &["good, Bob: pysot would fail"],
    );
    let all = scene.accepts("score --data boxes.json --results results --toolkit all").stdout;
    assert!(all.contains("pysot on good, 1: Bob") && all.contains("the result lacks 3 rows"), "{all}");
}

#[test]
fn numbers_that_a_toolkits_reader_cannot_tell_apart_are_named() {
    let scene = Scene::with_results();
    scene.write("results/good/Bob.txt", &"10 20 30 40\n".repeat(6));
    scene.accepts("score --data boxes.json --results results");
    let needles: &[&str] = &["good, Bob: got10k would fail", "otb_eval convert"];
    let outcome = scene.refuses("score --data boxes.json --results results --toolkit got10k", needles);
    assert!(outcome.stdout.contains("Ann"), "{}", outcome.stdout);
}

#[test]
fn times_that_are_none_cost_no_score() {
    let scene = Scene::with_results();
    scene.write("results/good/Bob_time.txt", "0.1\nfast\n");
    let outcome = scene.refuses(COMMANDS[0], &["Bob_time.txt, line 2: `fast` is no time"]);
    let bob = outcome.stdout.lines().find(|line| line.starts_with("Bob")).unwrap();
    assert!(!bob.contains('-'), "{bob}");
}

#[test]
fn words_that_mean_nothing_are_refused_with_what_there_is() {
    let scene = Scene::with_results();
    let score = COMMANDS[0];
    for (line, needles) in [
        (format!("{score} --trackers KCF"), &["`KCF`", "good, other"][..]),
        ("compare good KCF --data boxes.json --results results".into(), &["`KCF`", "good, other"]),
        (format!("{score} --attributes XY"), &["`XY`", "tb100, json"]),
        (format!("{score} --measure iou"), &["iou", "auc"]),
        (format!("{score} --toolkit vot"), &["`vot`", "plain, matlab"]),
        (format!("{score} --protocol tre"), &["no results of tre", "ope"]),
        ("score --data boxes.json".into(), &["give --results"]),
        ("score --results results".into(), &["give --data"]),
        ("score --data boxes.json --results nowhere".into(), &["nowhere: no such folder"]),
        ("convert results out --from vot --to flat".into(), &["`vot`", "run, flat, pysot"]),
        ("convert results out --from got10k --to jwlim --trackers KCF".into(), &["`KCF`", "good, other"]),
        ("convert nowhere out --from flat --to jwlim".into(), &["nowhere: no such folder"]),
        ("check nowhere".into(), &["nowhere: no such file or folder"]),
    ] {
        scene.refuses(&line, needles);
    }
}

#[test]
fn convert_names_bad_files_and_does_the_others() {
    let scene = Scene::with_results();
    scene.write("results/good/Bob.txt", "letters\n");
    scene.refuses("convert results out --from flat --to got10k", &["Bob.txt, line 1"]);
    assert_eq!(scene.read("out/OTB2015/good/Ann.txt"), scene.read("results/good/Ann.txt"));
    assert!(!scene.path("out/OTB2015/good/Bob.txt").exists());
    scene.refuses("convert results out --from flat --to got10k", &["is there already"]);
    scene.accepts("convert out back --from got10k --to jwlim");
    scene.accepts("convert back run --from jwlim --to run");
    scene.accepts("score --data boxes.json --results run --trackers other");
}

#[test]
fn check_names_damage_checks_the_rest_and_writes_json() {
    let scene = Scene::with_walkers();
    let clean = scene.accepts("check data --json check.json");
    assert!(clean.stdout.contains("3 targets: 3 with oddities, 0 damaged"), "fractions: {}", clean.stdout);
    let report: serde_json::Value = serde_json::from_str(&scene.read("check.json")).unwrap();
    assert_eq!(report["targets"][0]["images"]["size"], serde_json::json!([96, 96]));
    let image = scene.path("data/Ann/img/0003.jpg");
    let bytes = fs::read(&image).unwrap();
    fs::write(&image, &bytes[..bytes.len() - 40]).unwrap();
    scene.write("data/Cid/groundtruth_rect.txt", "1,2,x,4\n");
    let needles: &[&str] = &["Ann: ", "0003.jpg: cannot be decoded: the file is truncated", "Cid", "line 1"];
    for flags in ["", " --decode"] {
        let outcome = scene.refuses(&format!("check data{flags}"), needles);
        assert!(outcome.stdout.contains("Bob: 20 rows, 20 images 96x96"), "{}", outcome.stdout);
    }
    scene.accepts("check data/Bob");
}

/// Makes files as MATLAB's benchmark does, and reads them back through the script.
const MAKE_MAT: &str = "
import numpy as np
from scipy.io import savemat
def cell(segments):
    cells = np.empty((1, len(segments)), dtype=object)
    for i, segment in enumerate(segments):
        cells[0, i] = segment
    return {'results': cells}
box = np.tile([10.0, 20.0, 30.0, 40.5], (6, 1))
segment = {'res': box, 'type': 'rect', 'fps': 4.0, 'len': 6, 'annoBegin': 1, 'startFrame': 1}
savemat('ann_T.mat', cell([segment]))
savemat('bob_T.mat', cell([dict(segment, shiftType=shift) for shift in ('left', 'scale_8')]))
savemat('cid_T.mat', cell([segment, dict(segment, res=box[2:])]))
savemat('dan_T.mat', cell([dict(segment, type='ivtAff')]))
";

#[test]
fn the_matlab_benchmarks_files_are_read_by_the_script() {
    let scene = Scene::with_results();
    let python = |words: &[&str]| Command::new("python3").args(words).current_dir(scene.path("")).output();
    if !python(&["-c", "import scipy.io"]).is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: no python3 with SciPy");
        return;
    }
    assert!(python(&["-c", MAKE_MAT]).unwrap().status.success());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/mat_to_text.py");
    let files = ["ann_T.mat", "bob_T.mat", "cid_T.mat", "dan_T.mat"];
    let output = python(&[&[script][..], &files, &["--out", "mat"]].concat()).unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(2) && told.contains("dan_T.mat: its results are of type `ivtAff`"),
        "{told}"
    );
    assert_eq!(scene.read("mat/ope/T/seed_0/Ann.txt"), "10.0,20.0,30.0,40.5\n".repeat(6));
    assert_eq!(scene.read("mat/ope/T/seed_0/Ann_time.txt"), "0.25000000\n".repeat(6));
    assert!(scene.path("mat/sre/T/seed_0/Bob_scale_8.txt").is_file());
    assert_eq!(scene.read("mat/tre/T/seed_0/Cid_02.txt").lines().count(), 4);
    scene.accepts("score --data boxes.json --results mat --toolkit matlab");
}
