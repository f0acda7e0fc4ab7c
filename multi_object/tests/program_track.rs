//! `mot track` and `mot compare` on drawn frames.

use std::{collections::BTreeMap, fs, path::Path};

use image::{Rgb, RgbImage};
use infopart::geometry::Rect;
use multi_object::motchallenge::{TrackRow, read_tracks};

mod common;

/// Where the two objects are in a frame: one walks right, the other left and passes before it.
fn objects(frame: u32) -> [Rect; 2] {
    let t = f64::from(frame);
    [Rect::new(10.0 + 3.0 * t, 40.0, 20.0, 50.0), Rect::new(290.0 - 3.0 * t, 110.0, 30.0, 60.0)]
}

/// A textured room, empty in its first ten frames.
fn picture(frame: u32) -> RgbImage {
    RgbImage::from_fn(320, 200, |x, y| {
        let texture = ((x * 7 + y * 13) % 40) as u8;
        let inside =
            |area: &Rect| area.intersection_area(&Rect::new(f64::from(x), f64::from(y), 1.0, 1.0)) > 0.5;
        match objects(frame).iter().position(inside).filter(|_| frame > 10) {
            Some(0) => Rgb([230, 190 - texture, 60]),
            Some(_) => Rgb([60, 200 - texture, 230]),
            None => Rgb([texture + 50, texture + 40, texture + 60]),
        }
    })
}

fn frames(folder: &Path, count: u32) -> String {
    let images = folder.join("frames");
    fs::create_dir(&images).unwrap();
    for frame in 1..=count {
        picture(frame).save(images.join(format!("{frame:04}.png"))).unwrap();
    }
    images.display().to_string()
}

#[test]
fn two_walkers_are_two_tracks_with_every_filter_and_model() {
    let folder = tempfile::tempdir().unwrap();
    let images = frames(folder.path(), 60);
    let out = folder.path().join("tracks.txt").display().to_string();
    for (filter, motion) in [("kalman", "cv"), ("ekf", "ctrv"), ("ukf", "ctrv"), ("pf", "cv"), ("pf", "ctrv")]
    {
        let words = ["track", &images, "--filter", filter, "--motion", motion, "--out", &out];
        let (code, _, complaints) = common::mot(&words);
        assert_eq!(code, 0, "{complaints}");
        let mut by_identity: BTreeMap<u64, Vec<TrackRow>> = BTreeMap::new();
        for row in read_tracks(Path::new(&out), None).unwrap() {
            by_identity.entry(row.identity).or_default().push(row);
        }
        assert_eq!(by_identity.len(), 2, "{filter}, {motion}");
        let mut found = Vec::new();
        for rows in by_identity.values() {
            // From the eighth sight on to the end.
            assert!(rows.len() >= 40, "{filter}, {motion}: {} rows", rows.len());
            let last = rows.last().unwrap();
            // The first pixel is 1.
            let near = |object: &Rect| object.translated(1.0, 1.0).overlap(&last.box_in_file) > 0.6;
            found.push(objects(last.frame).iter().position(near));
        }
        found.sort();
        assert_eq!(found, [Some(0), Some(1)], "{filter}, {motion}");
    }
}

#[test]
fn annotated_pictures_show_boxes_and_the_same_seed_gives_the_same_tracks() {
    let folder = tempfile::tempdir().unwrap();
    let images = frames(folder.path(), 40);
    let pictures = folder.path().join("seen").display().to_string();
    let run = |seed: &str| {
        common::mot(&["track", &images, "--filter", "pf", "--seed", seed, "--annotate", &pictures])
    };
    let (code, first, complaints) = run("1");
    assert_eq!(code, 0, "{complaints}");
    assert!(complaints.contains("40 frames") && complaints.contains("frames/s"), "{complaints}");
    assert_eq!(fs::read_dir(&pictures).unwrap().count(), 40);
    let drawn = image::open(folder.path().join("seen/000040.jpg")).unwrap().to_rgb8();
    let plain = picture(40);
    let changed = drawn.pixels().zip(plain.pixels()).filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 60).count();
    assert!(changed > 200, "{changed}");
    assert_eq!(run("1").1, first);
    assert_ne!(run("2").1, first);
}

#[test]
fn an_annotated_video_is_made_where_ffmpeg_is() {
    if !common::has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let images = frames(folder.path(), 25);
    let video = folder.path().join("seen.mp4").display().to_string();
    let (code, _, complaints) = common::mot(&["track", &images, "--annotate", &video]);
    assert_eq!(code, 0, "{complaints}");
    let mut sequence = infopart::sequence::open(&video, &infopart::sequence::OpenOptions::default()).unwrap();
    let count = std::iter::from_fn(|| sequence.source.next_frame().unwrap()).count();
    assert_eq!(count, 25);
}

#[test]
fn comparing_writes_a_table_csv_and_plots() {
    let folder = tempfile::tempdir().unwrap();
    let images = frames(folder.path(), 60);
    let out = folder.path().join("comparison");
    let (code, table, complaints) = common::mot(&["compare", &images, "--out", &out.display().to_string()]);
    assert_eq!(code, 0, "{complaints}");
    let row = |section: &str, title: &str| -> String {
        let section = table.split("frames, 60 frames, ").find(|part| part.starts_with(section)).unwrap();
        let line = section.lines().find(|line| line.starts_with(title)).unwrap();
        line.split_whitespace().skip(1).take(11).collect::<Vec<_>>().join(" ")
    };
    // One linear model: three filters, the same figures.
    assert_eq!(row("cv", "KF"), row("cv", "EKF"));
    assert_eq!(row("cv", "KF"), row("cv", "UKF"));
    assert_ne!(row("cv", "KF"), row("cv", "PF"));
    assert_ne!(row("ctrv", "EKF"), row("ctrv", "UKF"));
    for name in ["frames_cv", "frames_ctrv"] {
        let csv = fs::read_to_string(out.join(format!("{name}.csv"))).unwrap();
        assert!(csv.lines().count() > 100 && csv.lines().all(|line| line.split(',').count() == 9), "{name}");
        assert!(fs::read_to_string(out.join(format!("{name}.svg"))).unwrap().contains("RMSE, pixels"));
    }
}

#[test]
fn a_model_that_is_not_linear_has_no_linear_filter_and_no_video_is_told() {
    let (code, _, complaints) = common::mot(&["track", "any.mp4", "--motion", "ctrv"]);
    assert_eq!(code, 2);
    assert!(complaints.contains("give --filter ekf, ukf or pf"), "{complaints}");
    for command in ["track", "compare"] {
        let (code, _, complaints) = common::mot(&[command, "no/such.mp4"]);
        assert_eq!(code, 2);
        assert!(
            complaints.contains("no/such.mp4") && complaints.contains("check the spelling"),
            "{complaints}"
        );
    }
}
