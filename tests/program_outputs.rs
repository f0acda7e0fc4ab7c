//! What `infopart track` writes is the same whatever the threads, and says the same in every format.

mod common;
mod program_scene;

use std::{fs, process::Command};

use image::{DynamicImage, codecs::jpeg::JpegEncoder, imageops};
use infopart::sequence::{Walker, WalkerOptions};
use program_scene::{Scene, picture};
use serde_json::Value;

const BOX: &str = "12,10,12,24";

fn numbers(row: &str) -> Vec<f64> {
    row.split(',').map(|number| number.parse().unwrap()).collect()
}

#[test]
fn threads_and_spellings_of_the_region_do_not_change_a_byte() {
    let scene = Scene::otb(6);
    let rows = |words: &[&str]| {
        scene.accepts(&[&["track", ".", "--format", "jsonl", "--seed", "4"], words].concat()).stdout
    };
    let one = rows(&["--threads", "1"]);
    assert_eq!(one, rows(&["--threads", "2"]));
    assert_eq!(one, rows(&[]));
    assert_eq!(one, rows(&["--region", "5/8"]));
    assert_eq!(one, rows(&["--region", "part"]));
    assert_ne!(one, rows(&["--region", "whole"]));
    assert_eq!(rows(&["--region", "whole"]), rows(&["--region", "1"]));
}

#[test]
fn csv_and_jsonl_say_what_otb_says_and_more() {
    let scene = Scene::otb(4);
    let rows = |format: &str, origin: &str| {
        scene.accepts(&["track", ".", "--format", format, "--origin", origin]).stdout
    };
    for origin in ["0", "1"] {
        let (otb, csv, jsonl) = (rows("otb", origin), rows("csv", origin), rows("jsonl", origin));
        let header: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
        assert_eq!(header[..5], ["frame", "x", "y", "w", "h"]);
        let lines = otb.lines().zip(csv.lines().skip(1)).zip(jsonl.lines());
        for (index, ((otb, csv), jsonl)) in lines.enumerate() {
            let cells: Vec<&str> = csv.split(',').collect();
            assert_eq!(cells.len(), header.len());
            assert_eq!(cells[1..5].join(","), otb);
            let object: Value = serde_json::from_str(jsonl).unwrap();
            for (key, cell) in header.iter().zip(&cells) {
                match &object[*key] {
                    Value::Null => assert_eq!(*cell, "", "{key}"),
                    Value::String(text) => assert_eq!(cell, text, "{key}"),
                    number => {
                        // serde_json reads the last digit of some numbers wrongly.
                        let apart = cell.parse::<f64>().unwrap() - number.as_f64().unwrap();
                        assert!(apart.abs() < 1e-12, "{key}: {cell} and {number}");
                    }
                }
            }
            assert_eq!(object["frame"], index + 1);
            let part = object["part_h"].as_f64().unwrap() / object["h"].as_f64().unwrap();
            assert!((part - 0.625).abs() < 1e-12, "{jsonl}");
        }
        assert_eq!(otb.lines().count(), 4);
    }
}

#[test]
fn summaries_name_the_tracker_by_its_region() {
    let scene = Scene::otb(2);
    for (region, name) in [("part", "infopart"), ("whole", "whole-body"), ("0.5", "infopart (0.5)")] {
        let json = scene.accepts(&["track", ".", "--region", region, "--json"]).stderr;
        assert_eq!(serde_json::from_str::<Value>(&json).unwrap()["tracker"], name);
    }
}

#[test]
fn start_and_end_cut_frames_and_ground_truth_alike() {
    let scene = Scene::otb(6);
    let outcome = scene.accepts(&["track", ".", "--start", "3", "--end", "5", "--format", "csv"]);
    let frames: Vec<&str> =
        outcome.stdout.lines().skip(1).map(|row| row.split_once(',').unwrap().0).collect();
    assert_eq!(frames, ["3", "4", "5"]);
    assert!(outcome.stdout.lines().nth(1).unwrap().starts_with("3,17,11,12,24,"), "{}", outcome.stdout);
    assert!(outcome.stderr.contains("frames     3:"), "{}", outcome.stderr);
    scene.refuses(&["track", ".", "--start", "9"], &["--start 9", "6 frames"]);
    scene.refuses(&["track", ".", "--start", "4", "--end", "2"], &["--end 2", "--start 4"]);
}

/// A JPEG whose EXIF says that it is to be turned a quarter to the right before it is shown.
fn turned_jpeg(upright: &DynamicImage) -> Vec<u8> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, 100)
        .encode_image(&DynamicImage::from(imageops::rotate270(&upright.to_rgb8())))
        .unwrap();
    let mut exif = b"Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0".to_vec();
    let length = (exif.len() as u16 + 2).to_be_bytes();
    let mut segment = vec![0xff, 0xe1, length[0], length[1]];
    segment.append(&mut exif);
    bytes.splice(2..2, segment);
    bytes
}

type Encode = fn(DynamicImage) -> Vec<u8>;

#[test]
fn turned_deep_and_transparent_images_are_tracked_as_they_are_shown() {
    let scene = Scene::empty();
    let upright = |number| DynamicImage::from(picture(number));
    let formats: [(&str, &str, Encode); 4] = [
        ("plain", "png", |image| png(&image)),
        ("turned", "jpg", |image| turned_jpeg(&image)),
        ("deep", "png", |image| png(&image.into_rgb16().into())),
        ("alpha", "png", |image| png(&image.into_rgba8().into())),
    ];
    let mut rows = Vec::new();
    for (folder, extension, encoded) in formats {
        fs::create_dir(scene.path(folder)).unwrap();
        for number in 1..=4 {
            scene.write(&format!("{folder}/{number}.{extension}"), &encoded(upright(number)));
        }
        rows.push(scene.accepts(&["track", folder, "--init", BOX]).stdout);
    }
    let [plain, turned, deep, alpha] = &rows[..] else { panic!() };
    assert_eq!((plain, plain), (deep, alpha));
    for (plain, turned) in plain.lines().zip(turned.lines()) {
        let far = numbers(plain).iter().zip(numbers(turned)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far < 5.0, "{plain} and {turned}");
    }
    let far_right = scene.accepts(&["track", "turned", "--init", "52,10,10,24"]);
    assert!(!far_right.stderr.contains("warning"), "a turned frame is 64 wide: {}", far_right.stderr);
}

fn png(image: &DynamicImage) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

#[test]
fn a_video_is_tracked_with_the_time_of_each_frame() {
    if !common::has_ffmpeg() {
        return;
    }
    let scene = Scene::empty();
    let walker = Walker::new(WalkerOptions { frames: 12, ..WalkerOptions::default() });
    walker.write_otb_folder(&scene.path("walker")).unwrap();
    let made = Command::new("ffmpeg")
        .args([
            "-loglevel",
            "error",
            "-framerate",
            "20",
            "-i",
            "walker/img/%04d.jpg",
            "-q:v",
            "2",
            "walker.avi",
        ])
        .current_dir(scene.path(""))
        .status();
    assert!(made.unwrap().success());
    let first = walker.ground_truth()[0].unwrap();
    let init = format!("{},{},{},{}", first.x, first.y, first.w, first.h);
    let words = ["track", "walker.avi", "--init", &init, "--out", "boxes.csv", "--annotate", "seen.mp4"];
    let summary = scene.accepts(&words).stderr;
    assert!(summary.contains("frames     12:"), "{summary}");
    let csv = scene.read("boxes.csv");
    let time = csv.lines().next().unwrap().split(',').position(|column| column == "time_s").unwrap();
    for (index, row) in csv.lines().skip(1).enumerate() {
        let seconds: f64 = row.split(',').nth(time).unwrap().parse().unwrap();
        assert!((seconds - index as f64 / 20.0).abs() < 1e-3, "{row}");
    }
    let last: Vec<f64> =
        csv.lines().last().unwrap().split(',').skip(1).take(4).map(|n| n.parse().unwrap()).collect();
    let last = infopart::geometry::Rect::new(last[0], last[1], last[2], last[3]);
    assert!(last.overlap(&walker.ground_truth()[11].unwrap()) > 0.5, "{last:?}");
    assert!(scene.path("seen.mp4").exists());
    let cut = scene.accepts(&["track", "walker.avi", "--init", &init, "--start", "3", "--end", "5"]);
    assert_eq!(cut.stdout.lines().count(), 3);
}
