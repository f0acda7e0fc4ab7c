use std::{fs, path::Path};

use infopart::geometry::Rect;

use super::*;
use crate::toolkits::Toolkit;

const BOX: Rect = Rect::new(10.0, 20.0, 30.0, 40.0);

fn dataset(names: &[&str]) -> Dataset {
    let target = |name: &&str| Target {
        name: (*name).into(),
        truth: vec![BOX; 60],
        hidden: vec![],
        frames: None,
        annotations: crate::dataset::Annotations::default(),
    };
    Dataset { targets: names.iter().map(target).collect() }
}

fn put(root: &Path, name: &str, row: Rect, rows: usize) {
    let path = root.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, format!("{},{},{},{}\n", row.x, row.y, row.w, row.h).repeat(rows)).unwrap();
}

fn options(toolkit: Toolkit, protocol: Protocol) -> ScoreOptions {
    ScoreOptions {
        rules: toolkit.rules(),
        protocol,
        sequences: None,
        attributes: Some(AttributeSource::Tb100Txt),
        undo_scale: false,
        accept_lengths: false,
    }
}

fn scored(root: &Path, names: &[&str], options: &ScoreOptions) -> (Table, Vec<String>) {
    let results = Results::open(root, options.protocol).unwrap();
    let (table, problems) = score(&dataset(names), &results, options);
    (table, problems.iter().map(ScoreProblem::to_string).collect())
}

#[test]
fn sequences_and_seeds_are_averaged_and_attributes_grouped() {
    let root = tempfile::tempdir().unwrap();
    let far = BOX.translated(500.0, 0.0);
    put(root.path(), "ope/ours/seed_1/Couple.txt", BOX, 60);
    put(root.path(), "ope/ours/seed_1/Deer.txt", far, 60);
    put(root.path(), "ope/ours/seed_2/Couple.txt", far, 60);
    put(root.path(), "ope/ours/seed_2/Deer.txt", far, 60);
    let (table, problems) =
        scored(root.path(), &["Couple", "Deer", "Walking"], &options(Toolkit::Plain, Protocol::Ope));
    assert_eq!(problems, [""; 0]);
    assert_eq!(table.sequences, ["Couple", "Deer"], "Walking has no result of anybody");
    let ours = &table.trackers[0];
    let overall = ours.overall.unwrap();
    assert_eq!((overall.success_50.mean, overall.precision_20.mean), (0.25, 0.25));
    assert!((overall.success_50.deviation.unwrap() - 0.125_f64.sqrt()).abs() < 1e-12, "of 0.5 and 0");
    assert_eq!(ours.sequences[0].scores.unwrap().success_50.mean, 0.5);
    let of = |attribute| ours.attributes.iter().find(|one| one.attribute == attribute);
    let low_resolution = of(Attribute::LowResolution).unwrap();
    assert_eq!((low_resolution.sequences, low_resolution.scores.success_50.mean), (1, 0.0));
    assert_eq!(of(Attribute::BackgroundClutters).unwrap().sequences, 2);
    assert!(of(Attribute::OutOfView).is_none());
    let matlab = scored(root.path(), &["Couple", "Deer"], &options(Toolkit::Matlab, Protocol::Ope)).0;
    assert!(matlab.trackers[0].attributes.iter().all(|one| one.sequences >= 2));
}

#[test]
fn segments_are_pooled_by_their_frames() {
    let root = tempfile::tempdir().unwrap();
    let data = dataset(&["Walk"]);
    let starts = data.targets[0].starts(Protocol::Tre).unwrap();
    for (label, start) in &starts {
        let row = if *start == 0 { BOX } else { BOX.translated(500.0, 0.0) };
        put(root.path(), &format!("tre/ours/seed_1/Walk_{}.txt", label.as_ref().unwrap()), row, 60 - start);
    }
    let (table, problems) = scored(root.path(), &["Walk"], &options(Toolkit::Plain, Protocol::Tre));
    assert_eq!(problems, [""; 0]);
    let frames: usize = starts.iter().map(|(_, start)| 60 - start).sum();
    let hits: usize = starts.iter().filter(|(_, start)| *start == 0).map(|_| 60).sum();
    let found = table.trackers[0].overall.unwrap().success_50.mean;
    assert!((found - hits as f64 / frames as f64).abs() < 1e-12);
}

#[test]
fn undoing_a_scale_is_asked_for() {
    let root = tempfile::tempdir().unwrap();
    for shift in crate::protocol::SHIFTS {
        let row = match shift.name() {
            "scale_8" => Rect::new(13.0, 24.0, 24.0, 32.0),
            "scale_9" => Rect::new(11.5, 22.0, 27.0, 36.0),
            "scale_11" => Rect::new(8.5, 18.0, 33.0, 44.0),
            "scale_12" => Rect::new(7.0, 16.0, 36.0, 48.0),
            _ => BOX,
        };
        put(root.path(), &format!("sre/ours/seed_1/Walk_{}.txt", shift.name()), row, 60);
    }
    let mut options = options(Toolkit::Plain, Protocol::Sre);
    let overlap = |options: &ScoreOptions| {
        let table = scored(root.path(), &["Walk"], options).0;
        table.trackers[0].overall.unwrap().mean_overlap.mean
    };
    assert!((overlap(&options) - (8.0 + 0.64 + 0.81 + 1.0 / 1.21 + 1.0 / 1.44) / 12.0).abs() < 1e-12);
    options.undo_scale = true;
    assert!((overlap(&options) - 1.0).abs() < 1e-12);
}

#[test]
fn what_is_missing_or_fails_is_named_and_the_rest_scored() {
    let root = tempfile::tempdir().unwrap();
    put(root.path(), "A/Couple.txt", BOX, 60);
    put(root.path(), "A/Deer.txt", BOX, 58);
    put(root.path(), "B/Couple.txt", BOX, 60);
    put(root.path(), "B/Stranger.txt", BOX, 60);
    let names = ["Couple", "Deer"];
    let (table, problems) = scored(root.path(), &names, &options(Toolkit::Plain, Protocol::Ope));
    assert_eq!(problems.len(), 3, "{problems:?}");
    assert!(problems[0].starts_with("Stranger: no ground truth"), "{problems:?}");
    assert!(
        problems[1].starts_with("A, Deer: the result has 58 rows and the ground truth 60"),
        "{problems:?}"
    );
    assert!(problems[2].starts_with("B, Deer: no result (seed 0)"), "{problems:?}");
    let accepting = ScoreOptions { accept_lengths: true, ..options(Toolkit::Plain, Protocol::Ope) };
    assert_eq!(scored(root.path(), &names, &accepting).1.len(), 2);
    assert_eq!(table.trackers.iter().map(|one| one.scored).collect::<Vec<_>>(), [2, 1]);
    let (table, problems) = scored(root.path(), &names, &options(Toolkit::Pysot, Protocol::Ope));
    assert!(problems.iter().any(|text| text.contains("A, Deer: pysot would fail")), "{problems:?}");
    assert_eq!(table.trackers[0].scored, 1);
    let asked =
        ScoreOptions { sequences: Some(vec!["Ghost".into()]), ..options(Toolkit::Plain, Protocol::Ope) };
    let (table, problems) = scored(root.path(), &names, &asked);
    assert!(problems[0].starts_with("Ghost: no ground truth") && table.trackers[0].overall.is_none());
}
