//! Bad inputs end in a message that names the file or flag and the remedy.

mod common;

use std::{
    fs,
    path::{Path, PathBuf},
};

use image::{Rgb, RgbImage};
use infopart::sequence::{OpenOptions, SequenceError, open};

/// A folder of JPEGs 1.jpg .. `count`.jpg, and the bytes of one.
fn jpegs(count: usize) -> (tempfile::TempDir, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let image = RgbImage::from_fn(64, 48, |x, y| Rgb([(x * 4) as u8, (y * 5) as u8, ((x ^ y) * 3) as u8]));
    for number in 1..=count {
        image.save(folder.path().join(format!("{number}.jpg"))).unwrap();
    }
    let bytes = fs::read(folder.path().join("1.jpg")).unwrap();
    (folder, bytes)
}

/// How many frames come before the error, and the error.
fn first_error(input: &Path) -> (usize, String) {
    let mut source = open(input.to_str().unwrap(), &OpenOptions::default()).unwrap().source;
    let mut good = 0;
    loop {
        match source.next_frame() {
            Ok(Some(_)) => good += 1,
            Ok(None) => panic!("no error in {good} frames"),
            Err(error) => return (good, error.to_string()),
        }
    }
}

fn opening_error(input: &Path) -> SequenceError {
    open(input.to_str().unwrap(), &OpenOptions::default()).map(|_| ()).unwrap_err()
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn a_truncated_jpeg_in_the_middle_names_its_file() {
    let (folder, bytes) = jpegs(4);
    let path = written(folder.path(), "3.jpg", &bytes[..bytes.len() * 2 / 3]);
    let (good, message) = first_error(folder.path());
    assert_eq!(good, 2);
    assert!(
        message.starts_with(&format!("{}: cannot be decoded: the file is truncated", path.display())),
        "{message}"
    );
}

#[test]
fn text_named_jpg_is_no_image() {
    let (folder, _) = jpegs(2);
    written(folder.path(), "2.jpg", b"this is not an image\n");
    let (good, message) = first_error(folder.path());
    assert_eq!(good, 1);
    assert!(
        message
            .contains("2.jpg: cannot be decoded: the file is no JPEG, PNG, BMP, TIFF or WebP image; replace"),
        "{message}"
    );
}

#[test]
fn a_png_named_jpg_is_read_as_what_it_is() {
    let folder = tempfile::tempdir().unwrap();
    RgbImage::new(5, 4).save(folder.path().join("a.png")).unwrap();
    fs::rename(folder.path().join("a.png"), folder.path().join("a.jpg")).unwrap();
    let mut sequence = open(folder.path().to_str().unwrap(), &OpenOptions::default()).unwrap();
    assert_eq!(sequence.source.next_frame().unwrap().unwrap().frame.width(), 5);
}

#[test]
fn a_frame_of_another_size_names_both_sizes() {
    let (folder, _) = jpegs(2);
    RgbImage::new(32, 48).save(folder.path().join("3.png")).unwrap();
    let (good, message) = first_error(folder.path());
    assert_eq!(good, 2);
    assert!(message.contains("3.png: this frame is 32x48 but the first is 64x48; resize it"), "{message}");
}

#[test]
fn a_portrait_taken_by_a_turned_camera_is_upright() {
    let (folder, bytes) = jpegs(1);
    let exif = b"Exif\0\0II\x2a\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x08\0\0\0\0\0\0\0";
    let length = (exif.len() as u16 + 2).to_be_bytes();
    let turned = [&bytes[..2], &[0xFF, 0xE1], &length, exif, &bytes[2..]].concat();
    let path = written(folder.path(), "turned.jpg", &turned);
    let upright =
        open(path.to_str().unwrap(), &OpenOptions::default()).unwrap().source.next_frame().unwrap().unwrap();
    let stored = folder.path().join("1.jpg");
    let stored = open(stored.to_str().unwrap(), &OpenOptions::default())
        .unwrap()
        .source
        .next_frame()
        .unwrap()
        .unwrap();
    assert_eq!((upright.frame.width(), upright.frame.height()), (48, 64));
    // Orientation 8: a quarter turn anticlockwise, so the stored top right corner becomes the top left.
    assert_eq!(upright.frame.view().row(0)[..3], stored.frame.view().row(0)[63 * 3..]);
}

#[test]
fn broken_ground_truth_names_file_and_line() {
    for (row, problem) in [("1,2,x,4", "not a number"), ("1,2,3", "3 numbers instead of 4")] {
        let (folder, bytes) = jpegs(1);
        fs::create_dir(folder.path().join("img")).unwrap();
        written(&folder.path().join("img"), "0001.jpg", &bytes);
        let path = written(folder.path(), "groundtruth_rect.txt", format!("1,2,3,4\r\n{row}\r\n").as_bytes());
        let message = opening_error(folder.path()).to_string();
        assert!(message.starts_with(&format!("{}, line 2: `{row}`", path.display())), "{message}");
        assert!(message.contains(problem) && message.contains("write x,y,w,h there"), "{message}");
    }
}

#[test]
fn an_otb_folder_without_images_names_img() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("img")).unwrap();
    written(folder.path(), "groundtruth_rect.txt", b"1,2,3,4");
    let error = opening_error(folder.path());
    let SequenceError::NoImages { path } = &error else { panic!("{error}") };
    assert_eq!(path, &folder.path().join("img"));
}

#[test]
fn what_is_no_video_gives_ffmpegs_message() {
    if !common::has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in [("a.mp4", &b"not a video at all"[..]), ("empty.avi", b"")] {
        let path = written(folder.path(), name, bytes);
        let error = opening_error(&path);
        assert!(matches!(&error, SequenceError::BadVideo { .. }), "{error}");
        let message = error.to_string();
        assert!(
            message.starts_with(&format!("{}: ffmpeg finds no video in it: ", path.display())),
            "{message}"
        );
        assert!(message.contains("Invalid data found when processing input"), "{message}");
    }
}

#[test]
fn a_long_text_is_no_video_though_ffmpeg_would_draw_it() {
    if !common::has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = written(folder.path(), "boxes.txt", "1,2,3,4 is a line of text\n".repeat(500).as_bytes());
    let message = opening_error(&path).to_string();
    assert!(message.contains("boxes.txt: ffmpeg finds no video in it: the file is text; give"), "{message}");
}

#[test]
fn sound_alone_is_no_video() {
    if !common::has_ffmpeg() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    // Two samples of silence in a WAV file.
    let mut wav =
        b"RIFF\x28\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x40\x1f\0\0\x80\x3e\0\0\x02\0\x10\0data\x04\0\0\0"
            .to_vec();
    wav.extend_from_slice(&[0; 4]);
    let message = opening_error(&written(folder.path(), "sound.wav", &wav)).to_string();
    assert!(message.contains("sound.wav: ffmpeg finds no video in it: Stream map"), "{message}");
}
