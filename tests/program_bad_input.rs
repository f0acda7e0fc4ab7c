//! Every bad input ends in exit code 2 and a message that names the file, frame or flag and the remedy.

mod common;
mod program_scene;

use std::fs;

use program_scene::{Scene, picture};

const BOX: &str = "13,11,12,24";

#[test]
fn inputs_that_are_not_there_or_hold_nothing() {
    let scene = Scene::empty();
    scene.refuses(
        &["track", "nowhere", "--init", BOX],
        &["nowhere", "no such file or folder", "check the spelling"],
    );
    fs::create_dir(scene.path("empty")).unwrap();
    scene.refuses(&["track", "empty", "--init", BOX], &["empty", "no images", ".jpg"]);
    scene.refuses(&["track", "*.png", "--init", BOX], &["*.png", "no images"]);
}

#[test]
fn a_truncated_image_in_the_middle_keeps_the_rows_before_it() {
    let scene = Scene::otb(5);
    let whole = fs::read(scene.path("img/0004.png")).unwrap();
    scene.write("img/0004.png", &whole[..whole.len() / 2]);
    scene.refuses(
        &["track", ".", "--out", "boxes.txt"],
        &["0004.png", "cannot be decoded", "replace the file", "frame 3 (", "0003.png", "boxes.txt.partial"],
    );
    assert_eq!(scene.read("boxes.txt.partial").lines().count(), 3);
    assert!(!scene.path("boxes.txt").exists());
}

#[test]
fn a_frame_of_another_size_is_named_with_both_sizes() {
    let scene = Scene::otb(4);
    image::imageops::resize(&picture(3), 32, 24, image::imageops::FilterType::Nearest)
        .save(scene.path("img/0003.png"))
        .unwrap();
    scene.refuses(
        &["track", ".", "--out", "b.csv"],
        &["0003.png", "32x24", "64x48", "b.csv.partial", "frame 2"],
    );
}

#[test]
fn boxes_that_are_no_boxes_name_the_flag() {
    let scene = Scene::otb(2);
    for (given, reason) in [
        ("1,2,0,4", "not positive"),
        ("1,2,3,-4", "not positive"),
        ("nan,2,3,4", "not finite"),
        ("1,2,inf,4", "not finite"),
        ("1,2,3", "four"),
        ("a,2,3,4", "not a number"),
        ("-1,2,0,4", "not positive"),
    ] {
        scene.refuses(&["track", ".", "--init", given], &["--init", reason]);
    }
    scene.refuses(
        &["track", ".", "--init", "500,2,3,4", "--out", "b.txt"],
        &["--init 500,2,3,4", "no pixel inside the 64x48 frame"],
    );
    assert!(!scene.path("b.txt.partial").exists(), "nothing was tracked, so nothing is left behind");
}

#[test]
fn a_refused_box_is_told_in_the_users_numbers() {
    let scene = Scene::otb(3);
    scene.refuses(
        &["track", ".", "--init", "65,2,3,4"],
        &["--init 65,2,3,4", "64x48", "first pixel is 1,1", "--origin 1"],
    );
    scene.refuses(&["track", "img", "--init", "64,2,3,4"], &["--init 64,2,3,4", "first pixel is 0,0"]);
    scene.refuses(&["track", ".", "--init", "2e9,2,3,4"], &["--init 2000000000,2,3,4", "1e9"]);
    scene.write("groundtruth_rect.txt", b"13,11,12,24\n15,99,12,24\n17,11,12,24\n");
    scene.refuses(
        &["track", ".", "--start", "2"],
        &["groundtruth_rect.txt, row 2: 15,99,12,24", "frame 2 (0002.png)"],
    );
}

#[test]
fn odd_boxes_are_warned_of_and_tracked() {
    let scene = Scene::otb(3);
    for given in ["20,20,1,1", "-5,11,20,24", "-10,-10,200,200"] {
        let outcome = scene.accepts(&["track", ".", "--init", given]);
        assert!(outcome.stderr.contains("warning: the box"), "{given}: {}", outcome.stderr);
        assert_eq!(outcome.stdout.lines().next(), Some(given));
        assert_eq!(outcome.stdout.lines().count(), 3);
    }
}

#[test]
fn a_first_box_must_come_from_somewhere() {
    let scene = Scene::with_images(2);
    scene.refuses(&["track", "img"], &["img", "no ground truth", "--init X,Y,W,H"]);
    scene.write("groundtruth_rect.txt", b"NaN,NaN,NaN,NaN\n13,11,12,24\n");
    scene.refuses(&["track", "."], &["no box in the first frame", "--init"]);
    assert_eq!(scene.accepts(&["track", ".", "--start", "2"]).stdout.lines().next(), Some(BOX));
}

#[test]
fn ground_truth_with_letters_or_too_few_numbers_names_the_line() {
    let scene = Scene::otb(3);
    for (rows, reason) in
        [("13,11,12,24\n1,2,x,4\n1,2,3,4\n", "not a number"), ("13,11,12,24\n1,2,3\n1,2,3,4\n", "3 numbers")]
    {
        scene.write("groundtruth_rect.txt", rows.as_bytes());
        scene.refuses(&["track", "."], &["groundtruth_rect.txt", "line 2", reason]);
    }
}

#[test]
fn ground_truth_in_any_usual_dress_is_read() {
    let scene = Scene::otb(3);
    for rows in
        ["13,11,12,24\r\n15\t11\t12\t24\r\n17 11 12 24", "13,11,12,24\nNaN,NaN,NaN,NaN\n17, 11, 12, 24\n"]
    {
        scene.write("groundtruth_rect.txt", rows.as_bytes());
        assert_eq!(scene.accepts(&["track", "."]).stdout.lines().next(), Some(BOX));
    }
}

#[test]
fn several_targets_are_named_when_none_is_chosen() {
    let scene = Scene::with_images(2);
    scene.write("groundtruth_rect.1.txt", b"13,11,12,24\n15,11,12,24\n");
    scene.write("groundtruth_rect.2.txt", b"3,1,12,24\n5,1,12,24\n");
    scene.refuses(&["track", "."], &["1, 2", "--target"]);
    scene.refuses(&["track", ".", "--target", "3"], &["target 3"]);
    let second = scene.accepts(&["track", ".", "--target", "2"]);
    assert_eq!(second.stdout.lines().next(), Some("3,1,12,24"));
}

#[test]
fn configurations_with_unknown_keys_or_impossible_values_name_the_file() {
    let scene = Scene::otb(2);
    scene.write("my.toml", b"partickles = 300\n");
    scene.refuses(&["track", ".", "--config", "my.toml"], &["my.toml", "partickles"]);
    scene.write("my.toml", b"particles = 0\n");
    scene.refuses(&["track", ".", "--config", "my.toml"], &["my.toml", "particles"]);
    scene.write("my.toml", b"particles = [\n");
    scene.refuses(&["track", ".", "--config", "my.toml"], &["my.toml"]);
    scene.refuses(&["track", ".", "--config", "none.toml"], &["--config none.toml", "infopart config"]);
    scene.refuses(&["track", ".", "--preset", "fast"], &["--preset", "fast", "paper"]);
    scene.refuses(&["track", ".", "--region", "legs"], &["--region", "legs", "whole"]);
    scene.refuses(&["track", ".", "--threads", "0"], &["--threads"]);
}

#[test]
fn what_config_prints_is_what_config_takes() {
    let scene = Scene::otb(3);
    for preset in ["default", "paper"] {
        let printed = scene.accepts(&["config", "--preset", preset]).stdout;
        scene.write("all.toml", printed.as_bytes());
        let from_file = scene.accepts(&["track", ".", "--config", "all.toml"]).stdout;
        assert_eq!(from_file, scene.accepts(&["track", ".", "--preset", preset]).stdout);
    }
}

#[test]
fn outputs_that_cannot_be_written_are_told_before_tracking() {
    let scene = Scene::otb(2);
    scene.refuses(
        &["track", ".", "--out", "no/such/boxes.txt"],
        &["no/such/boxes.txt", "choose another path"],
    );
    scene.refuses(&["track", ".", "--out", "img"], &["img", "is a folder"]);
    scene.write("taken", b"");
    scene.refuses(&["track", ".", "--annotate", "taken"], &["taken", "choose another path"]);
    scene.refuses(&["track", ".", "--annotate", "no/such/a.mp4"], &["no/such/a.mp4", "choose another path"]);
    scene.refuses(&["track", ".", "--out", "a.mp4", "--annotate", "a.mp4"], &["--out", "--annotate"]);
}

#[test]
fn a_missing_ffmpeg_says_how_to_install_it() {
    let scene = Scene::otb(2);
    scene.write("film.mp4", b"not a film");
    let nowhere = [("INFOPART_FFMPEG", "/nowhere/ffmpeg")];
    for words in [&["track", ".", "--annotate", "a.mp4"][..], &["track", "film.mp4", "--init", BOX]] {
        let outcome = scene.run_with(words, &nowhere);
        assert_eq!(outcome.code, 2, "{}", outcome.stderr);
        assert!(outcome.stderr.contains("/nowhere/ffmpeg") && outcome.stderr.contains("apt install ffmpeg"));
    }
}

#[test]
fn a_film_that_ffmpeg_cannot_read_is_named() {
    if !common::has_ffmpeg() {
        return;
    }
    let scene = Scene::empty();
    scene.write("film.mp4", b"not a film at all");
    scene.refuses(&["track", "film.mp4", "--init", BOX], &["film.mp4", "ffmpeg"]);
}
