#!/usr/bin/env python3
"""Compares `mot sort --method oc` with the OC-SORT of roboflow's `trackers` on the same detections, and scores both where there is
ground truth, beside SORT and ByteTrack's association.

Same means: in every frame from the fifth on (roboflow's takes four frames for the first three) the same boxes, and identities that
go one to one. Ends with exit code 1 if a sequence differs. Scores are those of `mot score --rules trackeval`. Needs `cargo build
--release --workspace` and `pip install -r bench/requirements-sort.txt`. Data: mot/SEQ/{det/det.txt,gt/gt.txt} in the data folder.
"""

import argparse
import json
import os
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from byte import run, their_tracks
from sequences import PROJECT, data_folder, fail
from trackers import OCSORTTracker

METHODS = {"mot sort": [], "mot sort --method byte": ["--method", "byte"], "mot sort --method oc": ["--method", "oc"]}
# roboflow's first frames are four instead of three.
FROM = 5


def boxes(path):
    """[identity, x, y, w, h] of each frame."""
    found = defaultdict(list)
    for line in path.read_text().split():
        frame, identity, *box = (float(value) for value in line.split(",")[:6])
        if frame >= FROM:
            found[frame].append([identity, *box])
    return found


def differences(ours, theirs):
    """Boxes of one but not the other, and identities that do not go one to one. The same box is so to .06 pixels: both files round."""
    alone, forth, back = 0, defaultdict(set), defaultdict(set)
    for frame in ours.keys() | theirs.keys():
        left = list(ours[frame])
        for name, *box in theirs[frame]:
            same = [one for one in left if max(abs(a - b) for a, b in zip(one[1:], box)) < 0.06]
            if same:
                left.remove(same[0])
                forth[same[0][0]].add(name)
                back[name].add(same[0][0])
            alone += not same
        alone += len(left)
    return alone, sum(len(names) > 1 for names in [*forth.values(), *back.values()])


def scored(options, truth, out):
    file = out.with_suffix(".json")
    run(options.mot, ["score", truth, out, "--rules", "trackeval", "--json", file])
    one = json.loads(file.read_text())["sequences"][0]["scores"]
    return " | ".join(f"{100 * one[key]:.1f}" for key in ("idf1", "mota", "hota")) + f" | {one['switches']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--mot", type=Path, default=PROJECT / "target/release/mot", help="the program [default: target/release/mot]")
    add("--data", help="the folder that holds mot/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    if not os.access(options.mot, os.X_OK):
        fail(f"no program at {options.mot}: run `cargo build --release --workspace`, or give its path with --mot")
    same, agreement, scores = True, [], []
    with tempfile.TemporaryDirectory() as folder:
        for detections in sorted(data_folder(options.data, ["mot"]).glob("mot/*/det/det.txt")):
            sequence = detections.parent.parent
            outs = {name: Path(folder) / f"{sequence.name}_{place}.txt" for place, name in enumerate([*METHODS, "roboflow"])}
            for name, words in METHODS.items():
                run(options.mot, ["sort", detections, *words, "--out", outs[name]])
            their_tracks(OCSORTTracker(), detections, outs["roboflow"])
            ours, theirs = boxes(outs["mot sort --method oc"]), boxes(outs["roboflow"])
            alone, mixed = differences(ours, theirs)
            same &= alone == mixed == 0
            rows = [row for of_frame in theirs.values() for row in of_frame]
            agreement.append(f"| {sequence.name} | {len(rows)} | {len({row[0] for row in rows})} | {alone} | {mixed} |")
            truth = sequence / "gt/gt.txt"
            if truth.exists():
                scores += [f"| {sequence.name} | {name} | {scored(options, truth, out)} |" for name, out in outs.items()]
    print("| sequence | boxes | identities | boxes of one only | identities mixed |\n| --- | ---: | ---: | ---: | ---: |")
    print("\n".join(agreement))
    print("\n| sequence | tracker | IDF1 | MOTA | HOTA | ID switches |\n| --- | --- | ---: | ---: | ---: | ---: |")
    print("\n".join(scores))
    sys.exit(not same)


if __name__ == "__main__":
    main()
