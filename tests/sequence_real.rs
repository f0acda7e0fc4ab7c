//! Real sequences and videos open as what they are.

mod common;

use std::{path::Path, time::Duration};

use infopart::{
    frame::PixelFormat,
    geometry::{Origin, Rect},
    sequence::{OpenOptions, Sequence, SourceFrame, open},
};

fn opened(path: &Path, options: &OpenOptions) -> Sequence {
    open(path.to_str().unwrap(), options).unwrap_or_else(|error| panic!("{error}"))
}

fn next(sequence: &mut Sequence) -> SourceFrame {
    sequence.source.next_frame().unwrap().unwrap()
}

#[test]
fn every_sequence_has_a_row_for_each_frame() {
    let Some(data) = common::data_dir() else { return };
    for (folder, target, frames) in [
        ("otb/Crossing", None, 120),
        ("otb/Walking2", None, 500),
        ("otb/David3", None, 252),
        ("otb/Jogging", Some(1), 307),
        ("otb/Jogging", Some(2), 307),
        ("otb/Couple", None, 140),
        ("otb/Deer", None, 71),
        ("otb/David", None, 471),
        ("otb/DragonBaby", None, 113),
        ("otb/FaceOcc1", None, 892),
        ("otb/Freeman1", None, 326),
        ("otb/Football1", None, 74),
        ("otb/Diving", None, 215),
        ("people/pedestrian1", None, 140),
        ("people/person11", None, 120),
        ("ships/boat1", None, 150),
    ] {
        let sequence = opened(&data.join(folder), &OpenOptions { target, ..OpenOptions::default() });
        assert_eq!(sequence.source.remaining(), Some(frames), "{folder}");
        assert_eq!(sequence.ground_truth.len(), frames, "{folder}");
        assert!(sequence.ground_truth.iter().all(Option::is_some), "{folder}");
        assert_eq!(sequence.origin, Origin::One);
        let plain_name = Path::new(folder).file_name().unwrap().to_str().unwrap();
        let name = target.map_or_else(|| plain_name.to_owned(), |target| format!("{plain_name}-{target}"));
        assert_eq!(sequence.name, name);
    }
}

#[test]
fn the_first_row_is_one_pixel_less_in_the_frame() {
    let Some(data) = common::data_dir() else { return };
    let crossing = opened(&data.join("otb/Crossing"), &OpenOptions::default());
    assert_eq!(crossing.ground_truth[0], Some(Rect::new(204.0, 150.0, 17.0, 50.0)));
}

#[test]
fn david_begins_at_file_0300_as_an_otb_folder_and_as_plain_images() {
    let Some(data) = common::data_dir() else { return };
    let mut david = opened(&data.join("otb/David"), &OpenOptions::default());
    let first = next(&mut david);
    assert_eq!((first.label.as_str(), first.number), ("0300.jpg", 1));
    let mut plain = opened(&data.join("otb/David/img"), &OpenOptions::default());
    assert_eq!(
        (plain.origin, plain.ground_truth.len(), plain.source.remaining()),
        (Origin::Zero, 0, Some(471))
    );
    assert_eq!(next(&mut plain).frame, first.frame);
    let third = OpenOptions { start: Some(3), end: Some(3), ..OpenOptions::default() };
    let mut third = opened(&data.join("otb/David"), &third);
    assert_eq!((third.ground_truth.len(), next(&mut third).label.as_str()), (1, "0302.jpg"));
    assert_eq!(third.ground_truth[0], david.ground_truth[2]);
}

#[test]
fn jogging_without_a_target_names_both() {
    let Some(data) = common::data_dir() else { return };
    let result = open(data.join("otb/Jogging").to_str().unwrap(), &OpenOptions::default());
    let message = result.map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("has 2 targets: 1, 2; choose one with --target K"), "{message}");
}

#[test]
fn every_frame_of_crossing_decodes() {
    let Some(data) = common::data_dir() else { return };
    let mut crossing = opened(&data.join("otb/Crossing"), &OpenOptions::default());
    for number in 1..=120 {
        let frame = next(&mut crossing);
        assert_eq!((frame.number, frame.label, frame.time), (number, format!("{number:04}.jpg"), None));
        assert_eq!((frame.frame.width(), frame.frame.height()), (360, 240));
        assert_eq!(frame.frame.view().format(), PixelFormat::Rgb);
    }
    assert!(crossing.source.next_frame().unwrap().is_none());
}

#[test]
fn a_video_gives_its_frames_with_their_times() {
    let Some(data) = common::data_dir() else { return };
    if !common::has_ffmpeg() {
        return;
    }
    let mut video = opened(&data.join("video/view1_vtest.avi"), &OpenOptions::default());
    assert_eq!((video.name.as_str(), video.origin), ("view1_vtest", Origin::Zero));
    for index in 0..10 {
        let frame = next(&mut video);
        assert_eq!((frame.frame.width(), frame.frame.height()), (768, 576));
        let expected = Duration::from_millis(100 * index);
        assert!(frame.time.unwrap().abs_diff(expected) < Duration::from_micros(10), "{:?}", frame.time);
    }
}

#[test]
fn a_video_has_all_its_frames_and_a_range_of_it_the_right_ones() {
    let Some(data) = common::data_dir() else { return };
    if !common::has_ffmpeg() {
        return;
    }
    let path = data.join("video/view1_vtest.avi");
    let mut video = opened(&path, &OpenOptions::default());
    let mut twentieth = None;
    let mut frames = 0;
    while let Some(frame) = video.source.next_frame().unwrap() {
        frames += 1;
        if frame.number == 20 {
            twentieth = Some(frame);
        }
    }
    assert_eq!(frames, 795);
    let range = OpenOptions { start: Some(20), end: Some(20), ..OpenOptions::default() };
    let mut part = opened(&path, &range);
    let (only, twentieth) = (next(&mut part), twentieth.unwrap());
    assert_eq!((only.number, only.time, only.frame), (20, twentieth.time, twentieth.frame));
    assert!(part.source.next_frame().unwrap().is_none());
}
