//! Frames and boxes of any size end in rows or in a message, never in a panic.

mod program_scene;

use image::{Rgb, RgbImage};
use program_scene::Scene;

const BOXES: [&str; 11] = [
    "0,0,1,1",
    "0.5,0.5,0.001,0.001",
    "-3,-3,100,100",
    "-1e3,-1e3,2e3,2e3",
    "1e8,1e8,1,1",
    "-1e3,0,1.1e3,5",
    "1e300,0,1e300,5",
    "0,0,1e-300,1e-300",
    "0,0,200,0.1",
    "0,0,0.1,200",
    "0.999999,0,1e3,1",
];

fn scene_of(width: u32, height: u32, frames: usize) -> Scene {
    let scene = Scene::empty();
    for number in 1..=frames {
        let frame = RgbImage::from_fn(width, height, |x, y| {
            Rgb([(x * 31 + y * 17 + number as u32 * 5) as u8, (x * y) as u8, (x + 3 * y) as u8])
        });
        frame.save(scene.path(&format!("{number}.png"))).unwrap();
    }
    scene
}

/// Tracked with all its rows, or refused with a remedy; nothing else.
#[track_caller]
fn ends_well(scene: &Scene, words: &[&str], frames: usize) {
    let outcome = scene.run(words);
    assert!(!outcome.stderr.contains("panicked"), "{words:?}: {}", outcome.stderr);
    match outcome.code {
        0 => {
            assert_eq!(outcome.stdout.lines().count(), frames, "{words:?}");
            assert!(!outcome.stdout.contains("NaN") && !outcome.stdout.contains("inf"), "{}", outcome.stdout);
        }
        2 => assert!(outcome.stderr.contains("give"), "{words:?}: {}", outcome.stderr),
        code => panic!("{words:?}: exit code {code}: {}", outcome.stderr),
    }
}

#[test]
fn any_box_on_frames_of_any_size() {
    for (width, height) in [(1, 1), (1, 40), (40, 1), (2, 3), (37, 53)] {
        let scene = scene_of(width, height, 3);
        for given in BOXES {
            for region in ["part", "whole", "0.01"] {
                let words =
                    ["track", ".", "--init", given, "--region", region, "--particles", "40", "--quiet"];
                ends_well(&scene, &words, 3);
            }
        }
    }
}

#[test]
fn huge_boxes_end_well() {
    let scene = scene_of(37, 53, 3);
    for given in ["-1e8,-1e8,2e8,2e8", "0,0,1e8,1e8", "-1e8,0,1.1e8,5", "0.999999,0,1e9,1"] {
        ends_well(&scene, &["track", ".", "--init", given, "--particles", "40", "--quiet"], 3);
    }
}

#[test]
fn odd_frames_are_annotated() {
    for (width, height) in [(1, 1), (1, 40), (40, 1)] {
        let scene = scene_of(width, height, 2);
        scene.accepts(&["track", ".", "--init", "0,0,1,1", "--annotate", "seen", "--quiet"]);
        assert_eq!(std::fs::read_dir(scene.path("seen")).unwrap().count(), 2);
    }
}

#[test]
fn a_single_frame_is_a_row_and_a_summary_without_speed() {
    let scene = scene_of(37, 53, 1);
    let outcome = scene.accepts(&["track", "1.png", "--init", "3,4,10,20"]);
    assert_eq!(outcome.stdout, "3,4,10,20\n");
    assert!(outcome.stderr.contains("only one frame"), "{}", outcome.stderr);
    let json = scene.accepts(&["track", "1.png", "--init", "3,4,10,20", "--json"]).stderr;
    let object: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(object["frames_per_second"].is_null());
}

#[test]
fn extreme_but_allowed_parameters_run() {
    let scene = scene_of(37, 53, 3);
    for text in [
        "particles = 1\n",
        "stumps = 1\nfeature_pool = 1\n",
        "noise_x = 10\nnoise_y = 10\nnoise_w = 1\n",
        "epsilon = 0\nhog_weight = 10000\nscore_weight = 1000\n",
        "recent_samples = 0\nupdate_interval = 1\nupdate_score = -1000\n",
        "particles = 32\nparticle_sets = 32\n",
        "first_targets = 1\nfirst_backgrounds = 1\nbackground_overlap = 0\n",
    ] {
        scene.write("my.toml", text.as_bytes());
        ends_well(&scene, &["track", "*.png", "--init", "3,4,10,20", "--config", "my.toml", "--quiet"], 3);
    }
}
