#!/usr/bin/env python3
"""Measures `mot track` beside what a user would write first: OpenCV's MOG2 with SORT behind it, on the same videos in one run.

MOG2 has varThreshold 16, its shadows are dropped, the mask is opened by 3 x 3 and closed by 7 x 7 (a second rival does not
close it), regions of at least 400 pixels are detections, and SORT (max_age 15, IoU 0.2) tracks them. With --reference, the path
of abewley/sort's sort.py, that is the SORT; else it is `mot sort`, which gives the same tracks, and the rival's time is then
without its tracker. Printed are MOTA, IDF1, HOTA (TrackEval's rules) and what they count, frames a second with decoding
(the fastest of --runs, in turn), processor time a frame (likewise; all threads and the decoder's process), and, of the tracks themselves: jumps, steps from one report to the next in which the centre moves
by more than 1.5 times the shorter side, and the share of steps that halve or double an area.

Needs `cargo build --release --workspace` and bench/requirements.txt (--reference also bench/requirements-sort.txt). A clip is
NAME=VIDEO or NAME=VIDEO,GT, where VIDEO may be images, DIR/%%04d.jpg; the usual ones are in the data folder.
"""

import argparse
import resource
import tempfile
import time
from collections import defaultdict
from pathlib import Path

import cv2
import numpy as np
from mot_program import add_options, check, run, scores
from rivals import table
from sequences import fail

CLIPS = [
    "PETS09-S2L1=video/view1_vtest.avi,mot/PETS09-S2L1/gt/gt.txt", "atrium=video/atrium.mp4",
    "Sample1=video/landzs/Sample1.mp4", "Sample2=video/landzs/Sample2.mp4", "Sample3=video/landzs/Sample3.mp4",
]
RIVALS = {"MOG2 + SORT": 7, "MOG2 + SORT, no closing": 1}


def detections_of(video, closing):
    """Boxes [x1, y1, x2, y2, 1] of each frame, the first pixel being 0."""
    model = cv2.createBackgroundSubtractorMOG2(varThreshold=16, detectShadows=True)
    square = lambda side: np.ones((side, side), np.uint8)
    # The backend is named: another may take a pattern of images for a camera.
    capture = cv2.VideoCapture(str(video), cv2.CAP_FFMPEG)
    while True:
        decoded, image = capture.read()
        if not decoded:
            return
        mask = np.where(model.apply(image) == 255, 255, 0).astype(np.uint8)
        mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, square(3))
        if closing > 1:
            mask = cv2.morphologyEx(mask, cv2.MORPH_CLOSE, square(closing))
        _, _, stats, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
        found = stats[1:][stats[1:, cv2.CC_STAT_AREA] >= 400, :4].astype(float)
        yield np.hstack([found[:, :2], found[:, :2] + found[:, 2:], np.ones((len(found), 1))])


def run_rival(options, reference, video, closing, out):
    """Writes the rival's tracks; gives frames, and seconds by the clock and of the processors."""
    start, frames = clocks(), 0
    rows = []
    tracker = reference.Sort(max_age=15, min_hits=3, iou_threshold=0.2) if reference else None
    for found in detections_of(video, closing):
        frames += 1
        boxes = tracker.update(found) if tracker else found
        for x1, y1, x2, y2, identity in boxes:
            identity = int(identity) if tracker else -1
            rows.append(f"{frames},{identity},{x1 + 1:.2f},{y1 + 1:.2f},{x2 - x1:.2f},{y2 - y1:.2f},1,-1,-1,-1\n")
    seconds = since(start)
    if not frames:
        fail(f"{video}: OpenCV reads no frame of it")
    out.write_text("".join(rows))
    if not tracker:
        detections = out.with_suffix(".det")
        out.rename(detections)
        words = ["sort", detections, "--max-age", 15, "--iou", 0.2, "--min-hits", 3, "--out", out]
        run(options, words) if rows else out.write_text("")
    return frames, seconds


def clocks():
    """Seconds by the clock, and those that the processors gave to this process and those it waited for."""
    spent = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return np.array([time.perf_counter(), sum(one.ru_utime + one.ru_stime for one in spent)])


def since(start):
    return clocks() - start


def run_ours(options, video, out):
    start = clocks()
    # OpenCV reads images by a pattern, `mot track` by their folder.
    images = video.parent if "%" in video.name else video
    run(options, ["track", images, "--out", out, *options.flags.split()])
    return since(start)


def steadiness(path):
    """Jumps, steps that halve or double an area, and steps: between reports of one track that follow each other."""
    tracks = defaultdict(list)
    for line in path.read_text().split():
        frame, identity, x, y, w, h = (float(word) for word in line.split(",")[:6])
        tracks[identity].append((frame, x + w / 2, y + h / 2, w, h))
    jumps = leaps = steps = 0
    for rows in tracks.values():
        rows.sort()
        for (_, x, y, w, h), (_, x2, y2, w2, h2) in zip(rows, rows[1:]):
            steps += 1
            jumps += np.hypot(x2 - x, y2 - y) > 1.5 * min(w, h)
            leaps += not 0.5 < w2 * h2 / (w * h) < 2
    return jumps, leaps, steps


def row(options, clip, name, truth, out, seconds_a_frame):
    jumps, leaps, steps = steadiness(out)
    cells = ["-"] * 6
    if truth:
        one = scores(options, truth, out)
        percent = [f"{100 * (one[key] or 0):.1f}" for key in ("mota", "idf1", "hota")]
        cells = percent + [str(one[key]) for key in ("switches", "false_positives", "misses")]
    share = f"{100 * leaps / max(steps, 1):.2f} %"
    clock, processors = seconds_a_frame
    return [clip, name, *cells, f"{1 / clock:.1f}", f"{1000 * processors:.2f}", str(jumps), share]


def clips(options):
    for text in options.clips or CLIPS:
        name, _, files = text.partition("=")
        video, _, truth = files.partition(",")
        if not video:
            fail(f"--clips {text}: give NAME=VIDEO or NAME=VIDEO,GT")
        found = [options.data / path if not Path(path).exists() else Path(path) for path in (video, truth) if path]
        # A pattern of images, like img/%06d.jpg, is no file.
        for path in found:
            if not path.exists() and "%" not in path.name:
                fail(f"no file {path}: give the data's folder with --data, or the clip by its path")
        yield name, found[0], found[1] if truth else None


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--clips", nargs="+", metavar="NAME=VIDEO[,GT]", help="videos and their ground truth [default: the data's five]")
    add("--flags", default="", metavar="'WORDS'", help="more flags of mot track, as one word")
    add("--reference", type=Path, help="abewley/sort's sort.py [default: `mot sort`, untimed]")
    add("--runs", type=int, default=1, help="runs of each, of which the fastest counts [default: 1]")
    add_options(parser, "video/ and mot/")
    add("--keep", type=Path, help="a folder for the tracks")
    return check(parser.parse_args(), ["video"])


def main():
    options = arguments()
    reference = None
    if options.reference:
        from sort import load_reference

        reference = load_reference(options.reference)
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        for clip, video, truth in clips(options):
            outs = {name: folder / f"{clip}_{place}.txt" for place, name in enumerate(["mot track", *RIVALS])}
            times = defaultdict(list)
            for _ in range(options.runs):
                times["mot track"].append(run_ours(options, video, outs["mot track"]))
                for name, closing in RIVALS.items():
                    frames, seconds = run_rival(options, reference, video, closing, outs[name])
                    times[name].append(seconds)
            for name, out in outs.items():
                rows.append(row(options, clip, name, truth, out, np.min(times[name], axis=0) / frames))
    print(table(["clip", "", "MOTA", "IDF1", "HOTA", "IDs", "FP", "FN", "frames/s", "CPU ms", "jumps", "leaps"], rows))


if __name__ == "__main__":
    main()
