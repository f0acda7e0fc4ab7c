//! Tiny inputs for whole-program tests, and the program run on them.
#![allow(dead_code)]

use std::{
    fs,
    path::{Path, PathBuf},
};

use assert_cmd::Command;
use image::{Rgb, RgbImage};
use tempfile::TempDir;

/// A temporary folder with what a test puts there.
pub struct Scene {
    folder: TempDir,
}

/// What the program did.
pub struct Outcome {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

/// A textured 64 x 48 picture with a bright square that moves by two pixels a frame.
pub fn picture(number: usize) -> RgbImage {
    let left = 10 + 2 * number as u32;
    RgbImage::from_fn(64, 48, |x, y| {
        let texture = (x * 7 + y * 13) % 64;
        let target = (left..left + 12).contains(&x) && (10..34).contains(&y);
        let level = (if target { 150 + texture } else { texture }) as u8;
        Rgb([level, level / 2 + 20, 200 - level / 2])
    })
}

impl Scene {
    pub fn empty() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// A folder of `count` images, `img/0001.png` and so on, which makes it an OTB folder once it has ground truth.
    pub fn with_images(count: usize) -> Self {
        let scene = Self::empty();
        fs::create_dir(scene.path("img")).unwrap();
        for number in 1..=count {
            picture(number).save(scene.path(&format!("img/{number:04}.png"))).unwrap();
        }
        scene
    }

    /// An OTB folder of `count` images with the moving square's boxes.
    pub fn otb(count: usize) -> Self {
        let scene = Self::with_images(count);
        let rows: String = (1..=count).map(|number| format!("{},11,12,24\n", 11 + 2 * number)).collect();
        scene.write("groundtruth_rect.txt", rows.as_bytes());
        scene
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// `infopart` with these words, in the scene's folder.
    pub fn run(&self, words: &[&str]) -> Outcome {
        self.run_with(words, &[])
    }

    pub fn run_with(&self, words: &[&str], environment: &[(&str, &str)]) -> Outcome {
        let mut command = Command::cargo_bin("infopart").unwrap();
        let output =
            command.args(words).envs(environment.iter().copied()).current_dir(self.folder.path()).output();
        let output = output.unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Outcome {
            code: output.status.code().unwrap_or(-1),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// Runs the program, which must exit with 2, no panic, and every one of `needles` in its message.
    #[track_caller]
    pub fn refuses(&self, words: &[&str], needles: &[&str]) {
        let outcome = self.run(words);
        assert_eq!(outcome.code, 2, "{words:?}: {}", outcome.stderr);
        assert!(!outcome.stderr.contains("panicked"), "{words:?}: {}", outcome.stderr);
        for needle in needles {
            assert!(outcome.stderr.contains(needle), "{words:?}: `{needle}` is not in: {}", outcome.stderr);
        }
    }

    /// Runs the program, which must exit with 0.
    #[track_caller]
    pub fn accepts(&self, words: &[&str]) -> Outcome {
        let outcome = self.run(words);
        assert_eq!(outcome.code, 0, "{words:?}: {}", outcome.stderr);
        outcome
    }
}

/// The built program.
pub fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_infopart"))
}
