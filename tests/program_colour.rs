//! The colour tracker through the whole program.

mod program_scene;

use program_scene::Scene;

#[test]
fn the_colour_tracker_follows_an_otb_folder() {
    let scene = Scene::otb(12);
    let outcome = scene.accepts(&["track", ".", "--tracker", "colour", "--json", "--out", "boxes.txt"]);
    assert!(outcome.stderr.contains("\"tracker\":\"colour\""), "{}", outcome.stderr);
    let r1 = outcome.stderr.split("\"r1\":").nth(1).unwrap().split(['}', ',']).next().unwrap();
    assert_eq!(r1.parse::<f64>().unwrap(), 100.0);
    let rows = scene.read("boxes.txt");
    assert_eq!(rows.lines().count(), 12);
    assert_eq!(rows.lines().next(), Some("13,11,12,24"));
    let again = ["track", ".", "--tracker", "colour", "--threads", "2", "--quiet", "--out", "again.txt"];
    scene.accepts(&again);
    assert_eq!(scene.read("again.txt"), rows);
}

#[test]
fn several_targets_have_a_file_each() {
    let scene = Scene::otb(5);
    let inits = ["--init", "13,11,12,24", "--init", "40,20,10,20"];
    let words = [&["track", ".", "--tracker", "colour", "--out", "boxes.txt"][..], &inits[..]].concat();
    let outcome = scene.accepts(&words);
    assert!(outcome.stderr.contains("2 targets: boxes.1.txt, boxes.2.txt"), "{}", outcome.stderr);
    for (file, first) in [("boxes.1.txt", "13,11,12,24"), ("boxes.2.txt", "40,20,10,20")] {
        let rows = scene.read(file);
        assert_eq!((rows.lines().count(), rows.lines().next()), (5, Some(first)));
    }
    assert!(!scene.path("boxes.txt").exists());
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let scene = Scene::otb(2);
    let run = |more: &[&str], needles: &[&str]| scene.refuses(&[&["track", "."], more].concat(), needles);
    let two = ["--init", "13,11,12,24", "--init", "40,20,10,20"];
    run(&two, &["--init", "--tracker colour"]);
    let colour = |more: &[&'static str]| [&["--tracker", "colour"][..], more].concat();
    run(&colour(&two), &["--out FILE"]);
    run(&colour(&[&two[..], &["--out", "a.csv"]].concat()), &["--format otb"]);
    run(&colour(&[&two[..], &["--out", "a.txt", "--annotate", "seen"]].concat()), &["--annotate"]);
    run(&colour(&["--region", "whole"]), &["--region"]);
    run(&colour(&["--preset", "paper"]), &["--preset"]);
    scene.write("bad.toml", b"noise_x = 99\n");
    run(&colour(&["--config", "bad.toml"]), &["noise_x", "99"]);
    scene.write("unknown.toml", b"stumps = 9\n");
    run(&colour(&["--config", "unknown.toml"]), &["stumps"]);
    let outside = ["--init", "13,11,12,24", "--init", "400,20,10,20", "--out", "a.txt"];
    run(&colour(&outside), &["--init", "no pixel inside"]);
}

#[test]
fn printed_parameters_are_taken_back() {
    let scene = Scene::otb(3);
    let printed = scene.accepts(&["config", "--tracker", "colour"]).stdout;
    assert!(printed.contains("similarity_weight = 10.0") && printed.contains("[background]"), "{printed}");
    scene.write("colour.toml", printed.as_bytes());
    let words = ["track", ".", "--tracker", "colour", "--config", "colour.toml", "--out", "a.txt"];
    scene.accepts(&words);
}
