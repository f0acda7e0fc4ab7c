//! `infopart track --stride` and `--realtime`.

mod program_scene;

use program_scene::Scene;

fn summary(scene: &Scene, words: &[&str]) -> serde_json::Value {
    let words = [&["track", ".", "--json", "--out", "rows.csv"], words].concat();
    serde_json::from_str(&scene.accepts(&words).stderr).unwrap()
}

/// The values of one column of rows.csv.
fn column(scene: &Scene, name: &str) -> Vec<f64> {
    let rows = scene.read("rows.csv");
    let mut lines = rows.lines();
    let position = lines.next().unwrap().split(',').position(|title| title == name).unwrap();
    lines.map(|line| line.split(',').nth(position).unwrap().parse().unwrap()).collect()
}

#[test]
fn a_stride_predicts_the_frames_between_and_scores_them_all() {
    let scene = Scene::otb(11);
    let report = summary(&scene, &["--stride", "3"]);
    assert_eq!((&report["skipped_frames"], &report["frames"]), (&7.into(), &11.into()));
    assert_eq!((&report["pace"], &report["scores"]["frames"]), (&"stride 3".into(), &11.into()));
    assert!(report["sustained_frames_per_second"].as_f64().unwrap() > 0.0);
    let (x, particles) = (column(&scene, "x"), column(&scene, "effective_sample_size"));
    assert_eq!(x.len(), 11);
    for frame in 1..11 {
        assert_eq!(particles[frame] > 0.0, frame % 3 == 0, "frame {frame} of {particles:?}");
    }
    // Between two tracked frames the velocity is constant, and it is that of the tracked frames before.
    for first in [3, 6] {
        let velocity = (x[first] - x[first - 3]) / 3.0;
        for after in 1..3 {
            assert!((x[first + after] - x[first] - velocity * after as f64).abs() < 1e-6, "{x:?}");
        }
    }
    let again = scene.read("rows.csv");
    summary(&scene, &["--stride", "3"]);
    assert_eq!(scene.read("rows.csv"), again);
}

#[test]
fn a_stride_of_one_is_no_stride() {
    let scene = Scene::otb(5);
    summary(&scene, &["--stride", "1"]);
    let with = scene.read("rows.csv");
    assert_eq!(summary(&scene, &[])["skipped_frames"], 0);
    assert_eq!(scene.read("rows.csv"), with);
}

#[test]
fn in_real_time_a_rate_nobody_keeps_up_with_skips_and_a_slow_one_does_not() {
    let scene = Scene::otb(12);
    let slow = summary(&scene, &["--realtime", "0.01"]);
    assert_eq!((&slow["skipped_frames"], &slow["pace"]), (&0.into(), &"real time at 0.01 per second".into()));
    let fast = summary(&scene, &["--realtime", "1e9"]);
    assert_eq!(fast["skipped_frames"], 10, "the second frame is tracked, and then never again");
    assert_eq!(column(&scene, "x").len(), 12, "every frame has its row");
    let text = scene.accepts(&["track", ".", "--realtime", "1e9"]).stderr;
    assert!(text.contains("10 of 12 frames skipped") && text.contains("can be borne without"), "{text}");
}

#[test]
fn a_pace_that_makes_no_sense_is_refused() {
    let scene = Scene::otb(3);
    for (words, needles) in [
        (&["--stride", "0"][..], &["--stride", "whole number from 1"][..]),
        (&["--stride", "2.5"], &["--stride", "whole number from 1"]),
        (&["--realtime", "0"], &["--realtime", "above 0"]),
        (&["--realtime", "nan"], &["--realtime", "above 0"]),
        (&["--stride", "2", "--realtime", "30"], &["--stride", "--realtime", "cannot be used with"]),
    ] {
        scene.refuses(&[&["track", "."], words].concat(), needles);
    }
}
