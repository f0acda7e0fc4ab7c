//! YOLO's text: `labels/NAME.txt` for each frame, a row `class x y w h` for each object in it, centre and sides as fractions of the
//! picture; `classes.txt` names the classes by line.

use std::{fmt::Write, path::Path};

use super::Tracks;

/// The files of the folder: name and text.
pub(super) fn files(tracks: &Tracks<'_>) -> Vec<(String, String)> {
    let about = tracks.about;
    let mut labels: Vec<String> = vec![String::new(); about.frames];
    for (frame, _, object, found) in tracks.boxes() {
        // What of a box lies outside the picture is not part of it here.
        let Some(inside) = found.box_in_frame.clipped_to(about.width, about.height) else { continue };
        let (x, y) = inside.centre();
        let (width, height) = (about.width as f64, about.height as f64);
        let [x, y, w, h] = [x / width, y / height, inside.w / width, inside.h / height];
        // Writing to a String does not fail.
        let _ = writeln!(labels[frame], "{} {x:.6} {y:.6} {w:.6} {h:.6}", tracks.class_of(object));
    }
    let name = |frame: usize| {
        let label = Path::new(&about.labels[frame]);
        match label.extension() {
            Some(_) => format!("labels/{}.txt", label.with_extension("").display()),
            None => format!("labels/frame_{:06}.txt", frame + 1),
        }
    };
    let one_line = |class: &&str| class.replace(['\n', '\r'], " ") + "\n";
    let classes = tracks.classes().iter().map(one_line).collect();
    let frames = labels.into_iter().enumerate().map(|(frame, text)| (name(frame), text));
    std::iter::once(("classes.txt".to_owned(), classes)).chain(frames).collect()
}
