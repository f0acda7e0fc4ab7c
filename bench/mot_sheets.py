#!/usr/bin/env python3
"""Draws a sheet of each clip: five frames as `mot track --preset paper` annotates them, and below them as `mot track` does.

Needs `cargo build --release --workspace` and bench/requirements.txt. Frames lie at 1/6, 2/6 ... 5/6 of the clip. The sheets of docs/ are
those of the usual clips with the usual width.
"""

import argparse
import tempfile
from pathlib import Path

import cv2
import numpy as np
from mot_program import add_options, check, run
from mot_track import CLIPS
from sequences import PROJECT, fail

PRESETS = ("paper", "default")


def annotated(options, video, preset, folder):
    """Pictures of five frames, all of one width."""
    run(options, ["track", video, "--preset", preset, "--annotate", folder, "--out", folder.with_suffix(".txt")])
    pictures = sorted(folder.iterdir())
    if len(pictures) < 6:
        fail(f"{video}: {len(pictures)} frames are too few for a sheet")
    chosen = [cv2.imread(str(pictures[len(pictures) * place // 6])) for place in range(1, 6)]
    height = round(options.width * chosen[0].shape[0] / chosen[0].shape[1])
    return [cv2.resize(one, (options.width, height), interpolation=cv2.INTER_AREA) for one in chosen]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--clips", nargs="+", metavar="NAME=VIDEO", help="videos [default: the data's five]")
    add("--width", type=int, default=256, help="of a frame, pixels [default: 256]")
    add("--out", type=Path, default=PROJECT / "docs/mot_track", help="the folder for NAME.jpg [default: docs/mot_track]")
    add_options(parser, "video/")
    options = check(parser.parse_args(), ["video"])
    options.out.mkdir(parents=True, exist_ok=True)
    for text in options.clips or CLIPS:
        name, _, files = text.partition("=")
        video = Path(files.partition(",")[0])
        video = video if video.exists() else options.data / video
        with tempfile.TemporaryDirectory() as scratch:
            rows = [np.hstack(annotated(options, video, preset, Path(scratch) / preset)) for preset in PRESETS]
        path = options.out / f"{name}.jpg"
        cv2.imwrite(str(path), np.vstack(rows), [cv2.IMWRITE_JPEG_QUALITY, 75])
        print(f"{path}: {path.stat().st_size // 1024} kB")


if __name__ == "__main__":
    main()
