//! The script that reads the MATLAB benchmark's files, and `otb_eval` on what it writes.

mod bench_scene;

use std::process::Command;

use bench_scene::Scene;

/// Makes files as MATLAB's benchmark does, and reads them back through the script.
const MAKE_MAT: &str = "
import numpy as np
from scipy.io import savemat
def cell(segments):
    cells = np.empty((1, len(segments)), dtype=object)
    for i, segment in enumerate(segments):
        cells[0, i] = segment
    return {'results': cells}
box = np.tile([10.0, 20.0, 30.0, 40.5], (6, 1))
segment = {'res': box, 'type': 'rect', 'fps': 4.0, 'len': 6, 'annoBegin': 1, 'startFrame': 1}
savemat('ann_T.mat', cell([segment]))
savemat('bob_T.mat', cell([dict(segment, shiftType=shift) for shift in ('left', 'scale_8')]))
savemat('cid_T.mat', cell([segment, dict(segment, res=box[2:], startFrame=3)]))
savemat('dan_T.mat', cell([dict(segment, type='LK_Aff')]))
savemat('eve_T.mat', {'one': segment, 'other': segment})
# IVT's archived start on Couple: its template, moved to the left by 3.
affine = dict(segment, type='ivtAff', tmplsize=[32.0, 32.0], res=np.array([[61.0, 78.0, 0.7813, 0.0, 0.0, 1.9375]] * 6))
savemat('Jogging_1_my_tracker.mat', {'saved': cell([affine, dict(affine, startFrame=4)])['results']})
corners = np.array([[48.5, 73.4, 72.5, 48.6], [47.0, 47.2, 108.5, 109.0]] * 6)
savemat('human4_T.mat', {'r': dict(segment, type='4corner', res=corners)})
savemat('skating2-2_T.mat', cell([dict(segment, type='affine', res=corners)]))
tiger = [dict(segment, startFrame=start, annoBegin=1) for start in (6, 32)]
savemat('tiger1_T.mat', cell(tiger))
savemat('david_T.mat', cell([dict(segment, startFrame=start, annoBegin=300) for start in (300, 302)]))
";

#[test]
fn the_matlab_benchmarks_files_are_read_by_the_script() {
    let scene = Scene::with_results();
    let python = |words: &[&str]| Command::new("python3").args(words).current_dir(scene.path("")).output();
    if !python(&["-c", "import scipy.io"]).is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: no python3 with SciPy");
        return;
    }
    assert!(python(&["-c", MAKE_MAT]).unwrap().status.success());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/mat_to_text.py");
    let files = [
        "ann_T.mat",
        "bob_T.mat",
        "cid_T.mat",
        "dan_T.mat",
        "eve_T.mat",
        "Jogging_1_my_tracker.mat",
        "human4_T.mat",
        "skating2-2_T.mat",
        "tiger1_T.mat",
        "david_T.mat",
    ];
    let output = python(&[&[script][..], &files, &["--out", "mat"]].concat()).unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    for needle in [
        "dan_T.mat: its results are of type `LK_Aff`",
        "eve_T.mat: several variables that may be results in it, but: one, other",
        "2 files left out",
    ] {
        assert!(told.contains(needle), "{told}");
    }
    assert_eq!(scene.read("mat/tre/my_tracker/seed_0/Jogging-1_02.txt"), "48.0,47.0,25.0,62.0\n".repeat(6));
    // Corners as the MATLAB benchmark takes them: the last pixel belongs to the box.
    for name in ["Human4-2", "Skating2-2"] {
        assert_eq!(scene.read(&format!("mat/ope/T/seed_0/{name}.txt")), "49.0,47.0,26.0,63.0\n".repeat(6));
    }
    for (stem, row) in [
        ("my_tracker/seed_0/Jogging-1_02", 4),
        ("T/seed_0/Cid_02", 3),
        ("T/seed_0/Tiger1_01", 1),
        ("T/seed_0/Tiger1_02", 27),
        ("T/seed_0/David_02", 3),
    ] {
        let record: serde_json::Value =
            serde_json::from_str(&scene.read(&format!("mat/tre/{stem}.result.json"))).unwrap();
        assert_eq!(record["first_row"], row, "{stem}");
    }
    assert_eq!(scene.read("mat/ope/T/seed_0/Ann.txt"), "10.0,20.0,30.0,40.5\n".repeat(6));
    assert_eq!(scene.read("mat/ope/T/seed_0/Ann_time.txt"), "0.25000000\n".repeat(6));
    assert!(scene.path("mat/sre/T/seed_0/Bob_scale_8.txt").is_file());
    assert_eq!(scene.read("mat/tre/T/seed_0/Cid_02.txt").lines().count(), 4);
    scene.accepts("score --data boxes.json --results mat --toolkit matlab --sequences Ann --trackers T");
    let tre =
        scene.accepts("score --data boxes.json --results mat --protocol tre --sequences Cid --trackers T");
    assert!(tre.stdout.lines().any(|line| line.starts_with("Cid")), "{}", tre.stdout);
}
