//! `otb_eval run --tracker`: programs that behave, and programs that do not.
#![cfg(unix)]

mod bench_scene;

use std::{
    fs,
    process::Stdio,
    thread,
    time::{Duration, Instant},
};

use bench_scene::{Outcome, Scene};

/// A tracker in the shell: `$answer` to every frame, after `$before` it, and `$first` instead of its introduction.
const TRACKER: &str = r#"
echo "weights loaded"
echo "@@TRAX:hello \"trax.version=${version:-1}\" \"trax.name=shell\" \"trax.identifier=${identifier:-7}\""
number=0
while read -r kind rest; do
    case "$kind" in
        *quit*) exit 0 ;;
        *initialize*) [ "${version:-1}" = 4 ] && continue ;;
    esac
    number=$((number + 1))
    echo "chatter about frame $number: $rest"
    echo "standard error of frame $number" >&2
    [ -n "$before" ] && eval "$before"
    echo "@@TRAX:state \"${answer:-$((10 + number)),21.5,8,9}\" $more"
done
"#;

fn scene() -> Scene {
    let scene = Scene::with_walkers();
    scene.write("tracker.sh", TRACKER);
    scene
}

/// The program's run with a list of trackers, each the shell's tracker with some variables.
fn run(scene: &Scene, trackers: &[(&str, &str)], more: &str) -> Outcome {
    let table =
        |(name, variables): &(&str, &str)| format!("[{name}]\ncommand = '''{variables} sh tracker.sh'''\n");
    scene.write("trackers.toml", &trackers.iter().map(table).collect::<String>());
    scene.run(&format!("run --data data --sequences Cid --out results --trackers-file trackers.toml {more}"))
}

fn rows(scene: &Scene, tracker: &str) -> String {
    scene.read(&format!("results/ope/{tracker}/seed_1/Cid.txt"))
}

#[test]
fn clients_of_either_generation_write_the_trackers_boxes_and_say_what_the_times_are() {
    let scene = scene();
    let trackers = [("old", ""), ("new", "version=4"), ("timed", "more='\"time=0.25\"'")];
    let outcome = run(&scene, &trackers, "");
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let first = scene.read("data/Cid/groundtruth_rect.txt").lines().next().unwrap().to_owned();
    // The tracker counts pixels from 0, the benchmark from 1.
    let expected: String = (2..=16).map(|number| format!("{},22.5,8,9\n", 11 + number)).collect();
    for tracker in ["old", "new", "timed"] {
        let rows = rows(&scene, tracker);
        let (box_given, others) = rows.split_once('\n').unwrap();
        let numbers =
            |row: &str| row.split([',', '\t']).map(|n| n.parse::<f64>().unwrap()).collect::<Vec<_>>();
        assert_eq!(numbers(box_given), numbers(&first));
        assert_eq!(others, expected, "{tracker}");
    }
    let beside = |tracker: &str| -> serde_json::Value {
        serde_json::from_str(&scene.read(&format!("results/ope/{tracker}/seed_1/Cid.external.json"))).unwrap()
    };
    assert_eq!(beside("old")["times"], "round trips");
    assert_eq!(beside("timed")["times"], "the tracker's own");
    assert_eq!(beside("timed")["round_trip_seconds"].as_array().unwrap().len(), 16);
    assert_eq!(scene.read("results/ope/timed/seed_1/Cid_time.txt"), "0.25000000\n".repeat(16));
    let run: serde_json::Value = serde_json::from_str(&scene.read("results/ope/old/run.json")).unwrap();
    let program = run["program"].as_str().unwrap();
    assert!(program.contains("external") && program.contains("shell (7)"), "{program}");
    assert_eq!(run["parameters"]["command"], " sh tracker.sh");
    let table = scene.accepts("score --data data --results results").stdout;
    assert!(table.contains("timed"), "{table}");
}

#[test]
fn whatever_a_tracker_does_fails_its_own_jobs_alone_and_by_name() {
    let scene = scene();
    let at_4 = |what: &str| format!("before='[ $number = 4 ] && {what}'");
    let trackers: Vec<(&str, String, &str)> = vec![
        ("crashes", at_4("kill -SEGV $$"), "it ended at frame 4: exit status: 139; last on standard error"),
        ("leaves", at_4("exit 3"), "exit status: 3"),
        ("hangs", at_4("sleep 1000"), "did not answer at frame 4 within 1.5 seconds"),
        ("garbage", "answer='some words'".into(), "is no list of numbers"),
        ("not_a_number", "answer=1,2,nan,4".into(), "not finite"),
        ("three", "answer=1,2,3".into(), "too few numbers"),
        ("quits", at_4("echo \"@@TRAX:quit \\\"trax.reason=no memory\\\"\""), "no memory"),
        ("closes", at_4("{ exec >&-; sleep 1000; }"), "did not answer at frame 4"),
        ("repeats", at_4("echo \"@@TRAX:hello\""), "it said `hello`"),
        ("floods", at_4("{ head -c 3000000 /dev/zero; exit 5; }"), "exit status: 5"),
        ("fine", String::new(), ""),
    ];
    let listed: Vec<(&str, &str)> =
        trackers.iter().map(|(name, variables, _)| (*name, variables.as_str())).collect();
    let since = Instant::now();
    let outcome = run(&scene, &listed, "--frame-timeout 1.5 --jobs 2");
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("1 done, 10 failed"), "{}", outcome.stderr);
    assert!(since.elapsed() < Duration::from_secs(100));
    for (name, _, said) in trackers.iter().filter(|(_, _, said)| !said.is_empty()) {
        let failure = scene.read(&format!("results/ope/{name}/seed_1/Cid.failed.json"));
        assert!(failure.contains(said), "{name}: `{said}` is not in {failure}");
        assert!(outcome.stderr.contains(&format!("ope/{name}/seed_1/Cid: ")), "{}", outcome.stderr);
        assert!(!scene.path(&format!("results/ope/{name}/seed_1/Cid.txt")).exists());
    }
    assert_eq!(rows(&scene, "fine").lines().count(), 16);
    let kept = scene.reproducible("results")["ope/fine/seed_1/Cid.txt"].clone();
    // A second run tries the failed ones again and leaves the others.
    let again = run(&scene, &[("fine", ""), ("three", "answer=1,2,3")], "");
    assert!(again.stderr.contains("2 jobs: 1 were there, 0 done, 1 failed"), "{}", again.stderr);
    assert_eq!(scene.reproducible("results")["ope/fine/seed_1/Cid.txt"], kept);
}

#[test]
fn a_tracker_that_cannot_be_spoken_to_is_told_before_anything_is_run() {
    let scene = scene();
    scene.write(
        "trackers.toml",
        "[missing]\ncommand = \"no_such_program fast\"\n[silent]\ncommand = \"sleep 1000\"\nframe_timeout = 0.5\n\
         [memory]\ncommand = '''echo '@@TRAX:hello \"trax.image=memory;\"' '''\n[fine]\ncommand = \"sh tracker.sh\"\n",
    );
    let line = "run --data data --sequences Cid --out results --trackers-file trackers.toml";
    let told = [
        "tracker missing: `no_such_program fast`: it ended at its introduction: exit status: 127",
        "tracker silent: `sleep 1000`: it did not answer at its introduction within 0.5 seconds",
        "tracker memory: ",
        "takes no paths",
        "1 jobs: 0 were there, 1 done, 0 failed",
    ];
    scene.refuses(line, &told);
    scene.refuses("run --data data --out r --tracker a", &["give NAME=TEXT"]);
    scene.refuses("run --data data --out r --tracker a/b=c", &["no name for a folder"]);
    scene.refuses("run --data data --out r --tracker-version a=1", &["no tracker of that name"]);
    scene.refuses("run --data data --out r --trackers-file none.toml", &["none.toml"]);
    scene.refuses("run --data data --out r --tracker infopart=x --trackers infopart", &["given twice"]);
}

#[test]
fn results_of_another_command_version_or_introduction_are_not_mixed() {
    let scene = scene();
    assert_eq!(run(&scene, &[("mine", "")], "").code, 0);
    for (variables, more, said) in
        [("answer=1,2,3,4", "", "`command`"), ("", "--tracker-version mine=2", "`version`"), ("", "", "")]
    {
        let outcome = run(&scene, &[("mine", variables)], more);
        assert_eq!(outcome.code, if said.is_empty() { 0 } else { 2 }, "{}", outcome.stderr);
        assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    }
    scene.write("tracker.sh", &TRACKER.replace(":-7", ":-8"));
    let outcome = run(&scene, &[("mine", "")], "");
    assert!(outcome.code == 2 && outcome.stderr.contains("shell (7)"), "{}", outcome.stderr);
}

#[test]
fn seeds_reach_the_tracker_and_the_list_bounds_them() {
    let scene = scene();
    scene.write(
        "trackers.toml",
        "[many]\ncommand = 'answer=$INFOPART_SEED,2,3,4 sh tracker.sh'\n[one]\ncommand = 'sh tracker.sh'\nseeds = 1\n",
    );
    scene.accepts("run --data data --sequences Cid --out results --trackers-file trackers.toml --seeds 3");
    let last = scene.read("results/ope/many/seed_3/Cid.txt").lines().last().unwrap().to_owned();
    assert_eq!(last, "4,3,3,4");
    assert!(scene.path("results/ope/one/seed_1/Cid.txt").exists());
    assert!(!scene.path("results/ope/one/seed_2").exists());
}

#[test]
fn a_killed_evaluation_leaves_no_tracker_behind_and_goes_on_to_the_same_bytes() {
    let scene = scene();
    assert_eq!(run(&scene, &[("mine", "")], "").code, 0);
    let expected = rows(&scene, "mine");
    fs::remove_dir_all(scene.path("results")).unwrap();

    // It tells its number and that of a process that it started, and then does not answer.
    let slow = "[ ! -e done ] && [ $number = 5 ] && { sleep 1000 & echo $$ $! > pids; wait; }";
    scene.write("tracker.sh", &TRACKER.replace("[ -n \"$before\" ] && eval \"$before\"", slow));
    let line = "run --data data --sequences Cid --out results --trackers-file trackers.toml";
    let mut child = scene.command(line).stderr(Stdio::null()).spawn().unwrap();
    let deadline = Instant::now() + Duration::from_secs(60);
    while fs::read_to_string(scene.path("pids")).unwrap_or_default().split_whitespace().count() < 2 {
        assert!(Instant::now() < deadline, "the tracker did not come to frame 5");
        thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let lives = |pid: &str| {
        std::process::Command::new("kill").args(["-0", pid]).stderr(Stdio::null()).status().unwrap().success()
    };
    let pids = scene.read("pids");
    while pids.split_whitespace().any(lives) {
        assert!(Instant::now() < deadline, "an orphan lives: {pids}");
        thread::sleep(Duration::from_millis(20));
    }
    scene.write("done", "");
    assert_eq!(run(&scene, &[("mine", "")], "").code, 0);
    assert_eq!(rows(&scene, "mine"), expected);
}
