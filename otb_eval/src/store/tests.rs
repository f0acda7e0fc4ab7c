use std::fs;

use infopart::geometry::Rect;

use super::*;
use crate::{
    dataset::FrameFolder,
    protocol::{HiddenFrames, Protocol, Segment, ShiftRules},
    results::{Kept, kept},
};

fn identity(particles: u64, program: &str) -> Identity {
    let parameters = serde_json::json!({ "particles": particles, "stumps": 40 });
    Identity::new(
        "infopart",
        program.into(),
        parameters,
        Protocol::Ope,
        ShiftRules::Matlab,
        &HiddenFrames::default(),
    )
}

fn job() -> Job {
    let first_box = Rect::new(1.0, 2.5, 3.0, 4.0);
    Job {
        protocol: Protocol::Ope,
        tracker: "infopart".into(),
        seed: 2,
        sequence: "Crossing".into(),
        segment: Segment { label: None, start: 0, first_box },
        frames: 2,
        folder: FrameFolder {
            path: "otb/Crossing".into(),
            target: None,
            first_frame: 1,
            origin: infopart::geometry::Origin::One,
            ground_truth: "otb/Crossing/groundtruth_rect.txt".into(),
        },
    }
}

#[test]
fn results_stand_where_the_layout_says_with_every_digit() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::new(folder.path());
    let recording = Recording {
        rows: vec![Rect::new(1.0, 2.5, 3.0, 4.0), Rect::new(1.0 / 3.0, -7.0, 10.25, 16.0)],
        seconds: vec![0.25, 0.001_234_567_89],
        external: Some(Conversation { round_trips: vec![0.5, 0.25], lost_frames: 1 }),
        confidences: vec![1.0, 1.0 / 3.0],
        ..Recording::default()
    };
    store.keep_failure(&job(), "no luck").unwrap();
    let failure = folder.path().join("ope/infopart/seed_2/Crossing.failed.json");
    assert!(fs::read_to_string(&failure).unwrap().contains("no luck"));
    assert_eq!(kept(store.root(), &job()), Kept::Absent);
    store.keep(&job(), &recording).unwrap();
    let read = |name: &str| fs::read_to_string(folder.path().join("ope/infopart/seed_2").join(name)).unwrap();
    assert_eq!(read("Crossing.txt"), "1,2.5,3,4\n0.3333333333333333,-7,10.25,16\n");
    assert_eq!(read("Crossing_confidence.txt"), "1\n0.3333333333333333\n");
    assert_eq!(read("Crossing_time.txt"), "0.25000000\n0.00123457\n");
    let external: serde_json::Value = serde_json::from_str(&read("Crossing.external.json")).unwrap();
    let expected = serde_json::json!({
        "times": "the tracker's own", "lost_frames": 1, "round_trip_seconds": [0.5, 0.25],
    });
    assert_eq!(external, expected);
    let record: Record = serde_json::from_str(&read("Crossing.result.json")).unwrap();
    assert_eq!((record.first_row, record.rows), (Some(1), 2));
    assert!(kept(store.root(), &job()) == Kept::Whole && !failure.exists());
}

#[test]
fn what_is_not_the_result_that_was_written_is_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::new(folder.path());
    let boxes = folder.path().join("ope/infopart/seed_2/Crossing.txt");
    let whole = "1,2.5,3,4\n2,2.5,3,45\n";
    let recording = Recording {
        rows: vec![Rect::new(1.0, 2.5, 3.0, 4.0), Rect::new(2.0, 2.5, 3.0, 45.0)],
        seconds: vec![0.25, 0.5],
        ..Recording::default()
    };
    let damage = || match kept(store.root(), &job()) {
        Kept::Damaged(damage) => damage,
        kept => format!("{kept:?}"),
    };
    for is_recorded in [true, false] {
        store.keep(&job(), &recording).unwrap();
        assert_eq!(fs::read_to_string(&boxes).unwrap(), whole);
        if !is_recorded {
            // As versions before left it.
            fs::remove_file(Record::path(&boxes)).unwrap();
        }
        assert_eq!(kept(store.root(), &job()), Kept::Whole);
        for (text, needle) in [
            ("", "is empty"),
            ("\0\0\0\0", "line 1"),
            ("1,2.5,3,4\n", if is_recorded { "checksum" } else { "1 rows, not 2" }),
            ("1,2.5,3,4\n2,2.5,3,4", if is_recorded { "checksum" } else { "no end" }),
            ("1,2.5,3,4\n2,2.5,x,4\n", "line 2"),
            (
                "9,2.5,3,4\n2,2.5,3,45\n",
                if is_recorded { "checksum" } else { "the box that the tracker is given" },
            ),
        ] {
            fs::write(&boxes, text).unwrap();
            let damage = damage();
            assert!(damage.contains(needle), "{text:?}: {damage}");
        }
    }
    fs::write(&boxes, "1,2.5,3,4\n7,2.5,3,45\n").unwrap();
    assert_eq!(
        kept(store.root(), &job()),
        Kept::Whole,
        "without a record another box in a later row is not noticed"
    );
    store.keep(&job(), &recording).unwrap();
    fs::write(folder.path().join("ope/infopart/seed_2/Crossing_time.txt"), "0.25\n").unwrap();
    assert!(damage().contains("1 times, not 2"));
    store.keep(&job(), &recording).unwrap();
    fs::write(Record::path(&boxes), "{").unwrap();
    assert!(damage().contains("no record of a result"));
    let other = Job { segment: Segment { start: 1, ..job().segment }, ..job() };
    store.keep(&job(), &recording).unwrap();
    assert_eq!(kept(store.root(), &other), Kept::Damaged("its run starts on another frame".into()));
}

#[test]
fn parameters_of_many_digits_are_the_same_when_they_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::new(folder.path());
    let numbers: Vec<f64> = (1..500).map(|number| 1e3 / f64::from(number).powi(3)).collect();
    let identity = Identity::new(
        "infopart",
        "infopart 1".into(),
        serde_json::json!({ "numbers": numbers }),
        Protocol::Ope,
        ShiftRules::Matlab,
        &HiddenFrames::default(),
    );
    for _ in 0..2 {
        store.claim(&identity, &Machine::here(1, 1)).unwrap();
    }
}

#[test]
fn a_folder_belongs_to_one_set_of_parameters_and_one_version() {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::new(folder.path());
    let (here, there) = (Machine::here(2, 1), Machine::here(1, 2));
    store.claim(&identity(800, "infopart 1"), &here).unwrap();
    let path = folder.path().join("ope/infopart/run.json");
    let first = fs::read_to_string(&path).unwrap();
    store.claim(&identity(800, "infopart 1"), &there).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), first);
    let refused = |identity| store.claim(&identity, &here).unwrap_err().to_string();
    let message = refused(identity(400, "infopart 1"));
    assert!(
        message.contains("`particles` is 800 there and 400 here") && message.contains("--out"),
        "{message}"
    );
    let message = refused(identity(800, "infopart 2"));
    assert!(message.contains("infopart 1, and this is infopart 2"), "{message}");
    fs::write(&path, "{").unwrap();
    assert!(refused(identity(800, "infopart 1")).contains("run.json"));
}

#[test]
fn the_hash_is_of_the_parameters_alone() {
    let hash = |particles, program| identity(particles, program).parameters_hash;
    assert_eq!(hash(1, "a"), hash(1, "b"));
    assert_ne!(hash(1, "a"), hash(2, "a"));
    assert_eq!(hash(1, "a").len(), 64);
}
