//! `infopart track` on other inputs than files that stand still: standard input, FIFOs, devices, videos that break off; and on names
//! that look like flags.

mod common;
mod program_scene;

use std::{
    fs::{self, File},
    process::{Command, Stdio},
};

use image::ImageFormat;
use program_scene::{Scene, picture, program};

const BOX: &str = "12,10,12,24";

/// A video of 30 pictures, ten a second, made by ffmpeg in the scene's folder.
fn video(scene: &Scene, name: &str, codec: &[&str]) {
    for number in 1..=30 {
        picture(number.min(20)).save(scene.path(&format!("{number:02}.png"))).unwrap();
    }
    let made = Command::new("ffmpeg")
        .args(["-nostdin", "-loglevel", "error", "-framerate", "10", "-i", "%02d.png"])
        .args(codec)
        .arg(name)
        .current_dir(scene.path(""))
        .status();
    assert!(made.unwrap().success());
}

#[test]
fn standard_input_and_a_fifo_give_the_rows_of_the_file() {
    if !common::has_ffmpeg() {
        return;
    }
    let scene = Scene::empty();
    video(&scene, "walk.mkv", &["-c:v", "ffv1"]);
    let of_file = scene.accepts(&["track", "walk.mkv", "--init", BOX]).stdout;
    assert_eq!(of_file.lines().count(), 30);
    let track = |input: &str, stdin: Stdio| {
        let mut command = Command::new(program());
        command.args(["track", input, "--init", BOX, "--quiet"]).current_dir(scene.path("")).stdin(stdin);
        command.output().unwrap()
    };
    let piped = track("-", Stdio::from(File::open(scene.path("walk.mkv")).unwrap()));
    assert_eq!(String::from_utf8_lossy(&piped.stdout), of_file, "{}", String::from_utf8_lossy(&piped.stderr));
    if !cfg!(unix) {
        return;
    }
    assert!(Command::new("mkfifo").arg(scene.path("pipe")).status().unwrap().success());
    let mut writer =
        Command::new("sh").args(["-c", "cat walk.mkv > pipe"]).current_dir(scene.path("")).spawn().unwrap();
    let through = track("pipe", Stdio::null());
    writer.wait().unwrap();
    assert_eq!(String::from_utf8_lossy(&through.stdout), of_file);
}

#[test]
fn a_device_of_ffmpegs_is_read_live() {
    if !common::has_ffmpeg() {
        return;
    }
    let scene = Scene::empty();
    let device = "testsrc=size=96x96:rate=20:duration=1";
    let words = ["track", device, "--input-format", "lavfi", "--init", "20,20,30,30", "--format", "csv"];
    let rows = scene.accepts(&words).stdout;
    let numbers: Vec<usize> =
        rows.lines().skip(1).map(|row| row.split(',').next().unwrap().parse().unwrap()).collect();
    assert!((1..=20).contains(&numbers.len()), "{rows}");
    assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]), "{numbers:?}");
    assert!(numbers[numbers.len() - 1] >= 15, "the newest is among the last: {numbers:?}");
}

#[test]
fn a_video_that_ends_early_is_told_with_its_last_good_frame_and_its_rows_are_kept() {
    if !common::has_ffmpeg() {
        return;
    }
    for (name, codec) in [
        ("walk.mkv", &["-c:v", "ffv1", "-g", "1"][..]),
        ("walk.avi", &["-c:v", "mjpeg"]),
        ("walk.mp4", &["-c:v", "mpeg4", "-g", "1", "-movflags", "+faststart"]),
    ] {
        let scene = Scene::empty();
        video(&scene, name, codec);
        let whole = scene.accepts(&["track", name, "--init", BOX, "--out", "whole.txt"]);
        assert!(
            whole.stderr.contains("30 frames") || !whole.stderr.contains("broke off"),
            "{}",
            whole.stderr
        );
        let bytes = fs::read(scene.path(name)).unwrap();
        scene.write(name, &bytes[..bytes.len() * 6 / 10]);
        let words = ["track", name, "--init", BOX, "--out", "cut.txt"];
        scene.refuses(
            &words,
            &["the video broke off after frame", "the last good frame is", "cut.txt.partial"],
        );
        let kept = scene.read("cut.txt.partial").lines().count();
        assert!((5..30).contains(&kept), "{name}: {kept} rows");
        let known = scene.read("whole.txt");
        let kept_rows = scene.read("cut.txt.partial");
        // The last frame may be damaged, those before it are not.
        let same = kept_rows.lines().zip(known.lines()).take(kept - 2).all(|(one, other)| one == other);
        assert!(same, "{name}");
    }
}

#[test]
fn tiff_and_webp_are_frames() {
    for format in [ImageFormat::Tiff, ImageFormat::WebP] {
        let scene = Scene::empty();
        for number in 1..=4 {
            let extension = format.extensions_str()[0];
            picture(number).save_with_format(scene.path(&format!("{number}.{extension}")), format).unwrap();
        }
        let rows = scene.accepts(&["track", ".", "--init", BOX]).stdout;
        assert_eq!(rows.lines().count(), 4, "{format:?}");
    }
}

#[test]
fn names_flags_and_counts_that_cannot_be_meant_are_told() {
    let scene = Scene::otb(2);
    scene.write("-odd.mp4", b"");
    scene.refuses(
        &["track", "-odd.mp4", "--init", BOX],
        &["`-odd.mp4` is a file here: give it as ./-odd.mp4"],
    );
    scene.refuses(&["track", "--init", BOX, "--", "-none.mp4"], &["a file of that name is ./-none.mp4"]);
    scene.refuses(&["track", ".", "--threads", "100000"], &["--threads", "at most 512"]);
    scene.refuses(&["track", ".", "--live"], &["--live is for streams", "--realtime FPS"]);
    scene.refuses(&["track", "-", "--init", "auto"], &["standard input", "can be read only once"]);
    scene.refuses(&["track", "gopher://x", "--init", BOX], &["`gopher`; give one of: http, https"]);
    scene.refuses(&["track", "0", "--input-format", "a b", "--init", BOX], &["--input-format a b"]);
    scene.refuses(&["track", ".", "--live", "--stride", "2"], &["--stride"]);
}
