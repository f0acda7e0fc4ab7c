//! `--init auto`: the target is what moves before a static camera.

use image::{Rgb, RgbImage};
use program_scene::Scene;

mod program_scene;

/// A textured room; from frame 6 on a bright block walks right, and from frame 12 on a larger one walks left below it.
fn picture(number: u32) -> RgbImage {
    let first = number.checked_sub(6).map(|walked| 10 + 2 * walked);
    let second = number.checked_sub(12).map(|walked| 130 - 4 * walked);
    RgbImage::from_fn(160, 120, |x, y| {
        let texture = ((x * 7 + y * 13) % 40) as u8;
        let inside = |left: Option<u32>, top: u32, w: u32, h: u32| {
            left.is_some_and(|left| (left..left + w).contains(&x) && (top..top + h).contains(&y))
        };
        match () {
            () if inside(first, 10, 12, 30) => Rgb([220, 200 - texture, 60]),
            () if inside(second, 60, 24, 40) => Rgb([60, 220, 200 - texture]),
            () => Rgb([texture + 40, texture + 30, texture + 50]),
        }
    })
}

fn scene(frames: u32) -> Scene {
    let scene = Scene::empty();
    std::fs::create_dir(scene.path("frames")).unwrap();
    for number in 1..=frames {
        picture(number).save(scene.path(&format!("frames/{number:04}.png"))).unwrap();
    }
    scene
}

/// The rows of a run, as numbers.
fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines().map(|row| row.split(',').map(|number| number.parse().unwrap()).collect()).collect()
}

/// The frame that the target is tracked from, as the program tells it.
fn first_frame(told: &str) -> usize {
    let (_, rest) = told.split_once("is the target from frame ").expect(told);
    rest.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn the_first_object_that_lasts_is_the_target_and_another_can_be_picked() {
    let scene = scene(40);
    let frames = scene.path("frames").display().to_string();
    for (extra, enters) in [(&[][..], 6), (&["--target", "2"][..], 12)] {
        let done = scene.run(&[&["track", &frames, "--init", "auto"], extra].concat());
        assert_eq!(done.code, 0, "{}", done.stderr);
        let frame = first_frame(&done.stderr);
        // Fifteen frames, and a few until the model tells the object from the noise.
        assert!((enters + 14..enters + 22).contains(&frame), "{}", done.stderr);
        let walked = 2.0 * (frame - enters) as f64;
        let object = if enters == 6 {
            [10.0 + walked, 10.0, 12.0, 30.0]
        } else {
            [130.0 - 2.0 * walked, 60.0, 24.0, 40.0]
        };
        let rows = rows(&done.stdout);
        assert_eq!(rows.len(), 40 - frame + 1);
        // Cleaning the mask moves an edge by a few pixels.
        let off = rows[0].iter().zip(object).map(|(found, true_value)| (found - true_value).abs());
        assert!(off.fold(0.0, f64::max) <= 4.0, "{:?} against {object:?}", rows[0]);
    }
}

#[test]
fn where_too_little_moves_that_is_told_with_what_to_do() {
    let scene = scene(25);
    let frames = scene.path("frames").display().to_string();
    let done = scene.run(&["track", &frames, "--init", "auto", "--target", "3"]);
    assert_eq!((done.code, done.stdout.as_str()), (2, ""));
    assert!(
        done.stderr.contains("only one object moves") && done.stderr.contains("smaller --target"),
        "{}",
        done.stderr
    );
    let done = scene.run(&["track", &frames, "--init", "auto", "--end", "4"]);
    assert_eq!(done.code, 2);
    assert!(
        done.stderr.contains("nothing moves") && done.stderr.contains("--init X,Y,W,H"),
        "{}",
        done.stderr
    );
}
