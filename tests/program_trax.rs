//! The program as a TraX server: as a client sees it.

mod program_scene;

use std::{
    io::Write,
    process::{Command, Stdio},
};

use infopart::trax::{Kind, Message};
use program_scene::{Outcome, Scene, program};

/// `infopart trax` with these words in the scene's folder, hearing these lines.
fn trax(scene: &Scene, words: &[&str], environment: &[(&str, &str)], lines: &[String]) -> Outcome {
    let mut child = Command::new(program())
        .arg("trax")
        .args(words)
        .envs(environment.iter().copied())
        .current_dir(scene.path("."))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It may have ended before it heard everything.
    let _ = child.stdin.take().unwrap().write_all((lines.join("\n") + "\n").as_bytes());
    let output = child.wait_with_output().unwrap();
    Outcome {
        code: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

fn frames(scene: &Scene, count: usize) -> Vec<String> {
    let address = |number: usize| format!("file://{}", scene.path(&format!("img/{number:04}.png")).display());
    (1..=count).map(address).collect()
}

/// The regions of the answers.
fn regions(outcome: &Outcome) -> Vec<String> {
    let messages = outcome.stdout.lines().map(|line| line.parse::<Message>().unwrap());
    messages
        .filter(|message| message.kind == Kind::State)
        .map(|mut state| state.arguments.remove(0))
        .collect()
}

fn session(scene: &Scene, count: usize) -> Vec<String> {
    let mut images = frames(scene, count).into_iter();
    let first = Message::new(Kind::Initialize).with(images.next().unwrap()).with("12,10,12,24");
    let others = images.map(|image| Message::new(Kind::Frame).with(image));
    let messages = [first].into_iter().chain(others).chain([Message::new(Kind::Quit)]);
    messages.map(|message| message.to_string()).collect()
}

#[test]
fn a_client_gets_the_boxes_that_track_writes() {
    let scene = Scene::with_images(9);
    let track =
        |seed| scene.run(&["track", "img", "--init", "12,10,12,24", "--seed", seed, "--quiet"]).stdout;
    let rows = |outcome: Outcome| {
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        regions(&outcome).iter().map(|region| format!("{region}\n")).collect::<String>()
    };
    let lines = session(&scene, 9);
    assert_eq!(rows(trax(&scene, &[], &[], &lines)), track("1"));
    assert_eq!(rows(trax(&scene, &["--threads", "2"], &[("INFOPART_SEED", "5")], &lines)), track("5"));
    assert_eq!(rows(trax(&scene, &["--seed", "3"], &[("INFOPART_SEED", "5")], &lines)), track("3"));
    assert_ne!(track("1"), track("5"), "the seed makes no difference here");
}

#[test]
fn a_client_that_asks_for_too_much_is_told_why() {
    let scene = Scene::with_images(1);
    let missing = ["@@TRAX:initialize \"file:///no/such/image.png\" \"1,2,3,4\"".to_owned()];
    let outcome = trax(&scene, &[], &[], &missing);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("/no/such/image.png"), "{}", outcome.stderr);
    assert!(outcome.stdout.contains("@@TRAX:quit \"trax.reason=/no/such/image.png"), "{}", outcome.stdout);
    let outcome = trax(&scene, &[], &[("INFOPART_SEED", "one")], &[]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""));
    assert!(outcome.stderr.contains("INFOPART_SEED is one"), "{}", outcome.stderr);
}

#[test]
fn a_client_that_goes_away_is_no_failure() {
    let scene = Scene::with_images(1);
    let outcome = trax(&scene, &[], &[], &["chatter".to_owned()]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    assert!(outcome.stdout.starts_with("@@TRAX:hello \"trax.version=4\" \"trax.name=infopart\""));
}
