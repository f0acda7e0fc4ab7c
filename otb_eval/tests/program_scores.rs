//! `otb_eval` score, compare, plot, report, convert and check on bad input: it is named, and everything else is done.

mod bench_scene;

use std::fs;

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
        ("10/20/30/40\n", &["Bob.txt, line 1"]),
        ("10,20,30,\u{1b}[2J\n", &["Bob.txt, line 1: `10,20,30,\\u{1b}[2J`"]),
        ("", &["Bob.txt: the file is empty"]),
        ("10,20,30\n", &["Bob.txt, line 1", "3 numbers"]),
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
fn defects_of_others_results_are_listed_and_count_as_problems_only_if_strict() {
    for (rows, told) in [(2, "2 rows"), (9, "9 rows")] {
        let scene = Scene::with_results();
        scene.write("results/good/Bob.txt", &"10,20,30,40\n".repeat(rows));
        let needle = format!("defect: good, Bob: the result has {told} and the ground truth 6");
        for line in COMMANDS {
            let outcome = scene.accepts(line);
            assert!(outcome.stderr.contains(&needle), "{line}: {}", outcome.stderr);
            others_are_done(&scene, line, &outcome.stdout);
            let strict = scene.refuses(&format!("{line} --strict"), &[&needle]);
            others_are_done(&scene, line, &strict.stdout);
        }
        assert!(scene.read("report.html").contains(&needle[8..]), "the page lists the defect");
        scene.accepts(&format!("{} --toolkit pysot", COMMANDS[0]));
        scene.refuses(&format!("{} --toolkit pysot --strict", COMMANDS[0]), &["pysot would fail"]);
    }
    // What `run` itself wrote has as many rows as its ground truth, or one of the two was changed.
    let scene = Scene::with_walkers();
    scene.accepts("run --data data --config fast=fast.toml --out results");
    scene.write("data/Cid/groundtruth_rect.txt", &"1,2,30,40\n".repeat(15));
    scene.refuses("score --data data --results results", &["problem: fast, Cid: the result has 16 rows"]);
}

#[test]
fn rows_in_other_forms_are_read_and_said() {
    let scene = Scene::with_results();
    for (tracker, row) in [
        ("scores", "10,20,30,40,0.5\n"),
        ("polygons", "10,20,40,20,40,60,10,60\n"),
        ("semi", "10;20;30;40\n"),
    ] {
        for name in ["Ann", "Bob", "Cid"] {
            scene.write(&format!("results/{tracker}/{name}.txt"), &row.repeat(6));
        }
    }
    for name in ["Ann", "Bob", "Cid"] {
        scene.write(&format!("results/vot/{name}.txt"), &format!("1\n{}", "10,20,30,40\n".repeat(5)));
        let rows: String = (1..=6).map(|frame| format!("{frame} 10 20 30 40\n")).collect();
        scene.write(&format!("results/frames/{name}.txt"), &format!("frame x y w h\n{rows}"));
    }
    let outcome = scene.accepts(COMMANDS[0]);
    for needle in [
        "note: scores, Ann: read with a column of scores, left out",
        "note: polygons, Bob: read with the upright box around each polygon",
        "note: semi, Cid: read with semicolons",
        "note: vot, Ann: read with VOT's code 1",
        "note: frames, Ann: read with a header line; a column of frame numbers, left out",
    ] {
        assert!(outcome.stderr.contains(needle), "`{needle}` is not in: {}", outcome.stderr);
    }
    assert_eq!(
        outcome.stdout.matches(" 0.9524 ").count(),
        7 * 5,
        "seven perfect trackers: {}",
        outcome.stdout
    );
    scene.refuses(&format!("{} --toolkit got10k --strict", COMMANDS[0]), &["semi, Ann: got10k would fail"]);
    let converted =
        scene.refuses("convert results out --from flat --to run", &["vot/Ann.txt: its first line is VOT's"]);
    assert!(
        converted.stderr.contains("note: results/scores/Ann.txt: read with a column of scores"),
        "{}",
        converted.stderr
    );
    assert_eq!(scene.read("out/ope/polygons/seed_0/Bob.txt"), "10,20,30,40\n".repeat(6));
    scene.write("results/semi/Ann.txt", &"10,20,30,40,50\n".repeat(6));
    scene.refuses(COMMANDS[0], &["Ann.txt, line 1: `10,20,30,40,50` has 5 numbers, and nothing tells"]);
}

#[test]
fn a_page_shows_what_there_is_and_says_what_is_missing() {
    let scene = Scene::empty();
    let rows = ["[10, 20, 30, 40]"; 24].join(", ");
    scene.write("boxes.json", &format!("{{\"Ann\": {{\"gt_rect\": [{rows}]}}}}"));
    scene.write("results/ope/own/seed_1/Ann.txt", &"10,20,30,40\n".repeat(24));
    scene.write("results/ope/KCF/seed_1/Ann.txt", &"12,20,30,40\n".repeat(24));
    scene.write("results/sre/aaa/seed_1/Ann_left.txt", &"10,20,30,40\n".repeat(24));
    scene.write("results/old/Ann.txt", "10,20,30,40\n");
    for line in [COMMANDS[2], COMMANDS[3]] {
        let outcome = scene
            .refuses(line, &["aaa, Ann_right, Ann_up, Ann_down and 8 more", "note: OPE: no results of aaa"]);
        for needle in ["note: SRE: no results of KCF, own", "old beside ope, tre or sre are left alone"] {
            assert!(outcome.stderr.contains(needle), "{line}: `{needle}` is not in: {}", outcome.stderr);
        }
    }
    let page = scene.read("report.html");
    for needle in ["SRE: no results of KCF, own", "OPE: no results of aaa", "0.952"] {
        assert!(page.contains(needle), "{needle}");
    }
    let chosen = "--trackers own,KCF,aaa";
    scene.refuses(&format!("{} {chosen}", COMMANDS[3]), &["note: OPE: no results of aaa"]);
    scene.refuses(&format!("{} --trackers own,MOSSE", COMMANDS[3]), &["`MOSSE`", "KCF, aaa, own"]);
    scene.accepts(&format!("{} --protocol ope --trackers own,KCF", COMMANDS[3]));
}

#[test]
fn a_folder_too_high_is_named_with_the_one_to_give() {
    let scene = Scene::with_results();
    let line = "score --data boxes.json --results .";
    scene.refuses(line, &["no results there", "There are some in ./results: give that folder"]);
    // Folders of other text beside it look like trackers, but nothing in them fits the data.
    scene.write("above/results/good/Ann.txt", "10,20,30,40\n");
    scene.write("above/meta/tb_100.txt", "10,20,30,40\n");
    let line = "score --data boxes.json --results above";
    scene.refuses(line, &["nothing there fits the data, but there are results in above/results"]);
    let walkers = Scene::with_walkers();
    fs::create_dir(walkers.path("above")).unwrap();
    fs::rename(walkers.path("data"), walkers.path("above/otb")).unwrap();
    for line in ["check above", "run --data above --config fast=fast.toml --out r"] {
        walkers.refuses(
            line,
            &["no sequence there that is laid out", "There are some in above/otb: give those"],
        );
    }
}

#[test]
fn all_frames_of_tiger1_are_aligned_with_the_benchmarks() {
    let scene = Scene::empty();
    let rows = |from: usize| (from..=354).map(|frame| format!("{frame},20,30,40\n")).collect::<String>();
    let truth: Vec<String> = (6..=354).map(|frame| format!("[{frame}, 20, 30, 40]")).collect();
    scene.write("boxes.json", &format!("{{\"Tiger1\": {{\"gt_rect\": [{}]}}}}", truth.join(", ")));
    scene.write("results/got/Tiger1.txt", &rows(1));
    scene.write("results/sot/Tiger1.txt", &rows(6));
    for toolkit in ["plain", "matlab", "jwlim", "pysot", "got10k", "pytracking"] {
        let outcome =
            scene.accepts(&format!("{} --toolkit {toolkit} --attributes none --strict", COMMANDS[0]));
        assert!(
            outcome.stderr.contains("note: got, Tiger1: the result has rows of all frames"),
            "{}",
            outcome.stderr
        );
        assert!(outcome.stderr.contains("row 6 is compared with the ground truth's first"));
        let perfect: Vec<&str> = outcome.stdout.lines().filter(|line| line.contains("0.9524")).collect();
        assert_eq!(perfect.len(), 5, "both overall, twice, and the sequence: {}", outcome.stdout);
    }
    // A truth of all 354 rows is cut to the benchmark's.
    let truth: Vec<String> = (1..=354).map(|frame| format!("[{frame}, 20, 30, 40]")).collect();
    scene.write("boxes.json", &format!("{{\"Tiger1\": {{\"gt_rect\": [{}]}}}}", truth.join(", ")));
    let all = scene.accepts(&format!("{} --strict", COMMANDS[0]));
    assert!(all.stdout.matches("0.9524").count() >= 4, "{}", all.stdout);
}

#[test]
fn frames_per_second_and_normalised_precision_are_as_each_toolkit_prints_them() {
    let scene = Scene::with_results();
    for name in ["Ann", "Bob", "Cid"] {
        scene.write(&format!("results/good/{name}_time.txt"), "1.0\n0.5\n0.25\n0.5\n0.0\n0.25\n");
        // 9 of 30 pixels aside: 0.3 of the width, beyond 0.2 and within 0.5.
        scene.write(
            &format!("results/other/{name}.txt"),
            &format!("10,20,30,40\n{}", "19,20,30,40\n".repeat(5)),
        );
    }
    let number = |toolkit: &str, tracker: &str, key: &str| {
        scene.accepts(&format!("{} --toolkit {toolkit} --json scores.json", COMMANDS[0]));
        let json: serde_json::Value = serde_json::from_str(&scene.read("scores.json")).unwrap();
        let trackers = json["tables"][0]["table"]["trackers"].as_array().unwrap().clone();
        let one = trackers.into_iter().find(|one| one["tracker"] == tracker).unwrap();
        one.pointer(key).unwrap().as_f64().unwrap()
    };
    assert!((number("plain", "good", "/frames_per_second") - 5.0 / 1.5).abs() < 1e-12);
    assert!(
        (number("got10k", "good", "/frames_per_second") - (1.0 + 2.0 + 4.0 + 2.0 + 4.0) / 5.0).abs() < 1e-12
    );
    for toolkit in ["pysot", "stvir", "pytracking"] {
        let at = number(toolkit, "other", "/overall/normalised_precision_20/mean");
        let area = number(toolkit, "other", "/overall/normalised_precision_area/mean");
        assert!((at - 1.0 / 6.0).abs() < 1e-6, "{toolkit}: {at}");
        assert!((area - (30.0 / 6.0 + 21.0) / 51.0).abs() < 0.02, "{toolkit}: {area}");
        let table = scene.accepts(&format!("{} --toolkit {toolkit}", COMMANDS[0])).stdout;
        assert!(
            table.contains("normalised precision at 0.2") && table.contains("normalised precision, area")
        );
    }
    let by_sequence = scene.accepts(&format!("{} --measure normalised", COMMANDS[0])).stdout;
    assert!(
        by_sequence.contains("normalised precision at 0.2 by sequence") && by_sequence.contains("0.1667")
    );
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
        "score --data boxes.json --results results --toolkit pysot --strict",
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
    let outcome =
        scene.refuses("score --data boxes.json --results results --toolkit got10k --strict", needles);
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
