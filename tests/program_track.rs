//! `infopart track` from its flags to its rows, pictures and summary.

mod common;
mod program_scene;

use program_scene::Scene;

#[test]
fn rows_take_the_name_of_the_file_and_its_format() {
    let scene = Scene::otb(4);
    let outcome = scene.accepts(&["track", ".", "--out", "boxes.csv"]);
    assert_eq!(outcome.stdout, "");
    let rows = scene.read("boxes.csv");
    assert!(rows.starts_with("frame,x,y,w,h,"), "{rows}");
    assert_eq!(rows.lines().count(), 5);
    assert!(rows.lines().nth(1).unwrap().starts_with("1,13,11,12,24,"), "{rows}");
    assert!(!scene.path("boxes.csv.partial").exists());
    scene.accepts(&["track", ".", "--out", "boxes.csv", "--format", "otb"]);
    assert_eq!(scene.read("boxes.csv").lines().next(), Some("13,11,12,24"));
}

#[test]
fn the_origin_holds_for_the_first_box_and_every_row() {
    let scene = Scene::otb(4);
    let rows = |words: &[&str]| scene.accepts(&[&["track"], words].concat()).stdout;
    let one = rows(&[".", "--init", "13,11,12,24"]);
    let zero = rows(&[".", "--init", "12,10,12,24", "--origin", "0"]);
    let folder = rows(&["img", "--init", "12,10,12,24"]);
    assert_eq!(zero, folder, "a folder of images counts from 0");
    let first = |line: &str| line.split(',').next().unwrap().parse::<f64>().unwrap();
    for (one, zero) in one.lines().zip(zero.lines()) {
        assert!((first(one) - first(zero) - 1.0).abs() < 1e-9, "{one} and {zero}");
    }
}

#[test]
fn the_summary_is_aligned_text_or_one_json_object() {
    let scene = Scene::otb(4);
    let text = scene.accepts(&["track", ".", "--seed", "7"]).stderr;
    assert!(text.contains("seed       7") && text.contains("R1") && text.contains("AUC"), "{text}");
    let json =
        scene.accepts(&["track", ".", "--json", "--timing", "--region", "whole", "--threads", "1"]).stderr;
    let object: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(object["frames"], 4);
    assert_eq!(object["region"], "whole");
    assert_eq!(object["threads"], 1);
    assert_eq!(object["scores"]["frames"], 4);
    assert!(object["stages"].is_array());
    assert_eq!(scene.accepts(&["track", ".", "--quiet"]).stderr, "");
}

#[test]
fn flags_win_over_the_file_and_the_file_over_the_preset() {
    let scene = Scene::otb(2);
    scene.write("my.toml", b"seed = 11\nregion = \"whole\"\n");
    let summary = |words: &[&str]| -> serde_json::Value {
        let words = [&["track", ".", "--json", "--config", "my.toml"], words].concat();
        serde_json::from_str(&scene.accepts(&words).stderr).unwrap()
    };
    assert_eq!((&summary(&[])["seed"], &summary(&[])["region"]), (&11.into(), &"whole".into()));
    assert_eq!(summary(&["--seed", "3"])["seed"], 3);
    assert_eq!(summary(&["--region", "part"])["region"], "part");
}

#[test]
fn annotated_pictures_are_one_a_frame() {
    let scene = Scene::otb(3);
    scene.accepts(&["track", ".", "--annotate", "seen"]);
    let count = std::fs::read_dir(scene.path("seen")).unwrap().count();
    assert_eq!(count, 3);
    assert!(scene.path("seen/000003.jpg").exists());
    if common::has_ffmpeg() {
        scene.accepts(&["track", ".", "--annotate", "seen.mp4"]);
        assert!(scene.path("seen.mp4").metadata().unwrap().len() > 500);
    }
}

#[test]
fn help_tells_the_exit_codes() {
    for words in [&["--help"][..], &["track", "--help"]] {
        let help = Scene::empty().accepts(words).stdout;
        for line in ["Exit codes:", "0    success", "2    bad input", "130  interrupted"] {
            assert!(help.contains(line), "{line} is not in {help}");
        }
    }
    Scene::empty().refuses(&["track", ".", "--no-such-flag"], &["--no-such-flag"]);
}
