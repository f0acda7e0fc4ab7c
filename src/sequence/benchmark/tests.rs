use std::fs;

use super::{
    super::{OpenOptions, open},
    *,
};

/// Writes frames `1` to `count` below a folder, whose names have so many digits.
fn frames(folder: &Path, first: usize, count: usize, digits: usize) {
    fs::create_dir_all(folder).unwrap();
    for number in first..first + count {
        image::GrayImage::new(16, 12).save(folder.join(format!("{number:0digits$}.jpg"))).unwrap();
    }
}

fn write(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
}

/// What opening a path gives: name, frames, boxes as the file counts, in the order of frames.
fn opened(path: &Path, target: Option<usize>) -> (String, usize, Vec<Option<[f64; 4]>>) {
    let options = OpenOptions { target, ..OpenOptions::default() };
    let mut sequence = open(path.to_str().unwrap(), &options).unwrap_or_else(|error| panic!("{error}"));
    let mut count = 0;
    while sequence.source.next_frame().unwrap().is_some() {
        count += 1;
    }
    let in_file = |row: Rect| {
        let row = sequence.origin.from_frame(row);
        [row.x, row.y, row.w, row.h]
    };
    (sequence.name.clone(), count, sequence.ground_truth.iter().map(|row| row.map(in_file)).collect())
}

const BOX: Option<[f64; 4]> = Some([2.0, 3.0, 4.0, 5.0]);

#[test]
fn lasots_hidden_frames_have_no_box() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("car-3");
    frames(&folder.join("img"), 1, 4, 8);
    write(&folder.join("groundtruth.txt"), &"2,3,4,5\n".repeat(4));
    write(&folder.join("full_occlusion.txt"), "0,1,0,0");
    write(&folder.join("out_of_view.txt"), "0,0,0,1\n");
    assert_eq!(opened(&folder, None), ("car-3".into(), 4, vec![BOX, None, BOX, None]));
    let found = benchmark_sequences(&folder).unwrap();
    assert_eq!((found.len(), found[0].benchmark), (1, Benchmark::Lasot));
    assert_eq!(found[0].truth(PolygonBox::MinMax).unwrap().absent, [false, true, false, true]);
    write(&folder.join("out_of_view.txt"), "0,0,1\n");
    let told = found[0].truth(PolygonBox::MinMax).unwrap_err().to_string();
    assert!(
        told.contains("out_of_view.txt")
            && told.contains("3 flags of frames, but the ground truth has 4 rows"),
        "{told}"
    );
    write(&folder.join("out_of_view.txt"), "0,0,2,0\n");
    assert!(
        found[0]
            .truth(PolygonBox::MinMax)
            .unwrap_err()
            .to_string()
            .contains("`2` is no whole number from 0 to 1")
    );
}

#[test]
fn got10ks_labels_and_test_sets_are_known() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("GOT-10k_Val_000001");
    frames(&folder, 1, 3, 8);
    write(&folder.join("groundtruth.txt"), &"2.0000,3.0000,4.0000,5.0000\n".repeat(3));
    write(&folder.join("absence.label"), "0\n1\n0\n");
    write(&folder.join("cover.label"), "8\n0\n3\n");
    write(&folder.join("meta_info.ini"), "[METAINFO]\nurl: x\nresolution: (16, 12)\n");
    assert_eq!(opened(&folder, None), ("GOT-10k_Val_000001".into(), 3, vec![BOX, None, BOX]));
    let truth = benchmark_sequences(&folder).unwrap()[0].truth(PolygonBox::MinMax).unwrap();
    assert_eq!(
        (truth.cover.as_slice(), truth.resolution, truth.first_only),
        (&[8, 0, 3][..], Some((16, 12)), false)
    );
    let test = root.path().join("GOT-10k_Test_000001");
    frames(&test, 1, 3, 8);
    write(&test.join("groundtruth.txt"), "2,3,4,5");
    assert_eq!(opened(&test, None), ("GOT-10k_Test_000001".into(), 3, vec![BOX, None, None]));
    assert!(benchmark_sequences(&test).unwrap()[0].truth(PolygonBox::MinMax).unwrap().first_only);
}

#[test]
fn vot_has_frames_beside_or_below_and_polygons() {
    let root = tempfile::tempdir().unwrap();
    let polygons = "2,3,6,3,6,8,2,8\nNaN,NaN,NaN,NaN,NaN,NaN,NaN,NaN\n2,3,6,3,6,8,2,8\n";
    let new = root.path().join("bag");
    frames(&new.join("color"), 1, 3, 8);
    write(&new.join("groundtruth.txt"), polygons);
    write(&new.join("sequence"), "[sequence]\nchannels.color=color/%08d.jpg\nfps=30\n");
    let old = root.path().join("ball");
    frames(&old, 1, 3, 8);
    write(&old.join("groundtruth.txt"), polygons);
    let plain = root.path().join("tagged");
    frames(&plain, 1, 2, 8);
    write(&plain.join("groundtruth.txt"), "2,3,4,5\n2,3,4,5\n");
    write(&plain.join("occlusion.tag"), "0\n1\n");
    for (folder, boxes) in
        [(&new, vec![BOX, None, BOX]), (&old, vec![BOX, None, BOX]), (&plain, vec![BOX, BOX])]
    {
        let (_, count, found) = opened(folder, None);
        assert_eq!((count, found), (boxes.len(), boxes));
        assert_eq!(benchmark_sequences(folder).unwrap()[0].benchmark, Benchmark::Vot, "{}", folder.display());
    }
}

#[test]
fn tld_has_corners_and_temple_color_a_range() {
    let root = tempfile::tempdir().unwrap();
    let tld = root.path().join("06_car");
    frames(&tld, 1, 2, 5);
    write(&tld.join("gt.txt"), "2,3,6,8\nNaN,NaN,NaN,NaN\n");
    write(&tld.join("init.txt"), "2,3,6,8\n");
    assert_eq!(opened(&tld, None), ("06_car".into(), 2, vec![BOX, None]));
    let temple = root.path().join("Ball_ce1");
    frames(&temple.join("img"), 1, 5, 4);
    write(&temple.join("Ball_ce1_gt.txt"), "2,3,4,5\n2,3,4,5\n2,3,4,5\n");
    write(&temple.join("Ball_ce1_frames.txt"), "2,4\n");
    let (name, count, boxes) = opened(&temple, None);
    assert_eq!((name.as_str(), count, boxes.len()), ("Ball_ce1", 3, 3));
    let found = &benchmark_sequences(&temple).unwrap()[0];
    let images = found.images().unwrap();
    assert_eq!(found.covered(&images, 3), Some(1..4));
}

#[test]
fn uav123s_parts_are_ranges_of_a_folder() {
    let root = tempfile::tempdir().unwrap();
    for (set, folder, first) in [("UAV123", "person12", 595), ("UAV123_10fps", "person12", 195)] {
        let images = root.path().join("data_seq").join(set).join(folder);
        frames(&images, first, 12, 6);
        let anno = root.path().join("anno").join(set);
        // The second part begins with frame 601, or 201 of every third.
        write(&anno.join("person12_1.txt"), &"9,9,9,9\n".repeat(3));
        write(&anno.join("person12_2.txt"), "2,3,4,5\nNaN,NaN,NaN,NaN\n2,3,4,5\n");
        let second = opened(&images, Some(2));
        assert_eq!(second, ("person12_2".into(), 3, vec![BOX, None, BOX]), "{set}");
        assert_eq!(opened(&anno.join("person12_2.txt"), None), second);
        let options = OpenOptions { target: Some(2), end: Some(1), ..OpenOptions::default() };
        let mut one = open(images.to_str().unwrap(), &options).unwrap();
        assert_eq!(one.source.next_frame().unwrap().unwrap().label, format!("{:06}.jpg", first + 6));
        let told =
            open(images.to_str().unwrap(), &OpenOptions::default()).map(|_| ()).unwrap_err().to_string();
        assert!(told.contains("has 2 targets: 1, 2; choose one with --target K"), "{told}");
    }
    frames(&root.path().join("data_seq/UAV123/bike1"), 1, 2, 6);
    write(&root.path().join("anno/UAV123/bike1.txt"), "2,3,4,5\n2,3,4,5\n");
    write(&root.path().join("anno/UAV20L/bike1.txt"), "2,3,4,5\n2,3,4,5\n");
    assert_eq!(opened(&root.path().join("data_seq/UAV123/bike1"), None).1, 2);
    assert_eq!(opened(&root.path().join("anno/UAV20L/bike1.txt"), None).0, "bike1");
}

#[test]
fn trackingnet_and_need_for_speed_keep_the_truth_apart() {
    let root = tempfile::tempdir().unwrap();
    let train = root.path().join("TRAIN_0");
    frames(&train.join("frames/abc"), 0, 3, 1);
    write(&train.join("anno/abc.txt"), &"2,3,4,5\n".repeat(3));
    frames(&root.path().join("TEST/frames/xyz"), 0, 11, 1);
    write(&root.path().join("TEST/anno/xyz.txt"), "2,3,4,5");
    assert_eq!(opened(&train.join("frames/abc"), None), ("abc".into(), 3, vec![BOX; 3]));
    let (_, count, boxes) = opened(&root.path().join("TEST/frames/xyz"), None);
    assert_eq!((count, boxes.len(), boxes[0], boxes[10]), (11, 11, BOX, None));
    let nfs = root.path().join("nfs");
    frames(&nfs.join("sequences/ball"), 1, 2, 5);
    write(&nfs.join("anno/nfs_ball.txt"), "2\t3\t4\t5\n2\t3\t4\t5\n");
    assert_eq!(opened(&nfs.join("sequences/ball"), None), ("ball".into(), 2, vec![BOX; 2]));
    assert_eq!(opened(&nfs.join("anno/nfs_ball.txt"), None).0, "ball");
    let original = root.path().join("original/ball");
    frames(&original.join("30/ball"), 1, 3, 5);
    let row = |frame: usize| format!("0 2 3 6 8 {frame} {} 0 0 \"ball\"\n", u8::from(frame == 8));
    write(&original.join("30/ball.txt"), &(0..24).map(row).collect::<String>());
    for folder in [original.clone(), original.join("30/ball")] {
        assert_eq!(opened(&folder, None), ("ball".into(), 3, vec![BOX, None, BOX]));
    }
}

#[test]
fn a_folder_of_images_beside_somebodys_results_is_only_that() {
    let root = tempfile::tempdir().unwrap();
    frames(&root.path().join("shots"), 1, 2, 4);
    write(&root.path().join("shots.txt"), "2,3,4,5\n2,3,4,5\n");
    assert_eq!(opened(&root.path().join("shots"), None), ("shots".into(), 2, vec![]));
    assert!(benchmark_sequences(&root.path().join("shots.txt")).unwrap().is_empty());
    assert!(benchmark_sequences(root.path()).unwrap().is_empty());
}
