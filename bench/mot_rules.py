#!/usr/bin/env python3
"""Compares `mot score --rules trackeval --benchmark mot17` with TrackEval on generated sequences with classes.

Needs `cargo build --release --workspace` and `pip install numpy trackeval`. Each sequence has wandering objects of all classes, some
rows of confidence 0, and a result that loses, shifts, renames and invents boxes. Ends with exit code 1 if a column differs. The times are
those of the whole program and of TrackEval's evaluation, without its imports.
"""

import argparse
import contextlib
import io
import json
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from sequences import PROJECT, fail

for name, kind in (("float", float), ("int", int), ("bool", bool)):
    if not hasattr(np, name):  # TrackEval is older than numpy 1.24.
        setattr(np, name, kind)
import trackeval  # noqa: E402

COLUMNS = {
    "mota": ("CLEAR", "MOTA"), "motp_overlap": ("CLEAR", "MOTP"), "switches": ("CLEAR", "IDSW"), "misses": ("CLEAR", "CLR_FN"),
    "false_positives": ("CLEAR", "CLR_FP"), "fragments": ("CLEAR", "Frag"), "mostly_tracked": ("CLEAR", "MT"),
    "partially_tracked": ("CLEAR", "PT"), "mostly_lost": ("CLEAR", "ML"), "recall": ("CLEAR", "CLR_Re"),
    "precision": ("CLEAR", "CLR_Pr"), "false_positives_per_frame": ("CLEAR", "FP_per_frame"), "idf1": ("Identity", "IDF1"), "idp": ("Identity", "IDP"), "idr": ("Identity", "IDR"),
    "hota": ("HOTA", "HOTA"), "deta": ("HOTA", "DetA"), "assa": ("HOTA", "AssA"),
}


def generate(rng, frames):
    truth, result = [], []
    for identity in range(1, rng.randint(2, 9)):
        x, y, w, h = rng.uniform(0, 300), rng.uniform(0, 200), rng.uniform(15, 40), rng.uniform(30, 80)
        # One at least counts: a sequence without is refused.
        label = 1 if identity == 1 else rng.choice([1, 1, 1, *range(1, 13)])
        counts = int(identity == 1 or (label == 1 and rng.random() < 0.9))
        start, end, name = rng.randint(1, frames // 2), rng.randint(frames // 2, frames), identity
        for frame in range(start, end + 1):
            x, y = x + rng.uniform(-6, 6), y + rng.uniform(-4, 4)
            truth.append([frame, identity, x, y, w, h, counts, label, round(rng.random(), 2)])
            name = rng.randint(20, 10**6) if rng.random() < 0.05 else name
            if rng.random() < 0.8:
                off = lambda size: size * rng.uniform(-0.25, 0.25)
                result.append([frame, name, x + off(w), y + off(h), w, h, 1, -1, -1, -1])
    result += [[rng.randint(1, frames), 10**7 + i, rng.uniform(0, 300), rng.uniform(0, 200), 30, 60, 1, -1, -1, -1]
               for i in range(rng.randint(0, 8))]
    rng.shuffle(truth)
    rng.shuffle(result)
    return truth, result


def write(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(",".join(f"{value:.2f}" if isinstance(value, float) else str(value) for value in row) + "\n" for row in rows))


def theirs(folder, names, frames):
    config = {
        "GT_FOLDER": str(folder / "gt"), "TRACKERS_FOLDER": str(folder / "trackers"), "TRACKERS_TO_EVAL": ["T"], "BENCHMARK": "MOT17",
        "SEQ_INFO": {name: frames for name in names}, "SKIP_SPLIT_FOL": True, "PRINT_CONFIG": False, "TRACKER_SUB_FOLDER": "",
    }
    evaluation = {"PRINT_RESULTS": False, "PRINT_CONFIG": False, "TIME_PROGRESS": False, "OUTPUT_SUMMARY": False,
                  "OUTPUT_DETAILED": False, "PLOT_CURVES": False, "OUTPUT_EMPTY_CLASSES": False}
    metrics = [trackeval.metrics.HOTA(), trackeval.metrics.CLEAR({"PRINT_CONFIG": False}), trackeval.metrics.Identity({"PRINT_CONFIG": False})]
    with contextlib.redirect_stdout(io.StringIO()):
        found, _ = trackeval.Evaluator(evaluation).evaluate([trackeval.datasets.MotChallenge2DBox(config)], metrics)
    return found["MotChallenge2DBox"]["T"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=300, help="sequences [default: 300]")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--mot", type=Path, default=PROJECT / "target/release/mot", help="the program [default: target/release/mot]")
    options = parser.parse_args()
    rng, frames = random.Random(options.seed), 40
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        names = [f"S{index:04}" for index in range(options.pairs)]
        for name in names:
            truth, result = generate(rng, frames)
            write(folder / "gt" / name / "gt/gt.txt", truth)
            write(folder / "trackers/T" / f"{name}.txt", result)
            (folder / "gt" / name / "seqinfo.ini").write_text(f"[Sequence]\nname={name}\nseqLength={frames}\n")
        words = ["score", folder / "gt", folder / "trackers/T", "--rules", "trackeval", "--benchmark", "mot17", "--json", folder / "s.json"]
        start = time.perf_counter()
        done = subprocess.run([options.mot, *map(str, words)], capture_output=True, text=True)
        seconds = time.perf_counter() - start
        if not (folder / "s.json").is_file():
            fail(f"{options.mot} failed: {done.stderr.strip()}")
        ours = {one["sequence"]: one["scores"] for one in json.loads((folder / "s.json").read_text())["sequences"]}
        start = time.perf_counter()
        found = theirs(folder, [name for name in names if name in ours], frames)
        their_seconds = time.perf_counter() - start
    worst, compared = 0.0, 0
    for name, scores in ours.items():
        of_name = found["COMBINED_SEQ" if name == "OVERALL" else name]["pedestrian"]
        for column, (metric, key) in COLUMNS.items():
            value = float(np.mean(of_name[metric][key]))
            if scores[column] is None:
                continue
            compared += 1
            worst = max(worst, abs(scores[column] - value))
            if abs(scores[column] - value) > 1e-6:
                print(f"{name}: {column} is {scores[column]} and TrackEval's {value}")
    print(f"{len(ours)} rows, {len(names) - len(ours) + 1} sequences without a row that counts, {compared} numbers; largest difference {worst:.1e}")
    print(f"{seconds:.3f} s, TrackEval on one core {their_seconds:.2f} s: {their_seconds / seconds:.0f} times as long")
    sys.exit(worst > 1e-6)


if __name__ == "__main__":
    main()
