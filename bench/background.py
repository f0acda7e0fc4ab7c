#!/usr/bin/env python3
"""Compares the background model with OpenCV's bgsegm MOG at the same settings on a video with ground-truth boxes.

Two figures over the frames: the mean IoU of the raw masks, and the share of the true boxes that a blob of the cleaned
mask overlaps by at least one half, for either. Both masks are cleaned in the same way: opening, closing, holes, smallest
area. Needs `cargo build --release`; data as for rivals.py: video/view1_vtest.avi, mot/PETS09-S2L1/gt/gt.txt.
"""

import argparse
import csv
import subprocess
import tempfile
from collections import defaultdict
from pathlib import Path

import cv2
import numpy as np
from rivals import executable, table
from sequences import PROJECT, data_folder, fail


def ours(options, video, folder):
    """Raw masks' folder, {frame: boxes}, and what the program tells of its speed."""
    masks, blobs = Path(folder) / "masks", Path(folder) / "blobs.csv"
    command = [options.infopart, "background", video, "--masks", masks, "--blobs", blobs, "--frame", options.last]
    command += ["--history", options.history, "--components", options.components, "--background-ratio", options.ratio]
    command += ["--noise-sigma", options.noise, "--component-rate", options.component_rate]
    command += ["--opening", options.opening, "--closing", options.closing, "--min-area", options.min_area]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{options.infopart} failed with exit code {done.returncode}: {done.stderr.strip()}")
    boxes = defaultdict(list)
    for row in csv.DictReader(blobs.open()):
        boxes[int(row["frame"])].append([float(row[key]) for key in "xywh"])
    return masks, boxes, done.stderr.strip()


def cleaned(mask, options):
    square = lambda side: np.ones((side, side), np.uint8)
    mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, square(options.opening))
    mask = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, square(options.closing))
    outside = np.pad(mask, 1)
    cv2.floodFill(outside, None, (0, 0), 255, flags=4)
    return mask | ~outside[1:-1, 1:-1]


def blobs_of(mask, options):
    _, _, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    return [row[:4].astype(float) for row in stats[1:] if row[4] >= options.min_area]


def overlap(a, b):
    w = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    h = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    shared = max(w, 0) * max(h, 0)
    return shared / (a[2] * a[3] + b[2] * b[3] - shared)


def recalled(truth, blobs):
    return sum(any(overlap(box, blob) >= 0.5 for blob in blobs) for box in truth)


def true_boxes(path):
    """{frame: boxes} of the rows that count, the first pixel being 0."""
    boxes = defaultdict(list)
    for line in path.read_text().split():
        frame, _, x, y, w, h, counts = (float(word) for word in line.split(",")[:7])
        if counts == 1:
            boxes[int(frame)].append([x - 1, y - 1, w, h])
    return boxes


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--first", type=int, default=50, help="first frame that counts, from 1 [default: 50]")
    add("--last", type=int, default=795, help="last frame [default: 795]")
    add("--history", type=int, default=200)
    add("--components", type=int, default=5)
    add("--ratio", type=float, default=0.7)
    add("--noise", type=float, default=15)
    add("--component-rate", default="owned", choices=["owned", "shared"])
    add("--opening", type=int, default=3)
    add("--closing", type=int, default=15)
    add("--min-area", type=int, default=400)
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds video/ and mot/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    options.infopart = executable(options.infopart)
    return options


def main():
    options = arguments()
    data = data_folder(options.data)
    video, truth_file = data / "video/view1_vtest.avi", data / "mot/PETS09-S2L1/gt/gt.txt"
    for path in (video, truth_file):
        if not path.is_file():
            fail(f"no file {path}: give the folder that holds video/ and mot/ with --data")
    truth = true_boxes(truth_file)
    mog = cv2.bgsegm.createBackgroundSubtractorMOG(options.history, options.components, options.ratio, options.noise)
    ious, found, total, mog_time = [], [0, 0], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        masks, boxes, speed = ours(options, video, folder)
        capture = cv2.VideoCapture(str(video))
        for number in range(1, options.last + 1):
            decoded, image = capture.read()
            if not decoded:
                fail(f"{video} has only {number - 1} frames: give a smaller --last")
            start = cv2.getTickCount()
            theirs = mog.apply(image)
            mog_time += (cv2.getTickCount() - start) / cv2.getTickFrequency()
            if number < options.first:
                continue
            mine = cv2.imread(str(masks / f"{number:06}.png"), cv2.IMREAD_GRAYSCALE) == 255
            union = np.count_nonzero(mine | (theirs > 0))
            ious.append(np.count_nonzero(mine & (theirs > 0)) / union if union else 1.0)
            total += len(truth[number])
            found[0] += recalled(truth[number], boxes[number])
            found[1] += recalled(truth[number], blobs_of(cleaned(theirs, options), options))
    print(f"{video.name}, frames {options.first}-{options.last}, OpenCV {cv2.__version__}\n")
    rows = [["mean IoU of the raw masks", f"{np.mean(ious):.3f}", ""], ["worst frame", f"{np.min(ious):.3f}", ""]]
    rows.append([f"recall of {total} true boxes", *(f"{count / total:.3f}" for count in found)])
    print(table(["", "ours", "MOG"], rows))
    print(f"\nours: {speed}\nMOG: {1e3 * mog_time / options.last:.2f} ms a frame, one thread")


if __name__ == "__main__":
    main()
