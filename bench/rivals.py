#!/usr/bin/env python3
"""Times InfoPart and other trackers on the same frames, and scores them.

For each sequence and each round every tracker runs once, the order turning by one from round to round. Only updates
are timed: reading and decoding frames and the first frame are not. The ratio of a sequence is the median over
rounds of (rival's time / InfoPart's time); the ratio of all is the geometric mean over sequences. A tracker that
says it has lost the target may return at once: its time then says little, and --json has how often it said so.

Needs: pip install -r bench/requirements.txt (and dlib-bin for --rivals dlib), and `cargo build --release`.
Data: the folder given with --data or INFOPART_DATA, which holds otb/ and people/; else ../shared/data beside the
project.
"""

import argparse
import json
import os
import platform
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections import namedtuple
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
KINDS = ("otb", "people", "ships")
OTHER7 = "Deer David DragonBaby FaceOcc1 Freeman1 Football1 Diving".split()
PEOPLE8 = "Crossing Walking2 David3 Jogging-1 Jogging-2 Couple pedestrian1 person11".split()
CROWD = [f"pets{identity}" for identity in range(1, 20)]  # Made by crowd.py.
LISTS = {"people8": PEOPLE8, "other7": OTHER7, "crowd": CROWD}
RIVALS = ("Boosting", "CSRT", "KCF", "MIL", "MOSSE", "MedianFlow", "TLD", "dlib")
OURS = "infopart"
# Frames that the benchmark's ground truth covers, where a folder holds more images than rows.
COVERED = {"David": (300, 770), "Football1": (1, 74), "Diving": (1, 215), "Freeman3": (1, 460), "Freeman4": (1, 283)}

Sequence = namedtuple("Sequence", "name folder target truth files")
# seconds: of all updates; boxes: (frames, 4), counted from 1; lost: updates that gave no box.
Run = namedtuple("Run", "seconds boxes lost")


def fail(message):
    print(f"{Path(sys.argv[0]).name}: {message}", file=sys.stderr)
    sys.exit(2)


def executable(given):
    """The program, if it can be run."""
    program = Path(given).resolve()
    if not os.access(program, os.X_OK):
        fail(f"no program at {program}: run `cargo build --release`, or give its path with --infopart")
    return program


def load_numpy():
    """Only where it is needed: accuracy.py, which stands on this file too, does without."""
    global np
    try:
        import numpy as np
    except ImportError as error:
        fail(f"{error}: pip install -r {PROJECT / 'bench/requirements.txt'}")


# Input


def data_folder(given, kinds=KINDS):
    """The folder of the data, if it holds any of those kinds."""
    folder = Path(given or os.environ.get("INFOPART_DATA") or PROJECT.parent / "shared" / "data")
    if not any((folder / kind).is_dir() for kind in kinds):
        holds = " or ".join(f"{kind}/" for kind in kinds)
        fail(f"no {holds} in {folder}: give the folder that holds it with --data or INFOPART_DATA")
    return folder


def expand(given):
    """The sequences of a list's name, or the name itself, of each that is given."""
    return [name for word in given for name in LISTS.get(word, [word])]


def locate(data, name):
    """NAME, or NAME-K for target K of a folder with groundtruth_rect.K.txt: its folder, target and ground-truth file."""
    plain, _, target = name.rpartition("-")
    for kind in KINDS:
        if (data / kind / name / "groundtruth_rect.txt").is_file():
            return data / kind / name, None, "groundtruth_rect.txt"
        if plain and (data / kind / plain / f"groundtruth_rect.{target}.txt").is_file():
            return data / kind / plain, target, f"groundtruth_rect.{target}.txt"
    fail(f"no sequence {name} in {data}; use NAME, or NAME-K for a folder of several targets")


def read_sequence(name, folder, target, truth_file):
    lines = (folder / truth_file).read_text().split("\n")
    rows = [re.split(r"[,\s]+", line.strip()) for line in lines if line.strip()]
    try:
        truth = np.array([[float(number) for number in row] for row in rows]).reshape(-1, 4)
    except ValueError as error:
        fail(f"{folder / truth_file}: {error}; every row must be four numbers x,y,w,h")
    files = sorted(path for path in (folder / "img").iterdir() if path.suffix.lower() in (".jpg", ".png"))
    if folder.name in COVERED:
        first, last = COVERED[folder.name]
        covered = [path for path in files if first <= int(path.stem) <= last]
        files = covered if len(covered) == len(truth) else files
    return Sequence(name, folder, target, truth, files)


def decode(path):
    image = cv2.imread(str(path))
    if image is None:
        fail(f"{path} cannot be decoded")
    return image


# Trackers


class Dlib:
    """dlib's correlation tracker behind the calls of OpenCV's trackers; it takes RGB."""

    def __init__(self):
        try:
            import dlib
        except ImportError:
            fail("dlib is not installed: pip install dlib-bin, or leave dlib out of --rivals")
        self.rectangle, self.tracker = dlib.rectangle, dlib.correlation_tracker()

    def init(self, image, box):
        x, y, w, h = box
        self.tracker.start_track(image, self.rectangle(x, y, x + w - 1, y + h - 1))

    def update(self, image):
        self.tracker.update(image)
        position = self.tracker.get_position()
        return True, (position.left(), position.top(), position.width(), position.height())


def make_rival(name):
    if name == "dlib":
        return Dlib()
    for module in (cv2, getattr(cv2, "legacy", None)):
        create = getattr(module, f"Tracker{name}_create", None)
        if create:
            return create()
    fail(f"OpenCV {cv2.__version__} has no {name} tracker: pip install opencv-contrib-python-headless")


def run_rival(name, sequence, images):
    tracker = make_rival(name)
    x, y, w, h = sequence.truth[0]
    tracker.init(images[0], (round(x - 1), round(y - 1), round(w), round(h)))
    seconds, lost, boxes = 0.0, 0, [sequence.truth[0]]
    for image in images[1:]:
        start = time.perf_counter()
        found, box = tracker.update(image)
        seconds += time.perf_counter() - start
        lost += not found
        # Where a tracker says that it has lost the target, its last box stands.
        boxes.append((box[0] + 1, box[1] + 1, box[2], box[3]) if found else boxes[-1])
    return Run(seconds, np.array(boxes, float), lost)


def run_ours(program, flags, sequence):
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "boxes.txt"
        command = [program, "track", sequence.folder, *flags, "--json", "--quiet", "--out", rows]
        command += ["--target", sequence.target] if sequence.target else []
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            fail(f"{program} failed on {sequence.name} with exit code {done.returncode}: {done.stderr.strip()}")
        summary = json.loads(done.stderr)
        boxes = np.loadtxt(rows, delimiter=",", ndmin=2)
    return Run(summary["update_seconds"], boxes, summary["lost_frames"])


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
    """What each tracker took and found: {name: {ms_per_update: [a round each], lost, auc, r1, r2}}."""
    images = [decode(path) for path in sequence.files]
    as_rgb = [cv2.cvtColor(image, cv2.COLOR_BGR2RGB) for image in images] if "dlib" in names else None
    if len(images) < 2 or len(images) != len(sequence.truth):
        fail(f"{sequence.folder}: {len(images)} images but {len(sequence.truth)} rows of ground truth")
    found = {name: {"ms_per_update": []} for name in names}
    for number in range(options.rounds):
        turn = number % len(names)
        for name in names[turn:] + names[:turn]:
            if name == OURS:
                flags = ["--threads", options.threads, "--region", options.region]
                run = run_ours(options.infopart, flags, sequence)
            else:
                run = run_rival(name, sequence, as_rgb if name == "dlib" else images)
            if len(run.boxes) != len(images):
                fail(f"{name} gave {len(run.boxes)} boxes for the {len(images)} frames of {sequence.name}")
            found[name]["ms_per_update"].append(1e3 * run.seconds / (len(images) - 1))
            found[name].update(score(run.boxes, sequence.truth), lost=run.lost)
    return found


def ratio(found, rival):
    return statistics.median(a / b for a, b in zip(found[rival]["ms_per_update"], found[OURS]["ms_per_update"]))


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


def report(all_found, names, geometric):
    rivals = names[1:]
    header = ["milliseconds per update", *names, *(f"{rival} / {OURS}" for rival in rivals)]
    rows = []
    for sequence, found in all_found.items():
        times = [f"{statistics.median(found[name]['ms_per_update']):.2f}" for name in names]
        rows.append([sequence, *times, *(f"{ratio(found, rival):.2f}" for rival in rivals)])
    rows.append(["geometric mean", *([""] * len(names)), *(f"**{geometric[rival]:.2f}**" for rival in rivals)])
    speed = table(header, rows)
    cell = lambda scores: f"{scores['auc']:.3f} {scores['r1']:.1f} {scores['r2']:.1f}"
    rows = [[sequence, *(cell(found[name]) for name in names)] for sequence, found in all_found.items()]
    mean = lambda name: {key: statistics.mean(f[name][key] for f in all_found.values()) for key in ("auc", "r1", "r2")}
    rows.append(["mean", *(cell(mean(name)) for name in names)])
    return f"{speed}\n\n{table(['AUC, R1, R2', *names], rows)}"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--rivals", default="Boosting", help=f"comma-separated, of: {', '.join(RIVALS)} [default: Boosting]")
    add("--sequences", nargs="+", default=["people8"], metavar="NAME",
        help="people8, other7, crowd, NAME, or NAME-K for target K [default: people8]")
    add("--rounds", type=int, default=3, help="how often each tracker runs a sequence [default: 3]")
    add("--region", default="part", help="what InfoPart tracks: part, whole or a fraction [default: part]")
    add("--threads", type=int, default=2, help="threads that each tracker may use [default: 2]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    add("--json", metavar="FILE", help="write every number to FILE")
    options = parser.parse_args()
    options.rivals = list(dict.fromkeys(options.rivals.split(",")))
    for name in options.rivals:
        if name not in RIVALS:
            fail(f"--rivals {name}: choose from {', '.join(RIVALS)}")
    if options.rounds < 1 or options.threads < 1:
        fail("--rounds and --threads must be at least 1")
    return options


def main():
    global cv2
    options = arguments()
    try:
        import cv2
    except ImportError as error:
        fail(f"{error}: pip install -r {PROJECT / 'bench/requirements.txt'}")
    load_numpy()
    options.infopart = executable(options.infopart)
    data = data_folder(options.data)
    sequences = [read_sequence(name, *locate(data, name)) for name in expand(options.sequences)]
    names = [OURS, *options.rivals]
    for name in options.rivals:
        make_rival(name)  # Fails now rather than in the middle.
    cv2.setNumThreads(options.threads)

    all_found = {}
    for sequence in sequences:
        print(f"{sequence.name} ...", file=sys.stderr, flush=True)
        all_found[sequence.name] = measure(sequence, names, options)
    geometric = {
        rival: statistics.geometric_mean(ratio(found, rival) for found in all_found.values()) for rival in options.rivals
    }
    about = machine()
    print(
        f"{about['cpu']}, {about['cores']} cores, OpenCV {about['opencv']}; {options.threads} threads each, "
        f"median of {options.rounds} round{'s' * (options.rounds > 1)}, updates only\n"
    )
    print(report(all_found, names, geometric))
    if options.json:
        settings = {"rounds": options.rounds, "threads": options.threads, "region": options.region}
        everything = {"machine": about, **settings, "geometric_mean_ratio": geometric, "sequences": all_found}
        Path(options.json).write_text(json.dumps(everything, indent=1) + "\n")


if __name__ == "__main__":
    main()
