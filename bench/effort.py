#!/usr/bin/env python3
"""Counts how often a simulated annotator must draw a box until every frame of a sequence has a good one.

The annotator knows the ground truth. It draws the first box, and with `worst frame` also the last; then it corrects one frame after
another whose overlap is below a threshold, until there is none. `first frame` corrects the first such frame, as somebody does who
watches a tracker; `worst frame` the one of least overlap. Every drawn box counts. Frames in which the target is absent are not scored,
and nobody draws there.

  interpolation   straight lines between the drawn boxes; worst frame
  CSRT, NanoTrack OpenCV's trackers, restarted at each correction; first frame
  forward         infopart annotate --sides forward; first frame
  both, first     infopart annotate; first frame
  both            infopart annotate; worst frame

Behind the counts stands what fusion is worth: mean AUC with the first and the last box drawn, forward and from both sides. Needs `cargo
build --release`; data as for rivals.py.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import rivals
from rivals import decode, executable, fail, load_numpy, read_sequence, score, table, usual_models
from sequences import NAMES_HELP, PROJECT, data_folder, expand, locate, region_flags

METHODS = ["interpolation", "CSRT", "NanoTrack", "forward", "both, first", "both"]
OPENCV = {"CSRT", "NanoTrack"}


class Program:
    """`infopart annotate --serve` over one sequence: boxes from key frames, as rows of the ground truth count."""

    def __init__(self, program, sequence, flags):
        command = [program, "annotate", sequence.folder, "--serve", "--threads", "1", *region_flags(sequence.name), *flags]
        command += ["--target", sequence.target] if sequence.target else []
        self.process = subprocess.Popen(
            [str(word) for word in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.name, self.tracked = sequence.name, 0

    def boxes(self, keys, sides):
        request = {
            "sides": sides,
            "keys": [{"frame": frame + 1, "box": [x - 1, y - 1, w, h]} for frame, (x, y, w, h) in sorted(keys.items())],
        }
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        answer = json.loads(line) if line else {"error": "it ended"}
        if "error" in answer:
            fail(f"infopart annotate failed on {self.name}: {answer['error']}")
        self.tracked += answer["tracked"]
        nowhere = [-1e6, -1e6, 1.0, 1.0]
        rows = rivals.np.array([box or nowhere for box in answer["boxes"]], float)
        rows[:, :2] += 1
        return rows

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def straight_lines(keys, count):
    frames = sorted(keys)
    known = rivals.np.array([keys[frame] for frame in frames])
    return rivals.np.stack([rivals.np.interp(range(count), frames, known[:, side]) for side in range(4)], axis=1)


def corrections(boxes_of, truth, present, threshold, worst):
    """How many boxes are drawn until no frame is below the threshold; `boxes_of` makes rows of drawn boxes."""
    drawn = [present[0], present[-1]] if worst else [present[0]]
    keys = {int(frame): truth[frame].tolist() for frame in drawn}
    while True:
        overlap = rivals.overlaps(boxes_of(keys)[present], truth[present])
        bad = rivals.np.flatnonzero(~(overlap >= threshold))
        if len(bad) == 0:
            return len(keys)
        frame = int(present[bad[rivals.np.argmin(overlap[bad])] if worst else bad[0]])
        if frame in keys:
            fail(f"the box that was drawn in frame {frame + 1} does not stand there")
        keys[frame] = truth[frame].tolist()


def restarts(name, models, images, truth, present, threshold):
    """The same for a tracker that goes forward only: it is restarted on each bad frame."""
    tracker, count, frames = None, 0, set(present.tolist())
    for frame in range(int(present[0]), len(images)):
        box = None
        if tracker is not None:
            found, box = tracker.update(images[frame])
            box = rivals.np.array([[box[0] + 1, box[1] + 1, box[2], box[3]]], float) if found else None
        if frame not in frames:
            continue
        if box is None or not rivals.overlaps(box, truth[frame : frame + 1])[0] >= threshold:
            tracker, count = rivals.started(name, models, images[frame], truth[frame]), count + 1
    return count


def measure(sequence, options):
    truth = sequence.truth
    np = rivals.np
    present = np.flatnonzero(np.isfinite(truth).all(axis=1) & (truth[:, 2:] > 0).all(axis=1))
    images = [decode(path) for path in sequence.files] if OPENCV & set(options.methods) else []
    program = Program(options.infopart, sequence, options.flag)
    found = {"frames": len(present), "drawn": {}, "auc": {}}
    ends = {int(frame): truth[frame].tolist() for frame in (present[0], present[-1])}
    for sides in ("forward", "both"):
        found["auc"][sides] = score(program.boxes(ends, sides), truth)["auc"]
    for threshold in options.thresholds:
        for method in options.methods:
            if method == "interpolation":
                drawn = corrections(lambda keys: straight_lines(keys, len(truth)), truth, present, threshold, True)
            elif method in OPENCV:
                drawn = restarts(method, options.models, images, truth, present, threshold)
            else:
                sides = "forward" if method == "forward" else "both"
                boxes_of = lambda keys: program.boxes(keys, sides)
                drawn = corrections(boxes_of, truth, present, threshold, method == "both")
            found["drawn"][f"{method} {threshold}"] = drawn
    program.close()
    found["tracked"] = program.tracked
    print(f"{sequence.name}: {found['drawn']}", file=sys.stderr, flush=True)
    return found


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--sequences", nargs="+", default=["people19"], metavar="NAME", help=f"{NAMES_HELP} [default: people19]")
    add("--methods", nargs="+", default=METHODS, choices=METHODS, help="[default: all]")
    add("--thresholds", nargs="+", type=float, default=[0.5, 0.7], help="least overlap of a good box [default: 0.5 0.7]")
    add("--flag", action="append", default=[], help="a flag for infopart annotate, such as --flag=--seed=2")
    add("--jobs", type=int, default=os.cpu_count(), help="sequences at the same time [default: one a core]")
    add("--models", type=Path, metavar="DIR", help="NanoTrack's networks [default: models/nanotrack_v2 of the data folder]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    add("--json", metavar="FILE", help="write every number to FILE")
    return parser.parse_args()


def main():
    options = arguments()
    load_numpy()
    if OPENCV & set(options.methods):
        os.environ.setdefault("OPENCV_LOG_LEVEL", "ERROR")
        try:
            import cv2
        except ImportError as error:
            fail(f"{error}: pip install -r {PROJECT / 'bench/requirements.txt'}, or leave out {' and '.join(OPENCV)}")
        rivals.cv2 = cv2
        cv2.setNumThreads(1)
    options.infopart = executable(options.infopart)
    data = data_folder(options.data)
    options.models = options.models or usual_models(data)
    sequences = [read_sequence(name, *locate(data, name)) for name in expand(options.sequences)]
    with ThreadPoolExecutor(options.jobs) as pool:
        all_found = dict(zip([sequence.name for sequence in sequences], pool.map(lambda s: measure(s, options), sequences)))
    frames = sum(found["frames"] for found in all_found.values())
    for threshold in options.thresholds:
        cells = lambda found: [str(found["drawn"][f"{method} {threshold}"]) for method in options.methods]
        rows = [[name, str(found["frames"]), *cells(found)] for name, found in all_found.items()]
        total = lambda method: sum(found["drawn"][f"{method} {threshold}"] for found in all_found.values())
        rows.append(["per 1,000 frames", str(frames), *(f"{1000 * total(method) / frames:.1f}" for method in options.methods)])
        print(table([f"boxes drawn, overlap {threshold}", "frames", *options.methods], rows) + "\n")
    auc = {sides: statistics.mean(found["auc"][sides] for found in all_found.values()) for sides in ("forward", "both")}
    print(f"mean AUC with the first and the last box drawn: forward {auc['forward']:.3f}, both {auc['both']:.3f}")
    if options.json:
        Path(options.json).write_text(json.dumps(all_found, indent=1) + "\n")


if __name__ == "__main__":
    main()
