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
        let is_beside = |name: &String| name.ends_with("_time.txt") || name.ends_with("_confidence.txt");
        files.into_keys().filter(|name| !is_beside(name)).collect()
    }
}

#[test]
fn a_killed_run_goes_on_to_the_bytes_of_an_undisturbed_one() {
    let scene = Scene::with_walkers();
    scene.accepts(&format!("{RUN} --out whole"));
    let expected = scene.reproducible("whole");
    let files = 3 * 3 * 3 + 1;
    assert_eq!(
        expected.len(),
        files,
        "result, record and confidences, three sequences, three seeds, run.json: {:?}",
        expected.keys()
    );
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
fn single_jobs_give_the_bytes_of_one_run() {
    let scene = Scene::with_walkers();
    let run = "run --data data --config fast=fast.toml --sequences Bob,Cid";
    scene.accepts(&format!("{run} --out whole"));
    for job in ["ope/fast/seed_1/Cid", "ope/fast/seed_1/Bob"] {
        let outcome = scene.accepts(&format!("{run} --out single --job {job}"));
        assert!(outcome.stderr.contains("1 jobs: 0 were there, 1 done"), "{}", outcome.stderr);
    }
    assert!(scene.reproducible("single") == scene.reproducible("whole"));
    scene.refuses(
        &format!("{run} --out single --job ope/fast/seed_2/Cid"),
        &["ope/fast/seed_2/Cid", "otb_eval plan"],
    );
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
fn a_damaged_result_does_not_count_as_done_and_is_made_again() {
    let scene = Scene::with_walkers();
    scene.accepts(&format!("{RUN} --out results"));
    let expected = scene.reproducible("results");
    let cut = scene.read("results/ope/fast/seed_2/Bob.txt");
    scene.write("results/ope/fast/seed_1/Ann.txt", "");
    scene.write("results/ope/fast/seed_2/Bob.txt", &cut[..cut.len() - 2]);
    scene.write("results/ope/fast/seed_3/Cid.txt", "\u{1b}[2J garbage\n");
    let jobs = scene.accepts("plan --data data --config fast=fast.toml --seeds 3 --out results");
    assert_eq!(jobs.stdout.matches("\"done\":false").count(), 3, "{}", jobs.stdout);
    scene.refuses("score --data data --results results", &["Bob.txt: it is not the file that was written"]);
    let again = scene.accepts(&format!("{RUN} --out results"));
    for needle in [
        "note: ope/fast/seed_1/Ann: the result there is damaged, and is made again",
        "seed_2/Bob.txt: it is not the file that was written",
        "`\\u{1b}[2J garbage`",
        "9 jobs: 6 were there, 3 done, 0 failed",
    ] {
        assert!(again.stderr.contains(needle), "`{needle}` is not in: {}", again.stderr);
    }
    assert!(scene.reproducible("results") == expected);
    scene.accepts("score --data data --results results");
}

#[test]
fn tre_keeps_away_from_the_frames_of_the_lists_and_does_not_mix_starts() {
    let scene = Scene::with_walkers();
    scene.write("omit/ann.txt", "2 3\n");
    let plan = |flags: &str| {
        let line =
            format!("plan --data data --sequences Ann --config fast=fast.toml --protocol tre --out r{flags}");
        let jobs = scene.accepts(&line).stdout;
        let first =
            |line: &str| serde_json::from_str::<serde_json::Value>(line).unwrap()["first_frame"].as_u64();
        jobs.lines().map(|line| first(line).unwrap()).collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(plan("").into_iter().collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
    assert_eq!(plan(" --init-omit omit").into_iter().collect::<Vec<_>>(), [1, 4, 5]);
    let run = "run --data data --sequences Ann --config fast=fast.toml --protocol tre --out r";
    scene.accepts(&format!("{run} --init-omit omit"));
    scene.refuses(run, &["other lists of hidden frames"]);
    let scored = scene.accepts("score --data data --results r --protocol tre --init-omit omit");
    assert!(scored.stdout.contains("Ann"), "{}", scored.stdout);
    scene.write("omit/ann.txt", "two 3\n");
    scene.refuses(&format!("{run} --init-omit omit"), &["ann.txt, line 1: `two 3`"]);
}

#[test]
fn a_result_is_on_the_disk_before_it_has_its_name() {
    let scene = Scene::with_walkers();
    let words = "run --data data --sequences Cid --config fast=fast.toml --jobs 1 --out results";
    let traced = std::process::Command::new("strace")
        .args(["-f", "-y", "-e", "trace=fsync,fdatasync,rename,renameat,renameat2", "-o", "trace.txt"])
        .arg(env!("CARGO_BIN_EXE_otb_eval"))
        .args(words.split_whitespace())
        .current_dir(scene.path(""))
        .output();
    if !traced.is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: no strace that may trace");
        return;
    }
    let trace = scene.read("trace.txt");
    let lines: Vec<&str> = trace.lines().collect();
    let renamed =
        lines.iter().position(|line| line.contains("rename") && line.contains("Cid.txt\"")).unwrap();
    let is_sync = |line: &&str, name: &str| line.contains("fsync(") && line.contains(name);
    assert!(lines[..renamed].iter().any(|line| is_sync(line, ".Cid.txt.")), "{trace}");
    assert!(lines[renamed..].iter().any(|line| is_sync(line, "seed_1>")), "{trace}");
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

#[test]
fn shells_and_man_know_every_command() {
    let scene = Scene::empty();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = scene.accepts(&format!("completions {shell}")).stdout;
        assert!(text.contains("toolkit") && text.contains("report"), "{shell}");
    }
    scene.accepts("completions --out c --man man");
    assert_eq!(std::fs::read_dir(scene.path("c")).unwrap().count(), 5);
    assert!(scene.read("man/otb_eval-score.1").contains("toolkit"));
}
