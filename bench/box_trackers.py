#!/usr/bin/env python3
"""Scores the methods of `mot sort` beside the ByteTrack and the OC-SORT of roboflow's `trackers` on the same detections, each with
its own defaults, and compares OC-SORT's tracks with roboflow's box by box.

Same means: in every frame from the fifth on (roboflow's takes four frames for the first three) the same boxes, and identities that
go one to one. Ends with exit code 1 if a sequence differs. Scores are those of `mot score --rules trackeval`. Needs `cargo build
--release --workspace` and `pip install -r bench/requirements-sort.txt`. Data: mot/SEQ/{det/det.txt,gt/gt.txt} in the data folder.
"""

import argparse
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np
import supervision
from mot_program import add_options, check, detected_sequences, run, scores
from rivals import table
from trackers import ByteTrackTracker, OCSORTTracker

OURS = {
    "mot sort": [], "mot sort --max-age 30": ["--max-age", 30], "mot sort --method byte": ["--method", "byte"],
    "mot sort --method oc": ["--method", "oc"],
}
THEIRS = {"roboflow ByteTrack": ByteTrackTracker, "roboflow OC-SORT": OCSORTTracker}
# roboflow's first frames are four instead of three.
FROM = 5


def their_tracks(tracker, detections, out):
    """Writes the tracks of one of roboflow's trackers."""
    rows, lines = np.loadtxt(detections, delimiter=",", ndmin=2), []
    for frame in range(1, int(rows[:, 0].max()) + 1):
        seen = rows[rows[:, 0] == frame]
        corners = np.hstack([seen[:, 2:4], seen[:, 2:4] + seen[:, 4:6]])
        given = supervision.Detections(xyxy=corners, confidence=seen[:, 6], class_id=np.zeros(len(seen), int))
        found = tracker.update(given)
        for (x1, y1, x2, y2), identity in zip(found.xyxy, found.tracker_id):
            # Not confirmed yet.
            if identity >= 0:
                lines.append(f"{frame},{identity},{x1:.2f},{y1:.2f},{x2 - x1:.2f},{y2 - y1:.2f},1,-1,-1,-1\n")
    out.write_text("".join(lines))


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


def score_row(options, sequence, name, out):
    one = scores(options, sequence / "gt/gt.txt", out)
    shares = [f"{100 * one[key]:.1f}" for key in ("idf1", "mota", "hota")]
    return [sequence.name, name, *shares, str(one["switches"])]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_options(parser, "mot/")
    options = check(parser.parse_args())
    same, agreement, scored = True, [], []
    with tempfile.TemporaryDirectory() as folder:
        for sequence in detected_sequences(options, truth=False):
            detections = sequence / "det/det.txt"
            outs = {name: Path(folder) / f"{place}.txt" for place, name in enumerate([*OURS, *THEIRS])}
            for name, words in OURS.items():
                run(options, ["sort", detections, *words, "--out", outs[name]])
            for name, tracker in THEIRS.items():
                their_tracks(tracker(), detections, outs[name])
            ours, theirs = boxes(outs["mot sort --method oc"]), boxes(outs["roboflow OC-SORT"])
            alone, mixed = differences(ours, theirs)
            same &= alone == mixed == 0
            rows = [row for of_frame in theirs.values() for row in of_frame]
            agreement.append([sequence.name, *map(str, (len(rows), len({row[0] for row in rows}), alone, mixed))])
            if (sequence / "gt/gt.txt").exists():
                scored += [score_row(options, sequence, name, out) for name, out in outs.items()]
    print(table(["OC-SORT", "boxes", "identities", "boxes of one only", "identities mixed"], agreement), end="\n\n")
    print(table(["sequence", "tracker", "IDF1", "MOTA", "HOTA", "ID switches"], scored))
    sys.exit(not same)


if __name__ == "__main__":
    main()
