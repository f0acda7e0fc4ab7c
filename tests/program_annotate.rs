//! `infopart annotate` as a user meets it: a box in every frame, projects, formats, requests, and what it refuses.

mod program_scene;

use std::fs;

use assert_cmd::Command;
use infopart::geometry::Rect;
use program_scene::Scene;
use serde_json::{Value, json};

/// Where the square of frame `number`, counted from 1, is.
fn square(number: usize) -> Rect {
    Rect::new(10.0 + 2.0 * number as f64, 10.0, 12.0, 24.0)
}

fn key(number: usize) -> Value {
    let Rect { x, y, w, h } = square(number);
    json!({"frame": number, "box": [x, y, w, h]})
}

fn write_keys(scene: &Scene, objects: &[(&str, Vec<Value>)]) {
    let objects: Vec<Value> =
        objects.iter().map(|(name, keys)| json!({"name": name, "class": "square", "keys": keys})).collect();
    scene.write("keys.json", json!({"version": 1, "objects": objects}).to_string().as_bytes());
}

/// The boxes of a CSV without odd names, by frame counted from 1.
fn boxes(csv: &str) -> Vec<(usize, Rect)> {
    csv.lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |at: usize| cells[at].parse::<f64>().unwrap();
            (cells[0].parse().unwrap(), Rect::new(number(4), number(5), number(6), number(7)))
        })
        .collect()
}

fn summary(stderr: &str) -> Value {
    serde_json::from_str(stderr.lines().last().unwrap()).unwrap()
}

#[test]
fn three_boxes_give_a_box_in_every_frame_and_key_frames_stay() {
    let scene = Scene::with_images(14);
    write_keys(&scene, &[("a", vec![key(1), key(7), key(14)])]);
    let outcome = scene.run(&["annotate", "img", "--keys", "keys.json", "--out", "b.csv", "--threads", "1"]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("14 frames, 1 objects, 3 key frames: 14 boxes; 26 frames tracked"),
        "{}",
        outcome.stderr
    );
    let found = boxes(&scene.read("b.csv"));
    assert_eq!(found.iter().map(|(frame, _)| *frame).collect::<Vec<_>>(), (1..=14).collect::<Vec<_>>());
    for (frame, rect) in &found {
        assert!(rect.overlap(&square(*frame)) > 0.7, "frame {frame}: {rect:?}");
    }
    assert_eq!([found[0].1, found[6].1, found[13].1], [1, 7, 14].map(square));
    assert!(!scene.path("b.csv.partial").exists());
}

#[test]
fn a_project_tracks_again_only_what_touches_a_new_key_frame() {
    let scene = Scene::with_images(14);
    let tracked = || {
        let words = [
            "annotate",
            "img",
            "--keys",
            "keys.json",
            "--project",
            "p.json",
            "--out",
            "b.csv",
            "--json",
            "--threads",
            "1",
        ];
        let outcome = scene.run(&words);
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        summary(&outcome.stderr)["tracked"].as_u64().unwrap()
    };
    write_keys(&scene, &[("a", vec![key(1), key(14)]), ("b", vec![key(3)])]);
    assert_eq!(tracked(), 13 + 13 + 2 + 11);
    let first = scene.read("b.csv");
    assert_eq!(tracked(), 0);
    assert_eq!(scene.read("b.csv"), first);
    write_keys(&scene, &[("a", vec![key(1), key(5), key(14)]), ("b", vec![key(3)])]);
    assert_eq!(tracked(), 4 + 9);
    let kept = scene.read("b.csv");
    // From nothing the boxes are the same, so nothing that was kept is stale.
    fs::remove_file(scene.path("p.json")).unwrap();
    assert_eq!(tracked(), 4 + 4 + 9 + 9 + 2 + 11);
    assert_eq!(scene.read("b.csv"), kept);
    // The project alone is enough, and another seed is another tracker.
    let alone = scene.run(&["annotate", "img", "--project", "p.json", "--json", "--threads", "1"]);
    assert_eq!((alone.stdout.as_str(), &summary(&alone.stderr)["tracked"]), (kept.as_str(), &json!(0)));
    let seeded =
        scene.run(&["annotate", "img", "--project", "p.json", "--json", "--threads", "1", "--seed", "2"]);
    assert_eq!(summary(&seeded.stderr)["tracked"], 4 + 4 + 9 + 9 + 2 + 11);
}

#[test]
fn an_absent_object_has_no_box() {
    let scene = Scene::with_images(8);
    write_keys(&scene, &[("a", vec![key(2), json!({"frame": 4, "absent": true}), key(7)])]);
    let outcome = scene.run(&["annotate", "img", "--keys", "keys.json", "--threads", "1"]);
    let frames: Vec<usize> = boxes(&outcome.stdout).iter().map(|(frame, _)| *frame).collect();
    assert_eq!(frames, [1, 2, 3, 7, 8], "{}", outcome.stderr);
}

#[test]
fn every_format_is_written_and_mot_rows_are_those_of_the_csv() {
    let scene = Scene::with_images(4);
    write_keys(&scene, &[("x", vec![key(1)])]);
    for (out, format) in [
        ("a.csv", ""),
        ("a.jsonl", ""),
        ("a.txt", ""),
        ("a.xml", ""),
        ("a.json", ""),
        ("m.txt", "mot"),
        ("labels", "yolo"),
    ] {
        let mut words =
            vec!["annotate", "img", "--keys", "keys.json", "--out", out, "--quiet", "--threads", "1"];
        if !format.is_empty() {
            words.extend(["--format", format]);
        }
        let outcome = scene.run(&words);
        assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""), "{out}");
    }
    let mot: Vec<Rect> = scene
        .read("m.txt")
        .lines()
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            Rect::new(cells[2] - 1.0, cells[3] - 1.0, cells[4], cells[5])
        })
        .collect();
    for ((_, csv), mot) in boxes(&scene.read("a.csv")).iter().zip(&mot) {
        assert!(csv.overlap(mot) > 1.0 - 1e-9);
    }
    assert_eq!((mot.len(), fs::read_dir(scene.path("labels/labels")).unwrap().count()), (4, 4));
    assert_eq!(scene.read("a.txt").lines().count(), 4);
    assert!(scene.read("a.xml").contains("<track id=\"0\" label=\"square\""));
}

#[test]
fn requests_are_answered_a_line_each_and_bad_ones_do_not_end_it() {
    let scene = Scene::with_images(6);
    let requests = [
        json!({"keys": [key(1)]}).to_string(),
        "nonsense".to_owned(),
        json!({"keys": [{"frame": 9, "box": [1, 1, 5, 5]}]}).to_string(),
        json!({"keys": [key(1), key(6)]}).to_string(),
        json!({"keys": [key(1), key(6)], "sides": "forward"}).to_string(),
    ];
    let output = Command::cargo_bin("infopart")
        .unwrap()
        .args(["annotate", "img", "--serve", "--threads", "1"])
        .current_dir(scene.path("."))
        .write_stdin(requests.join("\n"))
        .output()
        .unwrap();
    assert!(output.status.success());
    let stdout = String::from_utf8(output.stdout).unwrap();
    let answers: Vec<Value> = stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(answers.len(), 5, "{stdout}");
    assert_eq!((answers[0]["boxes"].as_array().unwrap().len(), &answers[0]["tracked"]), (6, &json!(5)));
    assert!(answers[1]["error"].is_string());
    assert!(answers[2]["error"].as_str().unwrap().contains("no frame 9; the input has 6 frames"));
    assert_eq!((&answers[3]["tracked"], &answers[4]["tracked"]), (&json!(5), &json!(0)));
    let Rect { x, y, w, h } = square(6);
    assert_eq!(answers[3]["boxes"][5], json!([x, y, w, h]));
}

#[test]
fn bad_input_names_file_frame_or_flag_and_writes_nothing() {
    let scene = Scene::with_images(3);
    let with_box = |frame: usize, rect: [f64; 4]| vec![json!({"frame": frame, "box": rect})];
    let words = ["annotate", "img", "--keys", "keys.json", "--out", "b.csv"];
    for (keys, reasons) in [
        (vec![("a", with_box(4, [1.0, 1.0, 5.0, 5.0]))], ["\"a\": there is no frame 4", "3 frames"]),
        (vec![("<a>", with_box(2, [64.0, 1.0, 5.0, 5.0]))], ["\"<a>\", frame 2", "inside the 64x48 frame"]),
        (vec![("a", with_box(2, [1.0, 1.0, 0.0, 5.0]))], ["frame 2", "positive width"]),
        (vec![("a", vec![])], ["\"a\"", "no key frame with a box"]),
        (vec![], ["no object", "--keys"]),
    ] {
        write_keys(&scene, &keys);
        scene.refuses(&words, &reasons);
    }
    scene.write("keys.json", br#"{"version": 1, "objects": [{"name": "a""#);
    scene.refuses(&words, &["--keys keys.json: is cut short"]);
    scene.write("keys.json", br#"{"version": 7, "objects": []}"#);
    scene.refuses(&words, &["--keys keys.json: is of version 7", "reads version 1"]);
    scene.refuses(&["annotate", "img", "--keys", "no.json"], &["--keys no.json: cannot be read"]);
    scene.refuses(&["annotate", "img"], &["--keys"]);
    write_keys(&scene, &[("a", vec![key(1)]), ("b", vec![key(1)])]);
    scene.refuses(&["annotate", "img", "--keys", "keys.json", "--out", "b.txt"], &["otb", "--format csv"]);
    scene.refuses(&["annotate", "img", "--keys", "keys.json", "--format", "yolo"], &["yolo", "--out"]);
    scene.refuses(
        &["annotate", "-", "--keys", "keys.json"],
        &["-: a stream can be read only once", "record it first"],
    );
    assert!(!scene.path("b.csv").exists() && !scene.path("b.csv.partial").exists());
}
