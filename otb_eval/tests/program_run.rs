//! `otb_eval run`: killed, split, repeated, and on data that is broken.

mod bench_scene;

use std::{
    fs,
    process::Stdio,
    thread,
    time::{Duration, Instant},
};

use bench_scene::Scene;

const RUN: &str = "run --data data --config fast=fast.toml --seeds 3 --jobs 1";

fn results(scene: &Scene, out: &str) -> usize {
    let is_result = |name: &&String| name.ends_with(".txt");
    scene.reproducible_so_far(out).iter().filter(is_result).count()
}

impl Scene {
    /// The names alone, which may be looked at while a run writes.
    fn reproducible_so_far(&self, folder: &str) -> Vec<String> {
        let mut files = std::collections::BTreeMap::new();
        bench_scene::collect(&self.path(folder), &self.path(folder), &mut files);
        files.into_keys().filter(|name| !name.ends_with("_time.txt")).collect()
    }
}

#[test]
fn a_killed_run_goes_on_to_the_bytes_of_an_undisturbed_one() {
    let scene = Scene::with_walkers();
    scene.accepts(&format!("{RUN} --out whole"));
    let expected = scene.reproducible("whole");
    assert_eq!(expected.len(), 3 * 3 + 1, "three sequences, three seeds, run.json: {:?}", expected.keys());
    for least in [1, 4] {
        let out = format!("killed_{least}");
        let mut child = scene.command(&format!("{RUN} --out {out}")).stderr(Stdio::null()).spawn().unwrap();
        let deadline = Instant::now() + Duration::from_secs(120);
        while results(&scene, &out) < least && Instant::now() < deadline {
            thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let there = results(&scene, &out);
        assert!((least..9).contains(&there), "killed after {there} of 9 results");
        let outcome = scene.accepts(&format!("{RUN} --out {out}"));
        assert!(outcome.stderr.contains(&format!("9 jobs: {there} were there")), "{}", outcome.stderr);
        assert!(scene.reproducible(&out) == expected, "other bytes after a kill at {there} results");
    }
}

#[test]
fn two_shards_at_once_give_the_bytes_of_one_run() {
    let scene = Scene::with_walkers();
    let sre = "run --data data --sequences Cid --config fast=fast.toml --protocol sre";
    for (line, name) in [(RUN, "ope"), (sre, "sre")] {
        scene.accepts(&format!("{line} --out {name}_whole"));
        let spawn = |shard: &str| {
            let line = format!("{line} --out {name}_shards --shard {shard}");
            scene.command(&line).stderr(Stdio::null()).spawn().unwrap()
        };
        for mut child in ["1/2", "2/2"].map(spawn) {
            assert!(child.wait().unwrap().success());
        }
        let expected = scene.reproducible(&format!("{name}_whole"));
        assert!(scene.reproducible(&format!("{name}_shards")) == expected, "{name}");
        assert!(expected.len() > 9);
    }
}

#[test]
fn a_second_run_does_nothing_and_other_parameters_are_refused_unmixed() {
    let scene = Scene::with_walkers();
    scene.accepts(&format!("{RUN} --out results"));
    let everything = || {
        let mut files = std::collections::BTreeMap::new();
        bench_scene::collect(&scene.path("results"), &scene.path("results"), &mut files);
        files
    };
    let before = everything();
    let again = scene.accepts(&format!("{RUN} --out results"));
    assert!(again.stderr.contains("9 jobs: 9 were there, 0 done, 0 failed"), "{}", again.stderr);
    assert!(everything() == before, "times and machine too");
    scene.write("fast.toml", "particles = 61\nparticle_sets = 1\n");
    let needles = ["other parameters (`particles` is 60 there and 61 here)", "--out"];
    scene.refuses(&format!("{RUN} --out results"), &needles);
    assert!(everything() == before);
    // Results of unknown parameters are not mixed with either.
    scene.write("flat/T/Cid.txt", "1,2,3,4\n");
    scene.accepts("convert flat unknown --from flat --to run");
    scene.write("fast.toml", "particles = 60\nparticle_sets = 1\n");
    let line = "run --data data --config T=fast.toml --out unknown";
    scene.refuses(line, &["unknown parameters (there is no run.json)"]);
}

#[test]
fn a_failing_job_is_recorded_the_others_are_done_and_it_is_tried_again() {
    let scene = Scene::with_walkers();
    let image = scene.path("data/Bob/img/0010.jpg");
    let bytes = fs::read(&image).unwrap();
    fs::write(&image, &bytes[..bytes.len() / 2]).unwrap();
    let line = "run --data data --sequences Ann,Bob,Nowhere --config fast=fast.toml --out results";
    let needles = [
        "Nowhere: no such sequence",
        "ope/fast/seed_1/Bob: ",
        "0010.jpg",
        "truncated",
        "2 jobs: 0 were there, 1 done, 1 failed",
    ];
    scene.refuses(line, &needles);
    assert_eq!(scene.read("results/ope/fast/seed_1/Ann.txt").lines().count(), 24);
    let failure = scene.read("results/ope/fast/seed_1/Bob.failed.json");
    assert!(failure.contains("0010.jpg") && failure.contains("ope/fast/seed_1/Bob"), "{failure}");
    let scored = scene.refuses("score --data data --results results", &["fast, Bob: no result", "0010.jpg"]);
    assert!(scored.stdout.contains("Ann"), "{}", scored.stdout);
    fs::write(&image, bytes).unwrap();
    scene.accepts("run --data data --sequences Ann,Bob --config fast=fast.toml --out results");
    assert!(!scene.path("results/ope/fast/seed_1/Bob.failed.json").exists());
    assert_eq!(scene.read("results/ope/fast/seed_1/Bob.txt").lines().count(), 20);
}

#[test]
fn a_job_out_of_time_fails_and_names_the_flag() {
    let scene = Scene::with_walkers();
    let line = "run --data data --sequences Ann --config fast=fast.toml --out results --timeout 0.000001";
    scene.refuses(line, &["longer than --timeout"]);
}

#[test]
fn plan_prints_every_job_with_its_id_and_whether_it_is_done() {
    let scene = Scene::with_walkers();
    scene.accepts("run --data data --sequences Cid --config fast=fast.toml --out results");
    let plan = scene.accepts("plan --data data --config fast=fast.toml --seeds 2 --out results").stdout;
    let jobs: Vec<serde_json::Value> = plan.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(jobs.len(), 6);
    assert_eq!(jobs[0]["id"], "ope/fast/seed_1/Ann", "the longest first");
    let done: Vec<&serde_json::Value> =
        jobs.iter().filter(|job| job["done"] == true).map(|job| &job["id"]).collect();
    assert_eq!(done, ["ope/fast/seed_1/Cid"]);
}

#[test]
fn words_that_mean_nothing_are_refused_with_what_there_is() {
    let scene = Scene::with_walkers();
    for (line, needles) in [
        ("run --data data --trackers kcf --out r", &["`kcf`", "infopart, whole-body, paper"][..]),
        ("run --data nowhere --out r", &["nowhere: no such file or folder"]),
        ("run --out r", &["give --data"]),
        ("run --data data --sequences , --out r", &["names no sequence"]),
        ("run --data data --config fast --out r", &["NAME=FILE.toml"]),
        ("run --data data --config fast=none.toml --out r", &["none.toml", "infopart config"]),
        ("run --data data --protocol vot --out r", &["ope, tre, sre"]),
        ("run --data data --shard 3/2 --out r", &["`3/2`"]),
        ("run --data data --trackers paper,paper --out r", &["given twice"]),
        (
            "run --data data --sequences Cid --config fast=fast.toml --protocol tre --out r",
            &["Cid: only 16 frames", "--protocol ope"],
        ),
    ] {
        scene.refuses(line, needles);
    }
}
