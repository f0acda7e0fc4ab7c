//! Other data sets than OTB in tiny copies of their layouts: recognised, checked, run, scored by their own rules, packed for their
//! servers. The expected numbers are made again by scripts/data_set_goldens.py from the same formulas.

mod bench_scene;

use std::{io::Read, path::Path};

use bench_scene::Scene;
use serde_json::Value;

const SEQUENCES: [(&str, usize); 3] =
    [("GOT-10k_Val_000001", 12), ("GOT-10k_Val_000002", 30), ("GOT-10k_Val_000003", 7)];

fn truth(sequence: usize, frame: usize) -> [f64; 4] {
    let [s, k] = [sequence as f64, frame as f64];
    [20.0 + 4.0 * k + 9.0 * s, 30.0 + 2.0 * k, 40.0 + s, 30.0 + (frame % 4) as f64]
}

fn result(sequence: usize, frame: usize, repetition: usize) -> [f64; 4] {
    let [x, y, w, h] = truth(sequence, frame);
    let off = ((frame * 7 + sequence * 3 + repetition) % 11) as f64;
    let far = if frame % 9 == 8 { 60.0 } else { 0.0 };
    [x + off - 5.25 - far, y - off + 3.5, w + off % 3.0, h - off % 4.0]
}

fn cover(sequence: usize, frame: usize) -> usize {
    if frame % 6 == 5 { 0 } else { 1 + (frame + sequence) % 8 }
}

fn seconds(frame: usize, repetition: usize) -> f64 {
    0.01 + 0.001 * (frame % 5) as f64 + 0.002 * repetition as f64
}

fn row([x, y, w, h]: [f64; 4]) -> String {
    format!("{x:.4},{y:.4},{w:.4},{h:.4}\n")
}

fn rows(frames: usize, of: impl Fn(usize) -> [f64; 4]) -> String {
    (0..frames).map(|frame| row(of(frame))).collect()
}

fn images(scene: &Scene, folder: &str, numbers: impl Iterator<Item = usize>, digits: usize) {
    std::fs::create_dir_all(scene.path(folder)).unwrap();
    for number in numbers {
        let path = scene.path(folder).join(format!("{number:0digits$}.jpg"));
        image::GrayImage::new(160, 120).save(path).unwrap();
    }
}

/// The first tracker's overall scores of the JSON that `score` wrote.
fn overall(scene: &Scene) -> Value {
    let scores: Value = serde_json::from_str(&scene.read("scores.json")).unwrap();
    scores["tables"][0]["table"]["trackers"][0].clone()
}

#[track_caller]
fn is(found: &Value, expected: f64) {
    let found = found.as_f64().unwrap_or(f64::NAN);
    assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
}

fn got10k(scene: &Scene, repetitions: usize) {
    scene.write("val/list.txt", &SEQUENCES.map(|(name, _)| format!("{name}\n")).concat());
    for (place, (name, frames)) in SEQUENCES.into_iter().enumerate() {
        let folder = format!("val/{name}");
        images(scene, &folder, 1..=frames, 8);
        scene.write(&format!("{folder}/groundtruth.txt"), &rows(frames, |frame| truth(place, frame)));
        let covers: String = (0..frames).map(|frame| format!("{}\n", cover(place, frame))).collect();
        scene.write(&format!("{folder}/cover.label"), &covers);
        let absent: String =
            (0..frames).map(|frame| format!("{}\n", u8::from(cover(place, frame) == 0))).collect();
        scene.write(&format!("{folder}/absence.label"), &absent);
        scene.write(&format!("{folder}/meta_info.ini"), "[METAINFO]\nresolution: (160, 120)\n");
        for repetition in 0..repetitions {
            let tracked = format!("results/ours/{name}/{name}_{:03}.txt", repetition + 1);
            scene.write(&tracked, &rows(frames, |frame| result(place, frame, repetition)));
        }
        let line = |frame: usize| {
            let columns: Vec<String> =
                (0..repetitions).map(|repetition| format!("{:.8}", seconds(frame, repetition))).collect();
            columns.join(",") + "\n"
        };
        scene.write(
            &format!("results/ours/{name}/{name}_time.txt"),
            &(0..frames).map(line).collect::<String>(),
        );
    }
}

#[test]
fn got10k_has_the_numbers_of_its_toolkit() {
    for (repetitions, ao, sr_50, sr_75, fps) in [
        (1, 0.6688601005748964, 0.8421052631578947, 0.4473684210526316, 85.41152724826193),
        (3, 0.6612034684128272, 0.8508771929824561, 0.41228070175438597, 73.90681547344212),
    ] {
        let scene = Scene::empty();
        got10k(&scene, repetitions);
        let told = scene.accepts("score --data val --results results --json scores.json");
        assert!(told.stdout.contains("under the rules of got10k-ao"), "{}", told.stdout);
        let found = overall(&scene);
        is(&found["overall"]["mean_overlap"]["mean"], ao);
        is(&found["overall"]["success_50"]["mean"], sr_50);
        is(&found["overall"]["success_75"]["mean"], sr_75);
        let speed = found["frames_per_second"].as_f64().unwrap();
        assert!((speed / fps - 1.0).abs() < 1e-9, "{speed} instead of {fps}");
        let checked = scene.accepts("check val");
        assert!(checked.stdout.contains("rows in which nothing of the target is seen"), "{}", checked.stdout);
    }
}

#[test]
fn a_list_decides_which_sequences_count_and_what_is_missing_is_told() {
    let scene = Scene::empty();
    got10k(&scene, 1);
    scene.write("val/list.txt", "GOT-10k_Val_000003\nGOT-10k_Val_000009\n");
    let line = "score --data val --results results --sequences GOT-10k_Val_000003";
    scene.refuses(line, &["list.txt: 1 of the sequences that it names are not there: GOT-10k_Val_000009"]);
    // One level too high.
    scene.refuses("check .", &["There are some in ./val: give those"]);
}

/// LaSOT's layout with flags of hidden frames, or UAV123's with NaN rows; results in the layout of pytracking.
fn hidden(scene: &Scene, is_lasot: bool) {
    for (place, (_, frames)) in SEQUENCES.into_iter().enumerate() {
        let is_hidden = |frame: usize| frame % 6 == 5;
        let (name, prefix) =
            if is_lasot { (format!("car-{place}"), "") } else { (format!("boat{place}"), "uav_") };
        if is_lasot {
            let folder = format!("LaSOT/car/{name}");
            images(scene, &format!("{folder}/img"), 1..=frames, 8);
            scene.write(&format!("{folder}/groundtruth.txt"), &rows(frames, |frame| truth(place, frame)));
            let flags: Vec<String> =
                (0..frames).map(|frame| u8::from(is_hidden(frame)).to_string()).collect();
            scene.write(&format!("{folder}/full_occlusion.txt"), &flags.join(","));
            scene.write(&format!("{folder}/out_of_view.txt"), &vec!["0"; frames].join(","));
        } else {
            images(scene, &format!("UAV123/data_seq/UAV123/{name}"), 1..=frames, 6);
            let text =
                rows(frames, |frame| if is_hidden(frame) { [f64::NAN; 4] } else { truth(place, frame) });
            scene.write(&format!("UAV123/anno/UAV123/{name}.txt"), &text);
        }
        let text = rows(frames, |frame| result(place, frame, 0)).replace(',', "\t");
        scene.write(&format!("results/ours/{prefix}{name}.txt"), &text);
    }
}

#[test]
fn lasot_and_uav123_are_scored_as_pytracking_scores_them() {
    for (is_lasot, data, rules, precision, normalised, area) in [
        (true, "LaSOT", "lasot", 0.791269838809967, 0.6436507900555929, 0.6170868373725539),
        (false, "UAV123", "uav123", 0.950000007947286, 0.8023809591929117, 0.7758169986453712),
    ] {
        let scene = Scene::empty();
        hidden(&scene, is_lasot);
        let told = scene.accepts(&format!("score --data {data} --results results --json scores.json"));
        assert!(told.stdout.contains(&format!("under the rules of {rules} ")), "{}", told.stdout);
        let found = &overall(&scene)["overall"];
        is(&found["auc"]["mean"], 0.5889266832835144);
        is(&found["precision_20"]["mean"], precision);
        is(&found["normalised_precision_20"]["mean"], normalised);
        is(&found["normalised_precision_area"]["mean"], area);
        assert!(scene.accepts(&format!("check {data}")).stdout.contains("3 targets"));
    }
    // The GOT-10k toolkit's OTB measures on the same rows.
    let scene = Scene::empty();
    hidden(&scene, false);
    scene.accepts("convert results commas --from flat --to flat");
    scene.accepts("score --data UAV123 --results commas --toolkit got10k --json scores.json");
    let found = &overall(&scene)["overall"];
    is(&found["auc"]["mean"], 0.5889266817838247);
    is(&found["precision_20"]["mean"], 0.7912698412698412);
    scene.accepts("convert results prefixed --from flat --to pytracking --prefix uav_");
    assert!(scene.path("prefixed/ours/default/uav_boat1.txt").is_file());
}

/// A walker of eight frames in each layout; its true boxes count from 1.
fn laid_out(scene: &Scene) -> Vec<(&'static str, &'static str)> {
    use infopart::sequence::{Walker, WalkerOptions, read_boxes};
    let options = WalkerOptions { width: 96, height: 96, frames: 8, seed: 5, ..WalkerOptions::default() };
    Walker::new(options).write_otb_folder(&scene.path("otb")).unwrap();
    let boxes = read_boxes(&scene.path("otb/groundtruth_rect.txt")).unwrap();
    let pictures: Vec<_> = {
        let mut all: Vec<_> =
            std::fs::read_dir(scene.path("otb/img")).unwrap().map(|one| one.unwrap().path()).collect();
        all.sort();
        all
    };
    let frames = |folder: &str, first: usize, digits: usize| {
        std::fs::create_dir_all(scene.path(folder)).unwrap();
        for (place, picture) in pictures.iter().enumerate() {
            let name = format!(
                "{:0digits$}.{}",
                first + place,
                Path::new(picture).extension().unwrap().to_str().unwrap()
            );
            std::fs::copy(picture, scene.path(folder).join(name)).unwrap();
        }
    };
    let text = |separator: &str, less: f64| -> String {
        let line = |b: &infopart::geometry::Rect| {
            [b.x - less, b.y - less, b.w, b.h].map(|v| v.to_string()).join(separator) + "\n"
        };
        boxes.iter().map(line).collect()
    };
    let corners = |polygon: bool| -> String {
        let line = |b: &infopart::geometry::Rect| {
            let (l, t, r, d) = (b.x - 1.0, b.y - 1.0, b.x - 1.0 + b.w, b.y - 1.0 + b.h);
            if polygon { format!("{l},{t},{r},{t},{r},{d},{l},{d}\n") } else { format!("{l},{t},{r},{d}\n") }
        };
        boxes.iter().map(line).collect()
    };
    frames("lasot/car/car-1/img", 1, 8);
    scene.write("lasot/car/car-1/groundtruth.txt", &text(",", 0.0));
    scene.write("lasot/testing_set.txt", "car-1\n");
    frames("got/val/GOT-10k_Val_000001", 1, 8);
    scene.write("got/val/GOT-10k_Val_000001/groundtruth.txt", &text(",", 1.0));
    scene.write("got/val/GOT-10k_Val_000001/cover.label", &"8\n".repeat(8));
    frames("vot/bag/color", 1, 8);
    scene.write("vot/bag/groundtruth.txt", &corners(true));
    frames("tld/06_car", 1, 5);
    scene.write("tld/06_car/gt.txt", &corners(false));
    frames("tc/Ball/img", 1, 4);
    scene.write("tc/Ball/Ball_gt.txt", &text(",", 0.0));
    frames("uav/data_seq/UAV123/bird1", 775, 6);
    scene.write("uav/anno/UAV123/bird1_2.txt", &text(",", 0.0));
    frames("tn/TRAIN_0/frames/abc", 0, 1);
    scene.write("tn/TRAIN_0/anno/abc.txt", &text(",", 1.0));
    frames("nfs/sequences/ball", 1, 5);
    scene.write("nfs/anno/nfs_ball.txt", &text("\t", 1.0));
    frames("original/ball/30/ball", 1, 5);
    let tracks: String = boxes
        .iter()
        .map(|b| {
            format!("0 {} {} {} {} 1 0 0 0 \"b\"\n", b.x - 1.0, b.y - 1.0, b.x - 1.0 + b.w, b.y - 1.0 + b.h)
                .repeat(8)
        })
        .collect();
    scene.write("original/ball/30/ball.txt", &tracks);
    vec![
        ("lasot", "car-1"),
        ("got/val", "GOT-10k_Val_000001"),
        ("vot", "bag"),
        ("tld", "06_car"),
        ("tc", "Ball"),
        ("uav", "bird1_2"),
        ("tn/TRAIN_0", "abc"),
        ("nfs", "ball"),
        ("original", "ball"),
    ]
}

#[test]
fn every_data_set_is_checked_run_and_scored_alike() {
    let scene = Scene::empty();
    scene.write("fast.toml", "particles = 60\nparticle_sets = 1\n");
    let mut found = Vec::new();
    for (data, name) in laid_out(&scene) {
        let checked = scene.accepts(&format!("check {data} --decode"));
        assert!(
            checked.stdout.contains(&format!("{name}: 8 rows, 8 images 96x96")),
            "{data}: {}",
            checked.stdout
        );
        let results = format!("out/{}", data.replace('/', "_"));
        scene.accepts(&format!("run --data {data} --config fast=fast.toml --out {results}"));
        let line = format!("score --data {data} --results {results} --toolkit plain --json scores.json");
        let told = scene.accepts(&line);
        assert!(told.stdout.contains(name), "{data}: {}", told.stdout);
        found.push((data, overall(&scene)["overall"]["mean_overlap"]["mean"].as_f64().unwrap()));
        assert!(scene.path(&format!("{results}/ope/fast/seed_1/{name}_confidence.txt")).is_file());
    }
    // The same pixels and the same box give the same track, wherever the first pixel counts from.
    assert!(found[0].1 > 0.4, "{found:?}");
    assert!(found.iter().all(|(_, overlap)| (overlap - found[0].1).abs() < 1e-6), "{found:?}");
}

/// A tracker of anybody's: it answers with its first box, moved by a pixel a frame, and refuses images that are not there.
#[cfg(unix)]
const MOVING: &str = r#"
echo '@@TRAX:hello "trax.version=1" "trax.name=moving" "trax.image=path;"'
while read -r kind image region; do
    case "$kind" in *quit*) exit 0 ;; esac
    image=${image#\"file://}
    [ -s "${image%\"}" ] || { echo "no image $image" >&2; exit 4; }
    case "$kind" in
        *initialize*) box=${region#\"}; box=${box%\"}; number=0 ;;
    esac
    left=${box%%,*}
    echo "@@TRAX:state \"$((${left%%.*} + number)),${box#*,}\" \"confidence=0.$((9 - number))\""
    number=$((number + 1))
done
"#;

#[cfg(unix)]
#[test]
fn other_peoples_trackers_are_run_over_every_data_set() {
    let scene = Scene::empty();
    scene.write("moving.sh", MOVING);
    for (data, name) in laid_out(&scene) {
        let results = format!("out/{}", data.replace('/', "_"));
        let line = format!("run --data {data} --trackers-file trackers.toml --out {results}");
        scene.write("trackers.toml", "[moving]\ncommand = 'sh moving.sh'\n");
        scene.accepts(&line);
        let at = format!("{results}/ope/moving/seed_1/{name}");
        let boxes: Vec<f64> = scene
            .read(&format!("{at}.txt"))
            .lines()
            .map(|row| row.split(',').next().unwrap().parse().unwrap())
            .collect();
        assert_eq!(boxes.len(), 8, "{data}");
        assert!(boxes.windows(2).skip(1).all(|pair| pair[1] == pair[0] + 1.0), "{data}: {boxes:?}");
        let confidences = scene.read(&format!("{at}_confidence.txt"));
        assert_eq!(confidences, "0.9\n0.8\n0.7\n0.6\n0.5\n0.4\n0.3\n0.2\n", "{data}");
        scene.accepts(&format!("score --data {data} --results {results} --toolkit plain"));
    }
}

#[test]
fn frames_in_a_video_are_no_missing_images() {
    let scene = Scene::empty();
    scene.write("tld/01_david/gt.txt", "2,3,6,8\n2,3,6,8\n");
    scene.write("tld/01_david/david.mpg", "");
    let checked = scene.accepts("check tld");
    assert!(checked.stdout.contains("its frames are in a video, david.mpg"), "{}", checked.stdout);
    scene.write("results/ours/01_david.txt", "2,3,4,5\n2,3,4,5\n");
    assert!(scene.accepts("score --data tld --results results").stdout.contains("0.9524"));
}

#[test]
fn servers_get_whole_archives_or_none() {
    let scene = Scene::empty();
    for name in ["GOT-10k_Test_000001", "GOT-10k_Test_000002"] {
        images(&scene, &format!("test/{name}"), 1..=3, 8);
        scene.write(&format!("test/{name}/groundtruth.txt"), "1,2,3,4\n");
        for seed in [1, 2] {
            let at = format!("results/ope/ours/seed_{seed}/{name}");
            scene.write(&format!("{at}.txt"), &"1,2,3.25,4\n".repeat(3));
            scene.write(&format!("{at}_time.txt"), &format!("0.{seed}\n").repeat(3));
        }
    }
    let line = "submit --data test --results results --tracker ours --out ours.zip";
    let told = scene.accepts(line);
    assert!(told.stderr.contains("2 sequences, where the test set of got10k has 180"), "{}", told.stderr);
    let unpacked = |name: &str| {
        let file = std::fs::File::open(scene.path("ours.zip")).unwrap();
        let mut text = String::new();
        zip::ZipArchive::new(file).unwrap().by_name(name).unwrap().read_to_string(&mut text).unwrap();
        text
    };
    let first = "GOT-10k_Test_000001/GOT-10k_Test_000001";
    assert_eq!(unpacked(&format!("{first}_002.txt")), "1.0000,2.0000,3.2500,4.0000\n".repeat(3));
    assert_eq!(unpacked(&format!("{first}_time.txt")), "0.10000000,0.20000000\n".repeat(3));
    let bytes = std::fs::read(scene.path("ours.zip")).unwrap();
    scene.accepts(line);
    assert_eq!(bytes, std::fs::read(scene.path("ours.zip")).unwrap());
    scene.refuses(
        "score --data test --results results",
        &["only its first box is known", "`otb_eval submit`"],
    );
    scene.write("results/ope/ours/seed_2/GOT-10k_Test_000002.txt", "1,2,3,4\nNaN,2,3,4\n1,2,3,4\n");
    std::fs::remove_file(scene.path("results/ope/ours/seed_1/GOT-10k_Test_000001_time.txt")).unwrap();
    std::fs::remove_file(scene.path("ours.zip")).unwrap();
    scene.refuses(
        line,
        &["000001: the server wants the seconds", "000002: row 2 is no box", "ours.zip is not written"],
    );
    assert!(!scene.path("ours.zip").exists());
    images(&scene, "TEST/frames/abc", 0..3, 1);
    scene.write("TEST/anno/abc.txt", "1,2,3,4");
    scene.write("tn/ours/abc.txt", &"1,2,3.257,4\n".repeat(3));
    scene.accepts("submit --data TEST --results tn --tracker ours --out ours.zip");
    assert_eq!(unpacked("abc.txt"), "1.00,2.00,3.26,4.00\n".repeat(3));
    scene.write("boxes.json", "{\"A\": {\"gt_rect\": [[1,2,3,4]]}}");
    scene.refuses(
        "submit --data boxes.json --results tn --tracker ours --out x.zip",
        &["say which with --for"],
    );
}

#[test]
fn targets_that_leave_are_scored_over_thresholds_of_confidence() {
    let scene = Scene::empty();
    let folder = "lt/car";
    images(&scene, folder, 1..=5, 8);
    let here = "10,20,30,40\n";
    scene.write(&format!("{folder}/groundtruth.txt"), &format!("{here}{here}NaN,NaN,NaN,NaN\n{here}{here}"));
    scene.write(&format!("{folder}/sequence"), "channels.color=%08d.jpg\n");
    // Right, half of it, wrong where nothing is, right but unsure, and no answer.
    scene.write("results/sure/car.txt", &format!("{here}10,20,30,20\n{here}{here}NaN,NaN,NaN,NaN\n"));
    scene.write("results/sure/car_object_presence_scores.txt", "0.9\n0.8\n0.6\n0.2\n0.1\n");
    scene.write("results/plain/car.txt", &here.repeat(5));
    let told = scene.accepts("score --data lt --results results --long-term --json scores.json");
    assert!(told.stdout.contains("Long term: the best F"), "{}", told.stdout);
    let scores: Value = serde_json::from_str(&scene.read("scores.json")).unwrap();
    let of = |name: &str| {
        scores["long_term"].as_array().unwrap().iter().find(|one| one["tracker"] == name).unwrap().clone()
    };
    let (sure, plain) = (of("sure"), of("plain"));
    // At 0.2: overlaps 1, 1/2, 0, 1 of four answers, over four frames with a target.
    is(&sure["f"]["mean"], 0.625);
    is(&sure["best"]["threshold"], 0.2);
    is(&sure["curve"][2]["precision"], 0.5);
    is(&sure["curve"][2]["recall"], 0.375);
    // Four of five answers are right, and all of four frames are found.
    is(&plain["f"]["mean"], 2.0 * 0.8 / 1.8);
    let csv = scene.accepts("score --data lt --results results --long-term --format csv --table long-term");
    assert!(
        csv.stdout.starts_with("tracker,sequences,f,precision,recall,confidence\nplain,1,0.88"),
        "{}",
        csv.stdout
    );
    scene.accepts("plot --data lt --results results --out plots");
    assert!(scene.read("plots/long_term_ope.svg").contains("Precision and recall of OPE"));
    assert!(scene.read("plots/long_term_ope.csv").starts_with("tracker,x,y\nplain,"));
    scene.accepts("report --data lt --results results --no-frames --out report.html");
    assert!(scene.read("report.html").contains("Precision and recall of OPE, long term"));
    let line =
        "compare plain sure --data lt --results results --long-term --measure overlap --json compared.json";
    let told = scene.accepts(line).stdout;
    assert!(told.contains("best F") && !told.contains("AUC"), "{told}");
    let compared: Value = serde_json::from_str(&scene.read("compared.json")).unwrap();
    let measures = compared["measures"].as_array().unwrap();
    assert_eq!((&measures[0]["measure"], &measures[1]["measure"]), (&"mean_overlap".into(), &"f".into()));
    is(&measures[1]["difference"], 2.0 * 0.8 / 1.8 - 0.625);
}
