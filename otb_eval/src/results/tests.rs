use std::fs;

use infopart::geometry::Rect;

use super::*;

fn put(root: &Path, name: &str, text: &str) {
    let path = root.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

#[test]
fn the_layout_of_run_has_protocols_trackers_and_seeds() {
    let root = tempfile::tempdir().unwrap();
    for (seed, x) in [(10, 3), (2, 1)] {
        put(root.path(), &format!("ope/ours/seed_{seed}/Walk.txt"), &format!("{x},2,3,4\n"));
        put(root.path(), &format!("ope/ours/seed_{seed}/Walk_time.txt"), "0.5\n0.25\n");
    }
    put(root.path(), "tre/ours/seed_1/Walk_02.txt", "1,2,3,4\n");
    put(root.path(), "ope/ours/seed_2/Run.failed.json", r#"{"job": "x", "reason": "no luck"}"#);
    assert_eq!(Results::protocols(root.path()).unwrap(), [Protocol::Ope, Protocol::Tre]);
    let results = Results::open(root.path(), Protocol::Ope).unwrap();
    let seeds = &results.trackers[0].seeds;
    assert_eq!(seeds.iter().map(|seed| seed.seed).collect::<Vec<_>>(), [2, 10]);
    assert_eq!(seeds[1].read("Walk", None).unwrap().unwrap().rows, [Rect::new(3.0, 2.0, 3.0, 4.0)]);
    assert_eq!(seeds[0].read_seconds("Walk", None).unwrap().unwrap(), [0.5, 0.25]);
    assert_eq!(seeds[0].stems().collect::<Vec<_>>(), ["Walk"]);
    assert_eq!(seeds[0].failures().collect::<Vec<_>>(), [("Run", "no luck")]);
    let tre = Results::open(root.path(), Protocol::Tre).unwrap();
    assert!(tre.trackers[0].seeds[0].read("Walk", Some("02")).is_some());
    let message = Results::open(root.path(), Protocol::Sre).unwrap_err().to_string();
    assert!(message.contains("no results of sre") && message.contains("ope, tre"), "{message}");
}

#[test]
fn flat_folders_are_trackers_in_any_spelling() {
    let root = tempfile::tempdir().unwrap();
    put(root.path(), "KCF/Jogging_1.txt", "1\t2\t3\t4\n");
    put(root.path(), "KCF/Jogging_1_time.txt", "1\n");
    put(root.path(), "ATOM/carDark.txt", "1 2 3 4\n");
    put(root.path(), "notes/readme.md", "");
    let results = Results::open(root.path(), Protocol::Ope).unwrap();
    let names: Vec<&str> = results.trackers.iter().map(|tracker| tracker.name.as_str()).collect();
    assert_eq!(names, ["ATOM", "KCF"]);
    let file = results.trackers[1].seeds[0].read("Jogging-1", None).unwrap().unwrap();
    assert_eq!(file.separators, Separators { tab: true, ..Separators::default() });
    assert!(results.trackers[0].seeds[0].read("CarDark", None).unwrap().unwrap().separators.space);
    let one = Results::open(&root.path().join("KCF"), Protocol::Ope).unwrap();
    assert_eq!((one.trackers[0].name.as_str(), one.trackers[0].seeds[0].seed), ("KCF", 0));
    let message = results.only(&["MOSSE".into()]).unwrap_err().to_string();
    assert!(message.contains("`MOSSE`") && message.contains("ATOM, KCF"), "{message}");
}

#[test]
fn what_cannot_be_read_is_named_with_its_line() {
    let root = tempfile::tempdir().unwrap();
    put(root.path(), "T/Empty.txt", "\n");
    put(root.path(), "T/Letters.txt", "1,2,3,4\n1,b,3,4\n");
    put(root.path(), "T/Wrong.txt", "1/2/3/4\n");
    put(root.path(), "T/Short.txt", "1,2,3\n");
    put(root.path(), "T/Good.txt", "1,2,3,4\n");
    put(root.path(), "T/Good_time.txt", "0.5\nfast\n");
    let results = Results::open(root.path(), Protocol::Ope).unwrap();
    let seed = &results.trackers[0].seeds[0];
    let message = |name| seed.read(name, None).unwrap().unwrap_err().to_string();
    assert!(message("Empty").contains("Empty.txt: the file is empty"));
    assert!(message("Letters").contains("Letters.txt, line 2"));
    assert!(message("Wrong").contains("Wrong.txt, line 1"));
    assert!(message("Short").contains("3 numbers"));
    let time = seed.read_seconds("Good", None).unwrap().unwrap_err().to_string();
    assert!(time.contains("Good_time.txt, line 2: `fast`"), "{time}");
    assert!(seed.read("Nowhere", None).is_none());
    assert!(Results::open(&root.path().join("x"), Protocol::Ope).is_err());
    fs::create_dir(root.path().join("bare")).unwrap();
    let bare = Results::open(&root.path().join("bare"), Protocol::Ope).unwrap_err().to_string();
    assert!(bare.contains("no results there") && !bare.contains("give that folder"), "{bare}");
}

#[test]
fn a_folder_one_level_too_high_or_too_low_is_recognised() {
    let root = tempfile::tempdir().unwrap();
    put(root.path(), "OTB2015/KCF/Couple.txt", "1,2,3,4\n");
    put(root.path(), "runs/tre/ours/seed_1/Couple_01.txt", "1,2,3,4\n");
    put(root.path(), "data/Couple/groundtruth_rect.txt", "1,2,3,4\n");
    let high = Results::open(root.path(), Protocol::Ope).unwrap_err().to_string();
    assert!(
        high.contains("OTB2015") && high.contains("runs: give that folder") && !high.contains("data,"),
        "{high}"
    );
    let low = root.path().join("runs/tre");
    assert_eq!(Results::protocols(&low).unwrap(), [Protocol::Tre]);
    assert_eq!(Results::open(&low, Protocol::Tre).unwrap().trackers[0].name, "ours");
    put(root.path(), "runs/KCF/Couple.txt", "1,2,3,4\n");
    put(root.path(), "runs/plots/success.svg", "");
    assert_eq!(Results::ignored(&root.path().join("runs")).unwrap(), ["KCF"]);
    assert!(Results::ignored(&root.path().join("OTB2015")).unwrap().is_empty());
}
