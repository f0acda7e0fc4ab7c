#!/usr/bin/env python3
"""Scores `mot sort --method byte` and `mot sort` beside the ByteTrack of roboflow's `trackers` on the same detections.

Each tracker has its own defaults. Scores are those of `mot score --rules trackeval`. Needs `cargo build --release --workspace` and
`pip install -r bench/requirements-sort.txt`. Data: mot/SEQ/{det/det.txt,gt/gt.txt} in the data folder.
"""

import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import supervision
from sequences import PROJECT, data_folder, fail
from trackers import ByteTrackTracker


def run(program, words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{program} failed with exit code {done.returncode}: {done.stderr.strip()}")


def their_tracks(tracker, detections, out):
    """Writes the tracks of one of roboflow's trackers; gives the seconds in it."""
    rows = np.loadtxt(detections, delimiter=",", ndmin=2)
    seconds, lines = 0.0, []
    for frame in range(1, int(rows[:, 0].max()) + 1):
        seen = rows[rows[:, 0] == frame]
        corners = np.hstack([seen[:, 2:4], seen[:, 2:4] + seen[:, 4:6]])
        given = supervision.Detections(xyxy=corners, confidence=seen[:, 6], class_id=np.zeros(len(seen), int))
        start = time.perf_counter()
        found = tracker.update(given)
        seconds += time.perf_counter() - start
        for (x1, y1, x2, y2), identity in zip(found.xyxy, found.tracker_id):
            # Not confirmed yet.
            if identity >= 0:
                lines.append(f"{frame},{identity},{x1:.2f},{y1:.2f},{x2 - x1:.2f},{y2 - y1:.2f},1,-1,-1,-1\n")
    out.write_text("".join(lines))
    return seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--mot", type=Path, default=PROJECT / "target/release/mot", help="the program [default: target/release/mot]")
    add("--data", help="the folder that holds mot/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    if not os.access(options.mot, os.X_OK):
        fail(f"no program at {options.mot}: run `cargo build --release --workspace`, or give its path with --mot")
    print("| sequence | tracker | IDF1 | MOTA | HOTA | ID switches |\n| --- | --- | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        for truth in sorted(data_folder(options.data, ["mot"]).glob("mot/*/gt/gt.txt")):
            sequence = truth.parent.parent
            detections = sequence / "det/det.txt"
            outs = {name: Path(folder) / f"{sequence.name}_{place}.txt" for place, name in enumerate(
                ["mot sort", "mot sort --max-age 30", "mot sort --method byte", "roboflow ByteTrack"])}
            for name, out in list(outs.items())[:3]:
                run(options.mot, [*name.split()[1:], detections, "--out", out])
            their_tracks(ByteTrackTracker(), detections, outs["roboflow ByteTrack"])
            for name, out in outs.items():
                scored = out.with_suffix(".json")
                run(options.mot, ["score", truth, out, "--rules", "trackeval", "--json", scored])
                one = json.loads(scored.read_text())["sequences"][0]["scores"]
                shares = " | ".join(f"{100 * one[key]:.1f}" for key in ("idf1", "mota", "hota"))
                print(f"| {sequence.name} | {name} | {shares} | {one['switches']} |")


if __name__ == "__main__":
    main()
