//! A run that is stopped keeps its rows.
#![cfg(unix)]

mod program_scene;

use std::{
    fs,
    io::{BufRead, BufReader},
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use program_scene::{Scene, program};

/// Far more frames than are tracked before the test stops the program.
const MANY: usize = 20_000;

/// An OTB folder of many frames, which are all the same file.
fn long_scene() -> Scene {
    let scene = Scene::otb(1);
    for number in 2..=MANY {
        fs::hard_link(scene.path("img/0001.png"), scene.path(&format!("img/{number:05}.png"))).unwrap();
    }
    fs::rename(scene.path("img/0001.png"), scene.path("img/00001.png")).unwrap();
    scene
}

fn start(scene: &Scene, words: &[&str]) -> Child {
    let mut command = Command::new(program());
    command.args(["track", "img", "--init", "12,10,12,24"]).args(words);
    command.current_dir(scene.path(".")).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until a file has this many lines.
fn wait_for_lines(scene: &Scene, name: &str, lines: usize) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while fs::read_to_string(scene.path(name)).map_or(0, |text| text.lines().count()) < lines {
        assert!(Instant::now() < deadline, "{name} does not grow");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn ctrl_c_leaves_the_rows_and_names_the_last_good_frame() {
    let scene = long_scene();
    let child = start(&scene, &["--out", "boxes.txt"]);
    wait_for_lines(&scene, "boxes.txt.partial", 3);
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupt.success());
    let output = child.wait_with_output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{message}");
    let rows = scene.read("boxes.txt.partial");
    let done = rows.lines().count();
    assert!(done < MANY && rows.ends_with('\n'));
    assert!(message.contains("boxes.txt.partial"), "{message}");
    assert!(message.contains(&format!("frame {done} (")), "{done} rows, but: {message}");
    assert!(!scene.path("boxes.txt").exists());
}

#[test]
fn a_reader_who_has_seen_enough_ends_the_program_quietly() {
    let scene = long_scene();
    let mut child = start(&scene, &[]);
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
    assert_eq!(line, "12,10,12,24\n");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
}
