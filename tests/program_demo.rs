//! `infopart demo` as a newcomer runs it.

mod program_scene;

use std::fs;

use infopart::geometry::Rect;
use program_scene::Scene;

/// The cells of a tracker's line in the table.
fn cells(table: &str, tracker: &str) -> Vec<f64> {
    let line = table.lines().find(|line| line.starts_with(tracker)).unwrap_or_else(|| panic!("{table}"));
    line.split_whitespace().skip(1).map(|cell| cell.parse().unwrap()).collect()
}

#[test]
fn the_demo_writes_what_it_names_and_tracks_the_walker() {
    let scene = Scene::empty();
    let first = scene.accepts(&["demo", "--out", "a walk"]);
    for (tracker, least_auc) in [("infopart", 0.5), ("whole-body", 0.2)] {
        let [r1, r2, auc, speed, uncertain, lost] = cells(&first.stdout, tracker)[..] else {
            panic!("{}", first.stdout)
        };
        assert!(auc > least_auc && auc <= 0.953, "{}", first.stdout);
        assert!(r1 <= 100.0 && r2 <= 100.0 && speed > 0.0 && uncertain + lost < 150.0, "{}", first.stdout);
        let rows = scene.read(&format!("a walk/results/{tracker}.txt"));
        assert_eq!(rows.lines().count(), 150);
        let truth = scene.read("a walk/walker/groundtruth_rect.txt");
        assert!(
            rows.lines().next().unwrap().split(',').zip(truth.lines().next().unwrap().split(',')).all(
                |(row, truth)| (row.parse::<f64>().unwrap() - truth.parse::<f64>().unwrap()).abs() < 1e-9
            )
        );
    }
    let leaving = cells(&first.stdout, "leaving");
    let (auc, lost) = (leaving[2], leaving[5]);
    assert!(auc > 0.4 && lost > 10.0, "found again after it was lost: {}", first.stdout);
    let boxes = |file: &str| -> Vec<Rect> {
        let number = |text: &str| text.parse::<f64>().unwrap();
        let text = scene.read(&format!("a walk/{file}"));
        let rows = text.lines().map(|line| line.split(',').map(number).collect::<Vec<f64>>());
        rows.map(|row| Rect::new(row[0], row[1], row[2], row[3])).collect()
    };
    let (rows, truth) = (boxes("results/leaving.txt"), boxes("leaving/groundtruth_rect.txt"));
    let back = truth.iter().rposition(|full| full.x.is_nan()).unwrap() + 40;
    assert!(rows[back].overlap(&truth[back]) > 0.6, "{:?} {:?}", rows[back], truth[back]);
    let sheet = image::open(scene.path("a walk/contact_sheet.png")).unwrap();
    assert!(sheet.width() > 1000 && sheet.height() > 800);
    assert!(first.stdout.contains("a walk/contact_sheet.png"), "{}", first.stdout);
    assert!(first.stdout.contains("infopart track 'a walk/walker'"), "{}", first.stdout);

    let rows = scene.read("a walk/results/infopart.txt");
    let tracked = scene.accepts(&["track", "a walk/walker", "--seed", "1", "--quiet"]).stdout;
    assert_eq!(tracked.lines().skip(1).collect::<Vec<_>>(), rows.lines().skip(1).collect::<Vec<_>>());
    scene.accepts(&["demo", "--out", "a walk"]);
    assert_eq!(
        scene.read("a walk/results/infopart.txt"),
        rows,
        "a second demo replaces the first and is the same"
    );
}

#[test]
fn the_demo_leaves_a_folder_alone_that_is_not_its_own() {
    let scene = Scene::with_images(3);
    let before = fs::read_dir(scene.path("")).unwrap().count();
    scene.refuses(&["demo", "--out", "."], &["--out", "not made by `infopart demo`", "new folder"]);
    assert_eq!(fs::read_dir(scene.path("")).unwrap().count(), before);
    scene.write("file", b"");
    scene.refuses(&["demo", "--out", "file"], &["--out", "file", "new folder"]);
    scene.refuses(&["demo", "--out", "file/below"], &["--out", "file/below"]);
    scene.refuses(&["demo", "--seed", "99999999999999999"], &["--seed", "seed"]);
    assert!(!scene.path("infopart-demo").exists(), "nothing is written for a seed that is refused");
}
