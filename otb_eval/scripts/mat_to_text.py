#!/usr/bin/env python3
"""Writes the MATLAB benchmark's result files as text that otb_eval reads.

    mat_to_text.py results/OPE/*.mat --out results
    otb_eval score --data otb --results results --toolkit matlab

A file is SEQ_TRACKER.mat with a cell array `results`: one struct (OPE), twenty (TRE), or twelve with a shiftType (SRE).
The boxes of each go to OUT/PROTOCOL/TRACKER/seed_0/SEQ[_SEGMENT].txt, and 1/fps of every frame to ..._time.txt. Only
results of type `rect` are boxes; others are named and left out. Needs SciPy. Exit code 2 if a file was left out.
"""

import argparse
import sys
from pathlib import Path

try:
    import numpy as np
    from scipy.io import loadmat
except ImportError:
    sys.exit("mat_to_text.py: SciPy is missing: pip install scipy")


def segments_of(path):
    """The structs of a file."""
    content = loadmat(path, squeeze_me=True, struct_as_record=False)
    if "results" not in content:
        raise ValueError("no variable `results` in it; it is no result of the benchmark")
    return list(np.atleast_1d(content["results"]))


def protocol_of(segments):
    if len(segments) == 1:
        return "ope"
    return "sre" if getattr(segments[0], "shiftType", None) is not None else "tre"


def label_of(protocol, index, segment):
    return {"ope": "", "tre": f"_{index + 1:02}", "sre": f"_{getattr(segment, 'shiftType', '')}"}[protocol]


def boxes_of(segment):
    if segment.type != "rect":
        raise ValueError(f"its results are of type `{segment.type}`, not `rect`; turn them into boxes in MATLAB first")
    boxes = np.asarray(segment.res, dtype=float).reshape(-1, 4)
    if len(boxes) == 0:
        raise ValueError("it has no boxes")
    return boxes


def convert(path, out):
    sequence, _, tracker = path.stem.partition("_")
    if not tracker:
        raise ValueError("the file's name must be SEQ_TRACKER.mat")
    segments = segments_of(path)
    protocol = protocol_of(segments)
    folder = out / protocol / tracker / "seed_0"
    texts = {}
    for index, segment in enumerate(segments):
        stem = sequence[0].upper() + sequence[1:] + label_of(protocol, index, segment)
        boxes = boxes_of(segment)
        texts[f"{stem}.txt"] = "".join(",".join(repr(float(number)) for number in box) + "\n" for box in boxes)
        fps = float(getattr(segment, "fps", 0) or 0)
        if fps > 0:
            texts[f"{stem}_time.txt"] = f"{1 / fps:.8f}\n" * len(boxes)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / name).write_text(text)
    return len(segments)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path, metavar="SEQ_TRACKER.mat")
    parser.add_argument("--out", required=True, type=Path, help="the folder of results")
    options = parser.parse_args()
    written, left_out = 0, 0
    for path in options.files:
        try:
            written += convert(path, options.out)
        except (OSError, ValueError, NotImplementedError, TypeError, AttributeError) as error:
            print(f"problem: {path}: {error}", file=sys.stderr)
            left_out += 1
    print(f"{written} segments written to {options.out}, {left_out} files left out", file=sys.stderr)
    sys.exit(2 if left_out else 0)


if __name__ == "__main__":
    main()
