#!/usr/bin/env python3
"""What InfoPart says of people who have left the picture: whether it knows that they are gone.

Follows everyone of PETS09-S2L1 whose ground truth ends at a side of the picture, from 60 frames before that end to 40
frames after it, and counts the states of the frames from the fifth after the end on. Only passes count that were still on
their target five frames before the end (overlap above one half). Needs ffmpeg and `cargo build --release`; data as for
rivals.py.
"""

import argparse
import csv
import io
import subprocess
from collections import Counter

from crowd import HEIGHT, WIDTH, boxes_by_identity
from rivals import executable, table
from sequences import PROJECT, data_folder, fail

EDGE = 15  # Pixels from a side within which a last box has left.
BEFORE, AFTER, GONE = 60, 40, 5
FRAMES = 795  # Of the video.
STATES = ("tracking", "uncertain", "lost")


def leaves(box):
    x, y, w, h = box
    return x < EDGE or y < EDGE or x + w > WIDTH - EDGE or y + h > HEIGHT - EDGE


def overlap(a, b):
    side = lambda k: max(0.0, min(a[k] + a[k + 2], b[k] + b[k + 2]) - max(a[k], b[k]))
    common = side(0) * side(1)
    return common / (a[2] * a[3] + b[2] * b[3] - common)


def leavers(truth):
    """(identity, first frame, last frame, {frame: box}) of everyone who leaves; a gap ends a person's frames."""
    for identity, boxes in sorted(boxes_by_identity(truth).items()):
        last = max(boxes)
        first = last
        while first - 1 in boxes and first > last - BEFORE:
            first -= 1
        while leaves(boxes[first]) and first < last:
            first += 1
        if leaves(boxes[last]) and last + AFTER <= FRAMES and last - first > 2 * GONE:
            yield identity, first, last, boxes


def states(program, video, seed, first, last, boxes):
    """The overlap shortly before the end, and how often each state was said after it."""
    x, y, w, h = boxes[first]  # The ground truth counts pixels from 1, a video's from 0.
    command = [program, "track", video, "--init", f"{x - 1},{y - 1},{w},{h}", "--start", first, "--end", last + AFTER]
    command += ["--seed", seed, "--threads", 1, "--format", "csv", "--quiet"]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{program} failed with exit code {done.returncode}: {done.stderr.strip()}")
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    row = rows[last - GONE - first]
    x, y, w, h = boxes[last - GONE]
    return overlap([float(row[key]) for key in "xywh"], (x - 1, y - 1, w, h)), Counter(
        row["status"] for row in rows[last + GONE - first:]
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3, help="seeds 1 to this [default: 3]")
    parser.add_argument("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    parser.add_argument("--data", help="the folder that holds video/ and mot/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    program, data = executable(options.infopart), data_folder(options.data, ["mot"])
    video, truth = data / "video/view1_vtest.avi", data / "mot/PETS09-S2L1/gt/gt.txt"
    for path in (video, truth):
        if not path.is_file():
            fail(f"{path} is missing")
    lines, everyone = [], Counter()
    for identity, first, last, boxes in leavers(truth):
        passes = [states(program, video, seed, first, last, boxes) for seed in range(1, options.seeds + 1)]
        followed = [counts for before, counts in passes if before > 0.5]
        counts = sum(followed, Counter())
        everyone += counts
        lines.append([f"{identity}, frames {first}-{last}", f"{len(followed)} of {len(passes)}", *(str(counts[state]) for state in STATES)])
    total = max(1, everyone.total())
    lines.append(["share of all", "", *(f"{everyone[state] / total:.2f}" for state in STATES)])
    print(table(["person", "passes that followed to the end", *STATES], lines))


if __name__ == "__main__":
    main()
