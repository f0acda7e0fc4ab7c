#!/usr/bin/env python3
"""Cuts single people out of a crowd: sequences that no default was tuned to.

Makes OTB folders FOLDER/otb/petsK of every identity K of PETS09-S2L1 that its ground truth follows for at least 60 frames
without a gap, inside the picture; of each the longest such run, its first 250 frames. `--data FOLDER` shows them to
rivals.py, which with `--sequences crowd` tracks all. Needs ffmpeg; data as for rivals.py.
"""

import argparse
import os
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

from sequences import CROWD, data_folder, fail

WIDTH, HEIGHT = 768, 576
BORDER = 10  # Pixels that a box must keep from the picture's sides; half of it from top and bottom.
SHORTEST, LONGEST = 60, 250


def boxes_by_identity(path):
    """{identity: {frame: (x, y, w, h)}} of the rows that count."""
    found = defaultdict(dict)
    for line in path.read_text().splitlines():
        frame, identity, *box, counts = [float(number) for number in line.split(",")[:7]]
        if counts == 1:
            found[int(identity)][int(frame)] = tuple(box)
    return found


def inside(box):
    x, y, w, h = box
    return x > BORDER and y > BORDER / 2 and x + w < WIDTH - BORDER and y + h < HEIGHT - BORDER / 2


def longest_run(boxes):
    """The frames of the longest run without a gap, from and to where the box is inside the picture."""
    runs = []
    for frame in sorted(boxes):
        if runs and frame == runs[-1][-1] + 1:
            runs[-1].append(frame)
        else:
            runs.append([frame])
    run = max(runs, key=len)
    kept = [number for number, frame in enumerate(run) if inside(boxes[frame])]
    return run[kept[0] : kept[-1] + 1][:LONGEST] if kept else []


def write(folder, run, boxes, frames):
    (folder / "img").mkdir(parents=True, exist_ok=True)
    rows = [",".join(f"{side:.2f}" for side in boxes[frame]) for frame in run]
    (folder / "groundtruth_rect.txt").write_text("\n".join(rows) + "\n")
    for number, frame in enumerate(run, 1):
        link = folder / "img" / f"{number:04}.jpg"
        link.unlink(missing_ok=True)
        link.symlink_to(os.path.relpath(frames / f"{frame:04}.jpg", link.parent))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="where the sequences go")
    parser.add_argument("--data", help="the folder that holds video/ and mot/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    data = data_folder(options.data, ["mot"])
    video, truth = data / "video/view1_vtest.avi", data / "mot/PETS09-S2L1/gt/gt.txt"
    for path in (video, truth):
        if not path.is_file():
            fail(f"{path} is missing")
    if shutil.which("ffmpeg") is None:
        fail("ffmpeg is not installed: it reads the video; install it with your system's packages")
    frames = options.folder / "frames"
    frames.mkdir(parents=True, exist_ok=True)
    subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", video, "-q:v", "2", frames / "%04d.jpg"], check=True)
    made = []
    for identity, boxes in sorted(boxes_by_identity(truth).items()):
        run = longest_run(boxes)
        if len(run) >= SHORTEST:
            write(options.folder / "otb" / f"pets{identity}", run, boxes, frames)
            made.append(f"pets{identity}")
    if made != CROWD:
        fail(f"made {made}, which are not those of the list `crowd`: is this another version of the data?")
    print(f"{len(made)} sequences in {options.folder}", file=sys.stderr)


if __name__ == "__main__":
    main()
