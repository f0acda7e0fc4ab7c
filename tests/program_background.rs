//! `infopart background` as a whole program.

mod program_scene;

use image::Rgb;
use program_scene::Scene;

/// Frames of a camera that does not move: noise, and from frame 25 on a bright box of 12 x 10 pixels that passes.
fn static_camera(frames: usize) -> Scene {
    let scene = Scene::empty();
    for number in 1..=frames {
        let left = 4 + 12 * (number.saturating_sub(25) as u32);
        let picture = image::RgbImage::from_fn(80, 40, |x, y| {
            let inside = number >= 25 && (left..left + 12).contains(&x) && (8..18).contains(&y);
            let noise = (x * 7 + y * 3 + number as u32 * 5) % 9;
            Rgb(if inside { [250, 240, 30] } else { [(70 + noise) as u8; 3] })
        });
        picture.save(scene.path(&format!("{number:04}.png"))).unwrap();
    }
    scene
}

#[test]
fn blobs_masks_and_the_picture_show_what_moves() {
    let scene = static_camera(28);
    let words = ["background", ".", "--frame", "27", "--min-area", "50", "--closing", "3"];
    let outputs = ["--out", "seen.png", "--blobs", "blobs.csv", "--masks", "raw", "--cleaned-masks", "clean"];
    let outcome = scene.accepts(&[&words[..], &outputs[..]].concat());
    assert!(
        outcome.stderr.contains("27 frames") && outcome.stderr.contains("frames/s"),
        "{}",
        outcome.stderr
    );
    assert_eq!(
        scene.read("blobs.csv"),
        "frame,x,y,w,h,area\n25,4,8,12,10,120\n26,16,8,12,10,120\n27,28,8,12,10,120\n"
    );
    let mask = image::open(scene.path("clean/000027.png")).unwrap().into_luma8();
    let expected = |x: u32, y: u32| (28..40).contains(&x) && (8..18).contains(&y);
    assert!(mask.enumerate_pixels().all(|(x, y, value)| (value.0[0] == 255) == expected(x, y)));
    assert!(scene.path("raw/000001.png").exists() && !scene.path("raw/000028.png").exists());
    let seen = image::open(scene.path("seen.png")).unwrap().into_rgb8();
    assert_eq!(seen.dimensions(), (3 * 80 + 12, 40));
    assert_eq!(seen.get_pixel(30, 10), &Rgb([250, 240, 30]));
    assert_eq!(seen.get_pixel(86 + 30, 10), &Rgb([255; 3]));
}

#[test]
fn bad_flags_and_inputs_are_told_with_what_to_do() {
    let scene = static_camera(3);
    let run =
        |more: &[&str], needles: &[&str]| scene.refuses(&[&["background", "."], more].concat(), needles);
    run(&["--components", "20"], &["`components` is 20", "from 1 to 8"]);
    run(&["--opening", "4"], &["`opening` is 4", "give 3 or 5"]);
    run(&["--noise-sigma", "nan"], &["`noise_sigma` is NaN"]);
    run(&["--frame", "9"], &["--frame 9", "only 3 frames"]);
    run(&["--blobs", "no/such/blobs.csv"], &["--blobs", "no/such/blobs.csv"]);
    scene.refuses(&["background", "missing.mp4"], &["missing.mp4"]);
}
