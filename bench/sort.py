#!/usr/bin/env python3
"""Times `mot sort` against the Python reference (abewley/sort) on the same detections, one after the other.

Both are timed in the tracker alone, frame by frame, without reading and writing files; the reference's time is what its own
loop would print. The reference is not part of this project: get its sort.py yourself, for example
`git clone https://github.com/abewley/sort`, and `pip install -r bench/requirements-sort.txt`. Its drawing is never used, so that
matplotlib and scikit-image may be missing. Needs `cargo build --release --workspace`.
"""

import argparse
import importlib.util
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from unittest import mock

from sequences import PROJECT, data_folder, fail


def load_reference(path):
    """The reference's module; what it draws with is replaced by nothing."""
    if not path.is_file():
        fail(f"no reference at {path}: give the path of abewley/sort's sort.py with --reference")
    names = ["matplotlib", "matplotlib.pyplot", "matplotlib.patches", "skimage", "skimage.io"]
    sys.modules.update({name: mock.MagicMock() for name in names})
    spec = importlib.util.spec_from_file_location("reference_sort", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def time_reference(module, detections_path):
    """Seconds in the reference's tracker and frames, as its own main loop measures them."""
    import numpy

    rows = numpy.loadtxt(detections_path, delimiter=",")
    tracker = module.Sort(max_age=1, min_hits=3, iou_threshold=0.3)
    module.KalmanBoxTracker.count = 0
    seconds, frames, boxes = 0.0, int(rows[:, 0].max()), 0
    for frame in range(1, frames + 1):
        seen = rows[rows[:, 0] == frame, 2:7]
        seen[:, 2:4] += seen[:, 0:2]
        start = time.perf_counter()
        tracked = tracker.update(seen)
        seconds += time.perf_counter() - start
        boxes += len(tracked)
    return seconds, frames, boxes


def time_ours(program, detections_path):
    done = subprocess.run([program, "sort", detections_path, "--out", os.devnull], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{program} failed on {detections_path}: {done.stderr.strip()}")
    found = re.search(r"(\d+) frames, (\d+) boxes; ([\d.]+) s in the tracker", done.stderr)
    return float(found[3]), int(found[1]), int(found[2])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--reference", type=Path, required=True, help="abewley/sort's sort.py")
    add("--mot", type=Path, default=PROJECT / "target/release/mot", help="the program [default: target/release/mot]")
    add("--data", help="the folder that holds mot/ [default: INFOPART_DATA]")
    add("--runs", type=int, default=5, help="runs of either, of which the fastest counts [default: 5]")
    options = parser.parse_args()
    options.mot = options.mot.resolve()
    if not os.access(options.mot, os.X_OK):
        fail(f"no program at {options.mot}: run `cargo build --release --workspace`, or give its path with --mot")
    files = sorted(data_folder(options.data, ["mot"]).glob("mot/*/det/det.txt"))
    if not files:
        fail("no mot/SEQ/det/det.txt: give the folder that holds mot/ with --data")
    module = load_reference(options.reference)
    print(f"{'sequence':16} {'frames':>6} {'boxes':>6} {'reference':>11} {'ours':>12} {'times as fast':>14}")
    total = [0, 0.0, 0.0]
    for path in files:
        # In turn, so that what else the machine does meets both.
        pairs = [(time_reference(module, path), time_ours(options.mot, path)) for _ in range(options.runs)]
        (theirs, frames, boxes), ours = min(pair[0] for pair in pairs), min(pair[1] for pair in pairs)
        if boxes != ours[2]:
            fail(f"{path}: the reference reports {boxes} boxes, ours {ours[2]}")
        total = [total[0] + frames, total[1] + theirs, total[2] + ours[0]]
        show(path.parent.parent.name, frames, boxes, theirs, ours[0])
    show("all", total[0], "", total[1], total[2])


def show(name, frames, boxes, theirs, ours):
    print(f"{name:16} {frames:>6} {boxes:>6} {frames / theirs:>7.1f} fps {frames / ours:>8.0f} fps {theirs / ours:>13.0f}x")


if __name__ == "__main__":
    main()
