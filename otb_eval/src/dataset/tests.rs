use std::fs;

use super::*;

fn sequence(root: &Path, name: &str, truths: &[(&str, &str)]) {
    let folder = root.join(name);
    fs::create_dir_all(folder.join("img")).unwrap();
    image::GrayImage::new(8, 6).save(folder.join("img/0001.png")).unwrap();
    for (file, rows) in truths {
        fs::write(folder.join(file), rows).unwrap();
    }
}

#[test]
fn folders_give_their_targets_as_the_rows_stand() {
    let root = tempfile::tempdir().unwrap();
    sequence(root.path(), "Walk", &[("groundtruth_rect.txt", "1,2,3,4\nNaN,NaN,NaN,NaN\n0,0,0,0\n")]);
    let two = [("groundtruth_rect.1.txt", "5 6 7 8\n"), ("groundtruth_rect.2.txt", "1\t1\t2\t2\n")];
    sequence(root.path(), "Jogging", &two);
    sequence(root.path(), "Bad", &[("groundtruth_rect.txt", "1,2,x,4\n")]);
    fs::create_dir(root.path().join("notes")).unwrap();
    let (dataset, problems) = Dataset::open(&[root.path().to_owned()]).unwrap();
    let names: Vec<&str> = dataset.targets.iter().map(|target| target.name.as_str()).collect();
    assert_eq!(names, ["Jogging-1", "Jogging-2", "Walk"]);
    let walk = dataset.target("Walk").unwrap();
    assert!(walk.truth[1].x.is_nan() && walk.truth[2].w == 0.0);
    assert_eq!(dataset.target("Jogging-2").unwrap().frames.as_ref().unwrap().target, Some(2));
    assert_eq!(problems.len(), 1);
    assert!(problems[0].to_string().starts_with("Bad: "), "{}", problems[0]);
}

#[test]
fn tiger1_starts_where_the_benchmark_starts_it() {
    let root = tempfile::tempdir().unwrap();
    let rows = |count: usize| (1..=count).map(|row| format!("{row},1,2,2\n")).collect::<String>();
    for (count, first_frame) in [(354, 6), (349, 1)] {
        sequence(root.path(), "Tiger1", &[("groundtruth_rect.txt", &rows(count))]);
        let (dataset, _) = Dataset::open(&[root.path().join("Tiger1")]).unwrap();
        let target = &dataset.targets[0];
        assert_eq!((target.truth.len(), target.truth[0].x), (349, first_frame as f64));
        assert_eq!(target.frames.as_ref().unwrap().first_frame, first_frame);
    }
}

#[test]
fn a_json_of_boxes_is_truth_without_frames() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("boxes.json");
    fs::write(
        &path,
        r#"{"B": {"gt_rect": [[1,2,3,4],[null,null,null,null]], "attr": []}, "A": {"gt_rect": []}}"#,
    )
    .unwrap();
    let (dataset, _) = Dataset::open(std::slice::from_ref(&path)).unwrap();
    assert_eq!(dataset.targets[1].truth[0], Rect::new(1.0, 2.0, 3.0, 4.0));
    assert!(dataset.targets[1].truth[1].x.is_nan() && dataset.targets[1].frames.is_none());
    for text in ["{}", "[1]", "{\"A\": {\"gt_rect\": [[1,2,3]]}}"] {
        fs::write(&path, text).unwrap();
        let message = Dataset::open(std::slice::from_ref(&path)).unwrap_err().to_string();
        assert!(message.contains("boxes.json") && message.contains("gt_rect"), "{message}");
    }
}

#[test]
fn what_is_not_there_or_twice_is_named() {
    let root = tempfile::tempdir().unwrap();
    let refused = |path: PathBuf| Dataset::open(&[path]).unwrap_err().to_string();
    assert!(refused(root.path().join("nowhere")).contains("nowhere: no such file or folder"));
    assert!(refused(root.path().to_owned()).contains("no sequence there that is laid out"));
    sequence(root.path(), "Walk", &[("groundtruth_rect.txt", "1,2,3,4\n")]);
    let (dataset, problems) = Dataset::open(&[root.path().to_owned(), root.path().join("Walk")]).unwrap();
    assert_eq!(dataset.targets.len(), 1);
    assert!(problems[0].to_string().starts_with("Walk: found twice"));
}
