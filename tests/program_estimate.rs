//! `infopart estimate` as a whole program.

mod program_scene;

use program_scene::Scene;
use serde_json::Value;

/// Times differ from run to run.
fn without_times(mut found: Value) -> Value {
    for comparison in found.as_array_mut().unwrap() {
        for filter in comparison["filters"].as_array_mut().unwrap() {
            assert!(filter["seconds"].take().as_f64().unwrap() > 0.0);
        }
    }
    found
}

#[test]
fn a_comparison_is_printed_written_and_drawn_alike_at_any_number_of_threads() {
    let scene = Scene::empty();
    let mut found = Vec::new();
    for threads in ["1", "3"] {
        let outcome = scene.accepts(&[
            "estimate",
            "van-der-pol",
            "--runs",
            "30",
            "--particles",
            "60,300",
            "--process-noise",
            "1e-3,1e-2",
            "--threads",
            threads,
            "--json",
            "scores.json",
            "--plot",
            "states.svg",
        ]);
        for word in ["EKF", "UKF", "PF-60", "PF-300", "RMSE EKF > UKF:", "RMSE PF-60 > PF-300:", "time "] {
            assert!(outcome.stdout.matches(word).count() >= 2, "{word}: {}", outcome.stdout);
        }
        assert!(scene.read("states.svg").ends_with("</svg>\n"));
        found.push(without_times(serde_json::from_str(&scene.read("scores.json")).unwrap()));
    }
    assert_eq!(found[0], found[1]);
    let comparison = &found[0][0];
    assert_eq!(comparison["setup"]["process_variance"], 1e-3);
    assert_eq!(comparison["filters"].as_array().unwrap().len(), 4);
    // 30 of the 1000 runs that r is calibrated on.
    let rmse = comparison["filters"][0]["rmse"]["mean"].as_f64().unwrap();
    assert!((rmse - 0.0328).abs() < 0.005, "{rmse}");
    assert!(!scene.path("scores.json.partial").exists());
}

#[test]
fn convergence_prints_a_slope_near_minus_one_half() {
    let scene = Scene::empty();
    let words =
        ["estimate", "convergence", "--runs", "8", "--reference", "30000", "--particles", "100,400,1600"];
    let outcome = scene.accepts(&words);
    let slope: f64 = outcome.stdout.lines().last().unwrap().strip_prefix("slope ").unwrap().parse().unwrap();
    assert!((slope + 0.5).abs() < 0.15, "{}", outcome.stdout);
}

#[test]
fn bad_flags_say_what_to_give() {
    let scene = Scene::empty();
    let vdp = |words: &[&'static str]| [&["estimate", "van-der-pol"], words].concat();
    for (words, needles) in [
        (vdp(&["--mu", "11"]), ["--mu", "at most 10"]),
        (vdp(&["--mu", "nan"]), ["--mu", "above 0"]),
        (vdp(&["--mu=-1"]), ["--mu", "above 0"]),
        (vdp(&["--particles", "500,0"]), ["--particles", "from 1 on"]),
        (vdp(&["--particles", ""]), ["--particles", "from 1 on"]),
        (vdp(&["--runs", "1"]), ["--runs", "at least 2"]),
        (vdp(&["--process-noise", "0"]), ["--process-noise", "above 0"]),
        (vdp(&["--measurement-noise", "inf"]), ["--measurement-noise", "above 0"]),
        (vdp(&["--measurement-noise", "1e9"]), ["--measurement-noise", "at most 1000"]),
        (vdp(&["--noise", "pink"]), ["--noise", "bimodal"]),
        (vdp(&["--json", "no/such/folder.json"]), ["--json", "no/such/folder.json"]),
        (vdp(&["--plot", "no/such/folder.svg"]), ["--plot", "no/such/folder.svg"]),
        (
            vec!["estimate", "convergence", "--reference", "100", "--particles", "10,100"],
            ["--particles", "below the reference"],
        ),
    ] {
        scene.refuses(&words, &needles);
    }
}
