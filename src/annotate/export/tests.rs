use std::time::Duration;

use super::*;
use crate::annotate::{Colour, Mark};

fn object(name: &str, class: &str) -> Object {
    Object {
        name: name.into(),
        class: class.into(),
        colour: Colour::of_object(0),
        keys: [(0, Mark::Absent)].into(),
    }
}

fn found(x: f64, is_key: bool) -> Option<Annotated> {
    let confidence = if is_key { 1.0 } else { 0.5 };
    Some(Annotated { box_in_frame: Rect::new(x, 2.0, 10.0, 20.0), confidence, is_key })
}

/// Three frames of 100 x 50; one object that leaves, and another, with an odd name, that comes later.
fn with<T>(test: impl FnOnce(&Tracks<'_>) -> T) -> T {
    let about = VideoInfo {
        name: "a & b".into(),
        frames: 3,
        width: 100,
        height: 50,
        labels: vec!["0001.jpg".into(), "0002.jpg".into(), "frame 3".into()],
        times: vec![Some(Duration::ZERO), Some(Duration::from_millis(40)), None],
        first_frame_hash: 0,
    };
    let objects = [object("one", "person"), object("<b> \"x\", 'y' & z\u{1}", "cat")];
    let tracks =
        [vec![found(1.0, true), found(2.5, false), None], vec![None, found(95.0, true), found(95.0, false)]];
    test(&Tracks { about: &about, objects: &objects, tracks: &tracks })
}

fn text(format: Format) -> String {
    with(|tracks| tracks.text(format).unwrap())
}

#[test]
fn rows_have_every_box_by_frame_and_cells_are_quoted_where_they_must() {
    let odd = "\"<b> \"\"x\"\", 'y' & z\u{1}\"";
    assert_eq!(
        text(Format::Csv),
        format!(
            "frame,object,name,class,x,y,w,h,confidence,key,time_s\n1,1,one,person,1,2,10,20,1,1,0\n\
             2,1,one,person,2.5,2,10,20,0.5,0,0.04\n2,2,{odd},cat,95,2,10,20,1,1,0.04\n3,2,{odd},cat,95,2,10,20,0.5,0,\n"
        )
    );
    let lines: Vec<serde_json::Value> =
        text(Format::JsonLines).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 4);
    assert_eq!(
        (&lines[2]["name"], &lines[2]["x"], &lines[2]["key"]),
        (&"<b> \"x\", 'y' & z\u{1}".into(), &95.0.into(), &true.into())
    );
    assert!(lines[3]["time_s"].is_null());
}

#[test]
fn otb_and_motchallenge_count_the_first_pixel_as_1() {
    assert_eq!(text(Format::Otb), "2,3,10,20\n3.5,3,10,20\nNaN,NaN,NaN,NaN\n");
    assert_eq!(
        text(Format::Mot),
        "1,1,2,3,10,20,1,1,1\n2,1,3.5,3,10,20,1,1,1\n2,2,96,3,10,20,1,2,1\n3,2,96,3,10,20,1,2,1\n"
    );
}

#[test]
fn yolo_has_a_file_a_frame_with_fractions_of_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("labels-of-a");
    with(|tracks| tracks.write(&out, Format::Yolo)).unwrap();
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    assert_eq!(read("classes.txt"), "person\ncat\n");
    assert_eq!(read("labels/0001.txt"), "0 0.060000 0.240000 0.100000 0.400000\n");
    // Half of the second object's box lies outside.
    assert_eq!(
        read("labels/0002.txt"),
        "0 0.075000 0.240000 0.100000 0.400000\n1 0.975000 0.240000 0.050000 0.400000\n"
    );
    assert_eq!(read("labels/frame_000003.txt"), "1 0.975000 0.240000 0.050000 0.400000\n");
    let again = with(|tracks| tracks.write(&out, Format::Yolo)).unwrap_err().to_string();
    assert!(again.contains("there already") && again.contains("another path"), "{again}");
}

#[test]
fn cvat_ends_a_track_that_leaves_and_escapes_names() {
    let xml = text(Format::Cvat);
    assert!(xml.contains("<name>a &amp; b</name>") && xml.contains("<width>100</width>"));
    assert!(xml.contains("<stop_frame>2</stop_frame>"));
    let odd = "<attribute name=\"name\">&lt;b&gt; &quot;x&quot;, &apos;y&apos; &amp; z\u{fffd}</attribute>";
    assert_eq!(xml.matches(odd).count(), 2, "{xml}");
    assert!(xml.contains(
        "<box frame=\"1\" keyframe=\"1\" outside=\"0\" occluded=\"0\" xtl=\"2.50\" ytl=\"2.00\" xbr=\"12.50\" ybr=\"22.00\" z_order=\"0\">"
    ));
    assert!(xml.contains("<box frame=\"2\" keyframe=\"1\" outside=\"1\" occluded=\"0\" xtl=\"2.50\""));
    assert_eq!(xml.matches("<box").count(), 5);
}

#[test]
fn coco_numbers_images_categories_and_tracks() {
    let coco: serde_json::Value = serde_json::from_str(&text(Format::Coco)).unwrap();
    assert_eq!(coco["images"][2]["file_name"], "frame 3");
    assert_eq!(coco["categories"][1]["name"], "cat");
    let second = &coco["annotations"][2];
    assert_eq!(
        (&second["image_id"], &second["category_id"], &second["track_id"]),
        (&2.into(), &2.into(), &2.into())
    );
    assert_eq!(second["bbox"], serde_json::json!([95.0, 2.0, 10.0, 20.0]));
    assert_eq!(second["area"], 200.0);
}

#[test]
fn an_editable_track_has_a_key_frame_where_straight_lines_err_and_hardly_one_more() {
    // Still, then a bend, then straight: the bend alone is needed, and what was drawn.
    let xs: Vec<f64> = (0..30).map(|k| if k < 10 { 0.0 } else { 3.0 * f64::from(k - 10) }).collect();
    let mut track: Vec<_> = xs.iter().map(|&x| found(x, false)).collect();
    let keys = |track: &[Option<Annotated>]| -> Vec<usize> {
        editable_frames(track).iter().enumerate().filter_map(|(k, &is_key)| is_key.then_some(k)).collect()
    };
    assert_eq!(keys(&track), [0, 10, 29]);
    track[4] = found(0.0, true);
    track[20] = None;
    assert_eq!(keys(&track), [0, 4, 10, 19, 21, 29]);
    assert_eq!(keys(&[None, found(1.0, false), None]), [1]);
}

#[test]
fn extensions_tell_formats() {
    for (name, format) in [
        ("a.CSV", Format::Csv),
        ("a.jsonl", Format::JsonLines),
        ("a.xml", Format::Cvat),
        ("a.json", Format::Coco),
        ("a.txt", Format::Otb),
        ("a", Format::Otb),
    ] {
        assert_eq!(Format::from_path(Path::new(name)), format);
    }
}
