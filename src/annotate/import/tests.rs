use std::ops::ControlFlow;

use super::*;
use crate::annotate::{
    Sides,
    export::{Format, Tracks},
    known_track,
};

fn about(frames: usize) -> VideoInfo {
    VideoInfo {
        name: "walk".into(),
        frames,
        width: 100,
        height: 80,
        labels: (1..=frames).map(|number| format!("{number:04}.jpg")).collect(),
        times: vec![None; frames],
        first_frame_hash: 0,
    }
}

type Track = Vec<Option<Annotated>>;

/// Two objects: one is drawn, moves on a curve and leaves, the other has an odd name and comes later.
fn annotated() -> (Vec<Object>, Vec<Track>) {
    let object = |name: &str, class: &str| Object {
        name: name.into(),
        class: class.into(),
        colour: Colour::of_object(0),
        keys: BTreeMap::new(),
    };
    let row = |x: f64, is_key: bool| {
        let confidence = if is_key { 1.0 } else { 0.75 };
        Some(Annotated { box_in_frame: Rect::new(x, 10.5, 20.0, 30.25), confidence, is_key })
    };
    let mut walker: Track = (0..6).map(|k| row(0.5 * f64::from(k * k), k == 0 || k == 4)).collect();
    walker.extend([None, None]);
    let mut late: Track = vec![None, None];
    late.extend((0..6).map(|k| row(3.0 * f64::from(k), k == 0)));
    (vec![object("walker", "person"), object("<b> \"x\", 'y' & z", "cat")], vec![walker, late])
}

/// The tracks that are known after an import.
fn tracks_of(imported: &[Imported], frames: usize) -> Vec<Track> {
    imported.iter().map(|(object, passes)| known_track(object, frames, Sides::Both, passes)).collect()
}

fn boxes(track: &Track) -> Vec<Option<[f64; 4]>> {
    let numbers = |found: Annotated| {
        [found.box_in_frame.x, found.box_in_frame.y, found.box_in_frame.w, found.box_in_frame.h]
    };
    track.iter().map(|found| found.map(numbers)).collect()
}

#[test]
fn what_is_exported_is_read_again_with_every_box_where_it_was() {
    let (objects, tracks) = annotated();
    let about = about(8);
    for format in [Format::Csv, Format::JsonLines, Format::Coco, Format::Cvat, Format::Mot] {
        let text = Tracks { about: &about, objects: &objects, tracks: &tracks }.text(format).unwrap();
        let imported = read("f", &text, &about).unwrap_or_else(|error| panic!("{format:?}: {error}"));
        let found = tracks_of(&imported, 8);
        assert_eq!(found.len(), 2, "{format:?}");
        for (found, expected) in found.iter().zip(&tracks) {
            assert_eq!(boxes(found), boxes(expected), "{format:?}");
        }
        if format != Format::Mot {
            let words: Vec<_> = imported.iter().map(|(object, _)| (&object.name, &object.class)).collect();
            assert_eq!(words, objects.iter().map(|object| (&object.name, &object.class)).collect::<Vec<_>>());
        }
    }
    let one = Tracks { about: &about, objects: &objects[..1], tracks: &tracks[..1] };
    let imported = read("f", &one.text(Format::Otb).unwrap(), &about).unwrap();
    assert_eq!(boxes(&tracks_of(&imported, 8)[0]), boxes(&tracks[0]));
}

#[test]
fn key_frames_are_those_of_the_file_and_absence_is_marked_where_rows_end() {
    let (objects, tracks) = annotated();
    let about = about(8);
    let text = Tracks { about: &about, objects: &objects, tracks: &tracks }.text(Format::Csv).unwrap();
    let imported = read("f.csv", &text, &about).unwrap();
    let kinds = |index: usize| -> Vec<(usize, bool)> {
        imported[index].0.keys.iter().map(|(&frame, mark)| (frame, mark.in_frame().is_some())).collect()
    };
    assert_eq!(kinds(0), [(0, true), (4, true), (6, false)]);
    assert_eq!(kinds(1), [(0, false), (2, true)]);
    // The confidence comes along, and a box that was drawn is sure.
    let track = &tracks_of(&imported, 8)[0];
    assert_eq!(track[1].unwrap().confidence, 0.75);
    assert_eq!(
        track[4].unwrap(),
        Annotated { box_in_frame: Rect::new(8.0, 10.5, 20.0, 30.25), confidence: 1.0, is_key: true }
    );
}

#[test]
fn without_key_frames_in_the_file_a_straight_walk_has_two() {
    let rows: String = (0..20).map(|k| format!("{},{},10,20\n", 1 + 2 * k, 5)).collect();
    let imported = read("straight.txt", &rows, &about(20)).unwrap();
    assert_eq!(imported[0].0.keys.keys().copied().collect::<Vec<_>>(), [0, 19]);
    assert_eq!(imported[0].0.keys[&19], Mark::Box(Rect::new(38.0, 4.0, 10.0, 20.0)));
}

#[test]
fn imported_boxes_stay_until_a_neighbour_is_corrected() {
    use crate::annotate::{Frames, Pathfinder, annotate};
    struct NoFrames;
    impl Frames for NoFrames {
        fn view(
            &mut self,
            _: usize,
        ) -> Result<crate::frame::FrameView<'_>, Box<dyn std::error::Error + Send + Sync>> {
            Err("tracked again".into())
        }
    }
    let (mut imported, about) = (
        read("f.csv", "frame,x,y,w,h,key\n1,1,1,9,9,1\n2,2,1,9,9,0\n3,3,1,9,9,0\n", &about(3)).unwrap(),
        about(3),
    );
    let (object, passes) = &mut imported[0];
    let mut tracker = || -> Box<dyn crate::tracker::Tracker> { unreachable!("nothing is to be tracked") };
    let mut watch = || ControlFlow::Continue(());
    let mut finder = Pathfinder { frames: &mut NoFrames, tracker: &mut tracker, watch: &mut watch };
    let track = annotate(object, about.frames, Sides::Both, passes, &mut finder).unwrap();
    assert_eq!(track[2].unwrap().box_in_frame.x, 3.0);
    object.keys.insert(1, Mark::Box(Rect::new(5.0, 1.0, 9.0, 9.0)));
    assert!(annotate(object, about.frames, Sides::Both, passes, &mut finder).is_err());
}

#[test]
fn what_cannot_be_read_is_named_with_its_line_and_what_to_do() {
    let message = |text: &str| read("a.x", text, &about(3)).unwrap_err().to_string();
    for (text, reason) in [
        ("", "is none of CSV"),
        ("hello", "is none of CSV"),
        ("frame,x,y,w\n1,2,3,4\n", "no column \"h\""),
        ("frame,x,y,w,h\n1,2,3,four,5\n", "line 2: \"four\" in column \"w\" is no number"),
        ("frame,x,y,w,h\n0,2,3,4,5\n", "line 2: frame 0; frames count from 1"),
        ("frame,name,x,y,w,h\n1,\"a,2,3,4,5\n", "a quote is not closed"),
        ("frame,x,y,w,h\n", "there is no box"),
        ("frame,x,y,w,h\n9,2,3,4,5\n", "frame 9, but the video has 3 frames"),
        ("frame,x,y,w,h\n1,2,3,0,5\n", "frame 1: the box 2,3,0,5 needs"),
        ("1,2,3,4\n1,2,3\n", "line 2: \"1,2,3\" is not x,y,w,h"),
        ("NaN,NaN,NaN,NaN\n", "there is no box"),
        ("0,1,2,3,4,5\n", "frames from 1"),
        ("<annotations><track", "is no whole XML"),
        ("<svg/>", "begins with <annotations>"),
        ("<annotations><image/></annotations>", "CVAT for video"),
        (
            "<annotations><track id=\"7\"><box frame=\"0\" xtl=\"a\"/></track></annotations>",
            "track 7: a box has no number as \"xtl\"",
        ),
        (
            "{\"images\": [],\n\"annotations\": [{\"image_id\": 1, \"bbox\": [1, 2, 3, 4]}]}",
            "there is no image 1",
        ),
        (
            "{\"images\": [{\"id\": 1}],\n\"annotations\": [{\"image_id\": 1, \"bbox\": [1, 2, 3, 4]}]}",
            "has no track_id",
        ),
        ("{\"frame\": 1, \"x\": 1}\n{", "line 1: missing field"),
    ] {
        let message = message(text);
        assert!(message.starts_with("a.x: ") && message.contains(reason), "{text}: {message}");
    }
}
