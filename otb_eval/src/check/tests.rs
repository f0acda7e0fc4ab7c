use std::fs;

use infopart::geometry::Rect;

use super::*;
use crate::catalogue::Attribute;

const ROW: &str = "3,2,4,3\n";

fn sequence(root: &Path, name: &str, images: &[usize], truths: &[(&str, String)]) -> PathBuf {
    let folder = root.join(name);
    fs::create_dir_all(folder.join("img")).unwrap();
    for number in images {
        image::GrayImage::new(8, 6).save(folder.join(format!("img/{number:04}.jpg"))).unwrap();
    }
    for (file, rows) in truths {
        fs::write(folder.join(file), rows).unwrap();
    }
    folder
}

fn plain(rows: &str) -> Vec<(&'static str, String)> {
    vec![("groundtruth_rect.txt", rows.to_owned())]
}

fn checked(path: &Path) -> CheckReport {
    check(&[path.to_owned()], false, |_, _| {})
}

#[track_caller]
fn finds(report: &CheckReport, severity: Severity, needle: &str) {
    let findings: Vec<&Finding> = report.targets.iter().flat_map(|target| &target.findings).collect();
    let found = findings.iter().any(|one| one.severity == severity && one.text.contains(needle));
    assert!(found, "no {severity:?} with `{needle}` in {findings:?}");
}

#[test]
fn clean_data_of_ones_own_has_no_finding() {
    let root = tempfile::tempdir().unwrap();
    sequence(root.path(), "Walk", &[1, 2, 3], &plain(&ROW.repeat(3)));
    let report = checked(root.path());
    let walk = &report.targets[0];
    assert!(report.unreadable.is_empty() && walk.findings.is_empty(), "{:?}", walk.findings);
    assert_eq!((walk.rows, walk.written.as_deref()), (3, Some("comma, LF")));
    let images = walk.images.as_ref().unwrap();
    assert_eq!((images.count, images.size, images.last.as_deref()), (3, Some((8, 6)), Some("0003.jpg")));
}

#[test]
fn images_cut_short_of_another_size_or_missing_are_damage() {
    let root = tempfile::tempdir().unwrap();
    let folder = sequence(root.path(), "Walk", &[1, 2, 3, 4], &plain(&ROW.repeat(5)));
    let bytes = fs::read(folder.join("img/0002.jpg")).unwrap();
    fs::write(folder.join("img/0002.jpg"), &bytes[..bytes.len() / 2]).unwrap();
    fs::write(folder.join("img/0003.jpg"), b"no image").unwrap();
    image::GrayImage::new(9, 6).save(folder.join("img/0004.jpg")).unwrap();
    for decode in [false, true] {
        let report = check(&[root.path().to_owned()], decode, |_, _| {});
        finds(&report, Severity::Damage, "0002.jpg: cannot be decoded: the file is truncated");
        finds(&report, Severity::Damage, "0003.jpg: cannot be decoded: the file is no JPEG");
        finds(&report, Severity::Damage, "0004.jpg: 9x6 instead of 8x6");
        finds(&report, Severity::Damage, "5 rows but 4 images");
        assert_eq!(report.damage().count(), 4);
    }
}

#[test]
fn odd_rows_are_counted_and_named() {
    let root = tempfile::tempdir().unwrap();
    let rows = "3,2,4,3\nNaN,NaN,NaN,NaN\n0,0,0,0\n0,1,2,2\n1.5\t1\t2\t2";
    sequence(root.path(), "Walk", &[1, 2, 3, 5, 6], &plain(rows));
    let report = checked(root.path());
    assert_eq!(report.damage().count(), 0);
    finds(&report, Severity::Oddity, "1 row with NaN (the target is absent); the first is row 2");
    finds(&report, Severity::Oddity, "1 row without area");
    finds(&report, Severity::Oddity, "1 row with x or y of 0 or less");
    finds(&report, Severity::Oddity, "1 row with fractions; the first is row 5");
    finds(&report, Severity::Oddity, "jump from 3 to 5");
    finds(&report, Severity::Oddity, "mix comma and tab");
    assert_eq!(report.targets[0].written.as_deref(), Some("comma+tab, LF, last line without its end"));
    sequence(root.path(), "Absent", &[1], &plain("NaN,NaN,NaN,NaN\n"));
    finds(&checked(root.path()), Severity::Damage, "the first row is no box");
}

#[test]
fn folders_without_targets_are_damage_and_others_are_checked() {
    let root = tempfile::tempdir().unwrap();
    sequence(root.path(), "Bare", &[1], &[]);
    sequence(root.path(), "Empty", &[1], &plain(" \n"));
    sequence(root.path(), "Letters", &[1], &plain("1,2,x,4\n"));
    sequence(root.path(), "Walk", &[1], &plain(ROW));
    fs::create_dir(root.path().join("Lone")).unwrap();
    fs::write(root.path().join("Lone/groundtruth_rect.txt"), ROW).unwrap();
    fs::create_dir(root.path().join("notes")).unwrap();
    let report = checked(root.path());
    assert_eq!(report.targets.len(), 1);
    let told = report.unreadable.join("\n");
    for needle in
        ["Bare: images but no", "Empty: the ground truth is empty", "Letters: ", "Lone: ground truth but"]
    {
        assert!(told.contains(needle), "{told}");
    }
    assert_eq!(report.unreadable.len(), 4, "{told}");
    let lone = checked(&root.path().join("Lone"));
    assert_eq!(lone.unreadable.len(), 1, "{:?}", lone.unreadable);
    assert_eq!(checked(&root.path().join("nowhere")).unreadable.len(), 1);
}

#[test]
fn what_the_benchmark_is_known_for_is_no_damage() {
    let root = tempfile::tempdir().unwrap();
    let all: Vec<usize> = (1..=81).collect();
    sequence(root.path(), "Football1", &all, &plain(&ROW.repeat(74)));
    let two = ["groundtruth_rect.1.txt", "groundtruth_rect.2.txt"].map(|file| (file, ROW.repeat(307)));
    let frames: Vec<usize> = (1..=307).collect();
    sequence(root.path(), "Jogging", &frames, &two);
    let human: Vec<usize> = (1..=667).collect();
    let truths = [("groundtruth_rect.1.txt", String::new()), ("groundtruth_rect.2.txt", ROW.repeat(667))];
    sequence(root.path(), "Human4", &human, &truths);
    let tiger: Vec<usize> = (1..=354).collect();
    sequence(root.path(), "Tiger1", &tiger, &plain(&ROW.repeat(354)));
    let report = checked(root.path());
    assert_eq!(report.damage().collect::<Vec<_>>(), []);
    finds(&report, Severity::Oddity, "81 images but 74 rows: the rows are of frames 1 to 74");
    finds(&report, Severity::Oddity, "several targets: Jogging-1, Jogging-2");
    finds(&report, Severity::Oddity, "groundtruth_rect.1.txt is empty");
    finds(&report, Severity::Oddity, "Human4_2 in pytracking");
    finds(&report, Severity::Oddity, "leaves out its first 5 frames, and so are the 5 in this copy");
    let tiger = report.targets.iter().find(|target| target.name == "Tiger1").unwrap();
    assert_eq!((tiger.rows, tiger.images.as_ref().unwrap().first.as_deref()), (349, Some("0006.jpg")));
    let people = report.lists.iter().find(|list| list.list == "people8").unwrap();
    assert_eq!((people.sequences, people.missing.len()), (8, 6));
}

#[test]
fn a_sequence_with_other_rows_than_the_benchmark_is_damage_unless_its_images_were_cut_too() {
    let with = |images: &[usize], rows: usize| {
        let root = tempfile::tempdir().unwrap();
        sequence(root.path(), "Deer", images, &plain(&ROW.repeat(rows)));
        checked(root.path())
    };
    let all: Vec<usize> = (1..=72).collect();
    finds(&with(&all[..3], 2), Severity::Damage, "2 rows, but the benchmark has 71; get the sequence again");
    finds(&with(&all, 72), Severity::Damage, "72 rows, but the benchmark has 71");
    let cut = with(&all[..2], 2);
    finds(&cut, Severity::Oddity, "2 rows, but the benchmark has 71: it was cut");
    assert_eq!(cut.damage().count(), 0);
}

#[test]
fn boxes_decide_three_attributes() {
    let still = [Rect::new(10.0, 10.0, 20.0, 20.0); 3];
    let has = |truth: &[Rect]| {
        let measured = measure(truth).unwrap();
        [Attribute::ScaleVariation, Attribute::FastMotion, Attribute::LowResolution]
            .map(|attribute| measured.has(attribute).unwrap())
    };
    assert_eq!(has(&still), [false, false, false]);
    let with = |row: Rect| [still[0], row, still[0]];
    // Twice the area and a step of 20 pixels are still within bounds.
    assert_eq!(has(&with(Rect::new(5.0, 10.0, 40.0, 20.0))), [false, false, false]);
    assert_eq!(has(&with(Rect::new(10.0, 10.0, 41.0, 20.0))), [true, false, false]);
    assert_eq!(has(&with(Rect::new(10.0, 10.0, 20.0, 9.9))), [true, false, true]);
    assert_eq!(has(&with(Rect::new(30.0, 10.0, 20.0, 20.0))), [false, false, false]);
    assert_eq!(has(&with(Rect::new(30.1, 10.0, 20.0, 20.0))), [false, true, false]);
    assert_eq!(has(&with(Rect::new(10.0, 10.0, 20.0, 19.9))), [false, false, true]);
    // A jump over a frame without a box is no step.
    let jump = [still[0], Rect::new(f64::NAN, 0.0, 0.0, 0.0), Rect::new(99.0, 9.0, 20.0, 20.0)];
    assert_eq!(has(&jump), [false, false, false]);
    assert_eq!(measure(&still).unwrap().has(Attribute::Occlusion), None);
    assert!(measure(&[]).is_none());
}
