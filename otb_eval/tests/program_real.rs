//! The program on real data, and the plots, page and numbers it makes of published results.

mod bench_scene;
#[path = "../../tests/common/mod.rs"]
mod common;

use std::path::Path;

use bench_scene::Scene;

/// A command on the published results, its words before `--data`.
fn published(words: &str, data: &Path) -> String {
    let (truth, results) = (data.join("otb_meta/OTB100.json"), data.join("otb_results"));
    format!("{words} --data {} --results {}", truth.display(), results.display())
}

#[test]
fn the_data_is_whole_and_its_oddities_are_named() {
    let Some(data) = common::data_dir() else { return };
    let scene = Scene::empty();
    let folders = ["otb", "people", "ships", "others", "longterm"]
        .map(|name| data.join(name).display().to_string())
        .join(" ");
    let told = scene.accepts(&format!("check {folders}")).stdout;
    for needle in [
        "David: 471 rows, 471 images 320x240 (0300.jpg to 0770.jpg)",
        "81 images but 74 rows: the rows are of frames 1 to 74",
        "231 images but 215 rows: the rows are of frames 1 to 215",
        "several targets: Jogging-1, Jogging-2",
        "only tb_100.txt has OPR FM",
        "the boxes do not have LR (smallest box 686 px in row 495), but tb_100.txt says so",
        "199 rows, but the benchmark has 1698: it was cut",
        "72 rows with NaN (the target is absent); the first is row 34",
        "people8: 8 of 8",
        "people11: 11 of 11",
        "people19: 19 of 19",
        "other7: 7 of 7",
        "others12: 12 of 12",
        "longterm: 3 of 3",
        "0 damaged",
    ] {
        assert!(told.contains(needle), "`{needle}` is not in: {told}");
    }
    let boxes = scene.accepts(&format!("check {}", data.join("otb_meta/OTB100.json").display())).stdout;
    assert_eq!(boxes.matches("the sources of attributes differ").count(), 14);
    for needle in
        ["Board: 698 rows", "1 row without area", "it is called Human4 in got10k", "tb100: 100 of 100"]
    {
        assert!(boxes.contains(needle), "{needle}");
    }
    // On the sequences whose sources differ in SV, FM or LR the boxes side with the JSON.
    assert!(
        !boxes.lines().any(|line| line.contains("OTB100.json") && line.contains("the boxes do not have"))
    );
}

#[test]
fn published_results_make_scores_comparisons_plots_and_a_page() {
    let Some(data) = common::data_dir() else { return };
    let scene = Scene::empty();
    let short = [
        "MDNet, Board: the result has 697 rows",
        "MDNet, Twinnings",
        "STRUCK, ClifBar: the result has 329 rows",
    ];
    let listed = scene.accepts(&published("score", &data));
    for needle in short {
        assert!(listed.stderr.contains(&format!("defect: {needle}")), "{}", listed.stderr);
    }
    scene.refuses(&published("score --strict", &data), &short);
    let scores = listed.stdout;
    let row = |name: &str| {
        let line = scores.lines().find(|line| line.starts_with(name)).unwrap().to_owned();
        // Without the marks of the best and the second.
        let is_mark = |word: &&str| matches!(*word, "*" | "+");
        line.split_whitespace().filter(|word| !is_mark(word)).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("STRUCK")[2..5], ["100", "0.4623", "0.6398"]);
    assert_eq!(row("SiamRPN++")[2..5], ["100", "0.6955", "0.9054"]);
    let accept = "--missing-rows drop";
    scene.accepts(&format!("{} {accept} --toolkit all --json all.json", published("score", &data)));
    let all: serde_json::Value = serde_json::from_str(&scene.read("all.json")).unwrap();
    assert_eq!(all["tables"].as_array().unwrap().len(), 6);
    let failing = all["tables"][5]["problems"].as_array().unwrap().len();
    assert_eq!(failing, 76, "pytracking refuses every file of TLD's with a NaN");
    let compared = scene.accepts(&format!("{} {accept}", published("compare SRDCF DSST", &data))).stdout;
    assert!(compared.contains("+0.0851") && compared.contains("60 : 40"), "{compared}");
    scene.accepts(&format!("{} {accept} --out plots", published("plot", &data)));
    let names =
        ["success_ope", "precision_ope", "normalised_precision_ope", "success_ope_LR", "precision_ope_IV"];
    for name in names {
        for end in ["svg", "png", "csv"] {
            assert!(scene.path(&format!("plots/{name}.{end}")).is_file(), "{name}.{end}");
        }
    }
    let svg = scene.read("plots/success_ope.svg");
    let at = |text: &str| svg.find(text).unwrap_or_else(|| panic!("no `{text}` in the plot"));
    assert!(at("SiamRPN++") < at("MDNet") && at("MDNet") < at("TLD"), "the legend ranks by AUC");
    scene.accepts(&format!("{} {accept} --no-frames --out page.html", published("report", &data)));
    let page = scene.read("page.html");
    assert!(page.contains("SiamRPN++") && !page.contains("src=\"http") && !page.contains("data:image/jpeg"));
}

#[test]
fn a_run_on_real_frames_is_planned_done_and_reported_with_them() {
    let Some(data) = common::data_dir() else { return };
    let scene = Scene::empty();
    scene.write("fast.toml", "particles = 60\nparticle_sets = 1\n");
    let otb = data.join("otb");
    let run = format!(
        "run --data {} --sequences Deer,Football1 --config fast=fast.toml --out results",
        otb.display()
    );
    scene.accepts(&run);
    assert_eq!(scene.read("results/ope/fast/seed_1/Football1.txt").lines().count(), 74);
    let deer = scene.read("results/ope/fast/seed_1/Deer.txt");
    assert!(deer.starts_with("306,5,95,65\n"), "the first row is the box given, counted from 1: {deer}");
    scene.accepts(&format!("report --data {} --results results --out page.html", otb.display()));
    assert!(scene.read("page.html").contains("data:image/jpeg"), "a strip of frames");
    scene.accepts("convert results got10k --from run --to got10k");
    scene.accepts(&format!("score --data {} --results got10k/OTB2015 --toolkit got10k", otb.display()));
}
