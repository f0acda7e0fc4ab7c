#!/usr/bin/env python3
"""Times InfoPart and other trackers on the same frames, and scores them.

For each sequence and each round every tracker runs once, the order turning by one from round to round: a process that
`otb_eval run --tracker` speaks TraX with, InfoPart by `infopart trax`, the others by `python -m infopart.trax` with the
classes of infopart.rivals. Only updates are timed, by the tracker's own process: reading and decoding frames and the
first frame are not. The ratio of a sequence is the median over
rounds of (rival's time / InfoPart's time); the ratio of all is the geometric mean over sequences. A tracker that
says it has lost the target may return at once: its time then says little, and --json has how often it said so.

InfoPart tracks the part of a person and the whole box of other targets (those of others12, and car). Frames without
the target (rows of NaN) are timed and not scored. A tracker that refuses a first box beyond the picture gets the part
of it that is inside. With --tre every tracker is also started on frames spread evenly over the sequence, from the
true box of each, and runs to the end: the benchmark's temporal robustness evaluation without its lists of hidden
frames. A sequence's number is the plain mean of the AUC of its runs, not timed.

Needs: pip install ./python -r bench/requirements.txt (and dlib-bin for --rivals dlib), and
`cargo build --release --workspace`; for
--rivals NanoTrack its two networks, backbone.onnx and head.onnx, in the folder given with --models.
Data: the folder given with --data or INFOPART_DATA, which holds otb/, people/ and so on; else ../shared/data beside
the project.
"""

import argparse
import json
import os
import platform
import re
import shlex
import statistics
import subprocess
import sys
import tempfile
from collections import namedtuple
from pathlib import Path

from sequences import (
    NAMES_HELP, PROJECT, data_folder, expand, fail, locate, read_rows, region_flags, tre_starts, usual_folder,
)

RIVALS = ("Boosting", "CSRT", "KCF", "MIL", "MOSSE", "MedianFlow", "NanoTrack", "TLD", "dlib")
# Where a class of infopart.rivals has another name.
CLASSES = {"dlib": "Dlib"}
OURS = "infopart"
# Frames that the benchmark's ground truth covers, where a folder holds more images than rows.
COVERED = {"David": (300, 770), "Football1": (1, 74), "Diving": (1, 215), "Freeman3": (1, 460), "Freeman4": (1, 283)}

Sequence = namedtuple("Sequence", "name folder target truth files")
# seconds: of all updates; boxes: (frames, 4), counted from 1; lost: updates that gave no box.
Run = namedtuple("Run", "seconds boxes lost")


def executable(given, flag="infopart"):
    """The program, if it can be run."""
    program = Path(given).resolve()
    if not os.access(program, os.X_OK):
        fail(f"no program at {program}: run `cargo build --release --workspace`, or give its path with --{flag}")
    return program


def load_numpy():
    """Only where it is needed: accuracy.py, which stands on this file too, does without."""
    global np
    try:
        import numpy as np
    except ImportError as error:
        fail(f"{error}: pip install -r {PROJECT / 'bench/requirements.txt'}")


# Input


def read_sequence(name, folder, target, truth_file):
    truth = np.array(read_rows(folder / truth_file))
    files = sorted(path for path in (folder / "img").iterdir() if path.suffix.lower() in (".jpg", ".png"))
    if folder.name in COVERED:
        first, last = COVERED[folder.name]
        covered = [path for path in files if first <= int(path.stem) <= last]
        files = covered if len(covered) == len(truth) else files
    if len(files) < 2 or len(files) != len(truth):
        fail(f"{folder}: {len(files)} images but {len(truth)} rows of ground truth")
    return Sequence(name, folder, target, truth, files)


# Runs: each tracker is a process that `otb_eval run` speaks TraX with


def command(name, threads, sequence, options):
    """The line that starts a tracker: rivals are classes of infopart.rivals."""
    if name == OURS:
        region = ["--region", options.region] if options.region else region_flags(sequence.name)
        words = [options.infopart, "trax", "--seed", 1, "--threads", threads, *region]
    else:
        words = [sys.executable, "-m", "infopart.trax", f"infopart.rivals:{CLASSES.get(name, name)}"]
        words += ["--rgb"] if name == "dlib" else ["--option", f"threads={threads}"]
        words += [f"--option={key}={value}" for key, value in networks(name, options).items()]
    return shlex.join(map(str, words))


def networks(name, options):
    if name != "NanoTrack":
        return {}
    return {key: options.models / f"{key}.onnx" for key in ("backbone", "head")}


def refuse_missing(options):
    """Ends where a tracker cannot be made, now rather than in the middle."""
    try:
        from infopart import rivals
    except ImportError as error:
        fail(f"{error}: pip install {PROJECT / 'python'} -r {PROJECT / 'bench/requirements.txt'}")
    for name in options.rivals:
        try:
            getattr(rivals, CLASSES.get(name, name))(**networks(name, options)).create()
        except FileNotFoundError as error:
            fail(f"{error}; or give the folder of NanoTrack's networks with --models")
        except (ImportError, RuntimeError, AttributeError) as error:
            fail(f"--rivals {name}: {error}")


def lay_out(sequence, start, folder):
    """The sequence from a row of its ground truth on as a folder of OTB, its images linked."""
    (folder / "img").mkdir(parents=True)
    for file in sequence.files[start:]:
        (folder / "img" / file.name).symlink_to(file.resolve())
    rows = (",".join(map(str, row)) for row in sequence.truth[start:].tolist())
    (folder / "groundtruth_rect.txt").write_text("\n".join(rows).replace("nan", "NaN") + "\n")


def run(name, sequence, threads, start, options):
    """One run from a row of the ground truth, counted from 0, to the end."""
    # No name that otb_eval knows, for it would look for what is known of that sequence.
    label = f"from_{start}_of_{sequence.name}"
    with tempfile.TemporaryDirectory() as folder:
        data, out = Path(folder) / label, Path(folder) / "results"
        lay_out(sequence, start, data)
        words = [options.otb_eval, "run", "--data", data, "--out", out, "--jobs", 1]
        words += ["--tracker", f"{name}={command(name, threads, sequence, options)}"]
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
        if done.returncode != 0:
            fail(f"{name} fails on {sequence.name} from frame {start + 1}: {done.stderr.strip()}")
        found = out / "ope" / name / "seed_1"
        boxes = np.loadtxt(found / f"{label}.txt", delimiter=",", ndmin=2)
        seconds = np.loadtxt(found / f"{label}_time.txt", ndmin=1)[1:].sum()
        lost = json.loads((found / f"{label}.external.json").read_text())["lost_frames"]
    return Run(float(seconds), boxes, lost)


# Measures: the benchmark's own (Wu, Lim, Yang 2015), over the frames whose ground truth has the target


def overlaps(boxes, truth):
    near, far = np.maximum(boxes[:, :2], truth[:, :2]), np.minimum(boxes[:, :2] + boxes[:, 2:], truth[:, :2] + truth[:, 2:])
    shared = np.clip(far - near, 0, None).prod(axis=1)
    return shared / (boxes[:, 2:].prod(axis=1) + truth[:, 2:].prod(axis=1) - shared)


def score(boxes, truth):
    present = np.isfinite(truth).all(axis=1) & (truth[:, 2:] > 0).all(axis=1)
    boxes, truth = boxes[present], truth[present]
    overlap = overlaps(boxes, truth)
    error = np.hypot(*(boxes[:, :2] + boxes[:, 2:] / 2 - truth[:, :2] - truth[:, 2:] / 2).T)
    success = [np.mean(overlap > step / 20) for step in range(21)]
    return {"auc": float(np.mean(success)), "r1": 100 * float(np.mean(error <= 20)), "r2": 100 * float(success[10])}


# The comparison


def measure(sequence, names, options):
    """What each tracker took and found: {name: {ms_per_update: {threads: [a round each]}, lost, auc, r1, r2}}, and with
    --tre also {tre: {number of the first frame: AUC}}."""
    found = {name: {"ms_per_update": {threads: [] for threads in options.threads}} for name in names}
    for number in range(options.rounds):
        turn = number % len(names)
        for threads in options.threads:
            for name in names[turn:] + names[:turn]:
                done = run(name, sequence, threads, 0, options)
                found[name]["ms_per_update"][threads].append(1e3 * done.seconds / (len(sequence.truth) - 1))
                found[name].update(score(done.boxes, sequence.truth), lost=done.lost)
    if options.tre:
        for name in names:
            found[name]["tre"] = tre(name, sequence, found[name]["auc"], options)
    return found


def tre(name, sequence, ope, options):
    """AUC of the runs of temporal robustness evaluation; the first is the one pass, done already."""
    aucs = {}
    for start in tre_starts(sequence.truth.tolist(), options.tre):
        if start > 0:
            boxes = run(name, sequence, options.threads[-1], start, options).boxes
            aucs[start + 1] = score(boxes, sequence.truth[start:])["auc"]
        else:
            aucs[1] = ope
    return aucs


def ratio(found, rival, threads):
    times = [found[name]["ms_per_update"][threads] for name in (rival, OURS)]
    return statistics.median(a / b for a, b in zip(*times))


def geometric_means(all_found, rivals, threads):
    return {
        rival: statistics.geometric_mean(ratio(found, rival, threads) for found in all_found.values()) for rival in rivals
    }


def machine():
    try:
        models = re.findall(r"^model name\s*:\s*(.+)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    except OSError:
        models = []
    cpu = models[0] if models else platform.processor() or platform.machine()
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {"cpu": cpu, "cores": cores, "opencv": cv2.__version__}


def table(header, rows):
    align = ["---"] + ["---:"] * (len(header) - 1)
    return "\n".join("| " + " | ".join(row) + " |" for row in [header, align, *rows])


def speed_table(all_found, names, threads):
    rivals = names[1:]
    title = f"milliseconds per update, {threads} thread{'s' * (threads > 1)} each"
    header = [title, *names, *(f"{rival} / {OURS}" for rival in rivals)]
    rows = []
    for sequence, found in all_found.items():
        times = [f"{statistics.median(found[name]['ms_per_update'][threads]):.2f}" for name in names]
        rows.append([sequence, *times, *(f"{ratio(found, rival, threads):.2f}" for rival in rivals)])
    geometric = geometric_means(all_found, rivals, threads)
    rows.append(["geometric mean", *([""] * len(names)), *(f"**{geometric[rival]:.2f}**" for rival in rivals)])
    return table(header, rows)


def score_table(all_found, names):
    cell = lambda scores: f"{scores['auc']:.3f} {scores['r1']:.1f} {scores['r2']:.1f}"
    rows = [[sequence, *(cell(found[name]) for name in names)] for sequence, found in all_found.items()]
    mean = lambda name: {key: statistics.mean(f[name][key] for f in all_found.values()) for key in ("auc", "r1", "r2")}
    rows.append(["mean", *(cell(mean(name)) for name in names)])
    return table(["AUC, R1, R2", *names], rows)


def tre_table(all_found, names):
    mean = lambda found, name: statistics.mean(found[name]["tre"].values())
    rows = [
        [sequence, str(len(found[OURS]["tre"])), *(f"{mean(found, name):.3f}" for name in names)]
        for sequence, found in all_found.items()
    ]
    means = [statistics.mean(mean(found, name) for found in all_found.values()) for name in names]
    rows.append(["mean", "", *(f"{value:.3f}" for value in means)])
    return table(["mean AUC of the runs of TRE", "runs", *names], rows)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--rivals", default="Boosting", help=f"comma-separated, of: {', '.join(RIVALS)} [default: Boosting]")
    add("--sequences", nargs="+", default=["people8"], metavar="NAME",
        help=f"{NAMES_HELP} [default: people8]")
    add("--rounds", type=int, default=3, help="how often each tracker runs a sequence [default: 3]")
    add("--tre", type=int, default=0, metavar="STARTS", help="also score the runs from so many start frames")
    add("--region", help="what InfoPart tracks: part, whole or a fraction [default: part of people, whole of others]")
    add("--threads", default="2", help="threads that each tracker may use: a number, or `both` for 1 and 2 [default: 2]")
    add("--models", type=Path, metavar="DIR", help="NanoTrack's networks [default: models/nanotrack_v2 of the data folder]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--otb-eval", default=PROJECT / "target/release/otb_eval", help="the program [default: target/release/otb_eval]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    add("--json", metavar="FILE", help="write every number to FILE")
    options = parser.parse_args()
    options.rivals = list(dict.fromkeys(options.rivals.split(",")))
    for name in options.rivals:
        if name not in RIVALS:
            fail(f"--rivals {name}: choose from {', '.join(RIVALS)}")
    options.threads = thread_counts(options.threads)
    if options.rounds < 1 or options.tre < 0:
        fail("--rounds must be at least 1, --tre at least 0")
    return options


def usual_models(data):
    """The data's own; a folder of crowd.py's has none, but the usual folder may."""
    folders = [folder / "models" / "nanotrack_v2" for folder in (data, usual_folder())]
    return next((folder for folder in folders if folder.is_dir()), folders[0])


def thread_counts(given):
    if given == "both":
        return [1, 2]
    if not given.isdecimal() or int(given) < 1:
        fail(f"--threads {given}: give a number from 1 on, or both")
    return [int(given)]


def main():
    global cv2
    options = arguments()
    # Each network that NanoTrack reads warns of a setting that OpenCV 5 does not heed.
    os.environ.setdefault("OPENCV_LOG_LEVEL", "ERROR")
    try:
        import cv2
    except ImportError as error:
        fail(f"{error}: pip install -r {PROJECT / 'bench/requirements.txt'}")
    load_numpy()
    options.infopart = executable(options.infopart)
    options.otb_eval = executable(options.otb_eval, "otb-eval")
    data = data_folder(options.data)
    sequences = [read_sequence(name, *locate(data, name)) for name in expand(options.sequences)]
    names = [OURS, *options.rivals]
    options.models = options.models or usual_models(data)
    refuse_missing(options)

    all_found = {}
    for sequence in sequences:
        print(f"{sequence.name} ...", file=sys.stderr, flush=True)
        all_found[sequence.name] = measure(sequence, names, options)
    about = machine()
    print(
        f"{about['cpu']}, {about['cores']} cores, OpenCV {about['opencv']}; "
        f"median of {options.rounds} round{'s' * (options.rounds > 1)}, updates only\n"
    )
    parts = [*(speed_table(all_found, names, threads) for threads in options.threads), score_table(all_found, names)]
    print("\n\n".join(parts + ([tre_table(all_found, names)] if options.tre else [])))
    if options.json:
        settings = {"rounds": options.rounds, "threads": options.threads, "region": options.region, "tre": options.tre}
        geometric = {threads: geometric_means(all_found, options.rivals, threads) for threads in options.threads}
        everything = {"machine": about, **settings, "geometric_mean_ratio": geometric, "sequences": all_found}
        Path(options.json).write_text(json.dumps(everything, indent=1) + "\n")


if __name__ == "__main__":
    main()
