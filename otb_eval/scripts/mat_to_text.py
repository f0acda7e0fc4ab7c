#!/usr/bin/env python3
"""Writes the MATLAB benchmark's result files as text that otb_eval reads.

    mat_to_text.py results/OPE/*.mat --out results
    otb_eval score --data otb --results results --toolkit matlab

A file is SEQ_TRACKER.mat with a cell array `results`, or one of another name if it is the only one: one struct (OPE), twenty
(TRE), or twelve with a shiftType (SRE). The boxes of each go to OUT/PROTOCOL/TRACKER/seed_0/SEQ[_SEGMENT].txt, 1/fps of
every frame to ..._time.txt, and where a run of TRE starts to ....result.json. Results of type `rect` are boxes; `ivtAff`,
`4corner` and `affine` are turned into boxes as the benchmark does it; others are named and left out. Sequences get the
benchmark's names: Jogging_1 and jogging-1 are Jogging-1, Human4 is Human4-2. Needs SciPy. Exit code 2 if a file was left out.
"""

import argparse
import hashlib
import json
import math
import sys
from pathlib import Path

try:
    import numpy as np
    from scipy.io import loadmat
except ImportError:
    sys.exit("mat_to_text.py: SciPy is missing: pip install scipy")

# Folders with two targets, and the only one of Human4 that the benchmark uses.
TWO_TARGETS = {"jogging": "Jogging", "skating2": "Skating2"}
HUMAN4 = "Human4-2"
# Numbers of first frames that are not 1, for files that do not tell them.
FIRST_FRAMES = {"BlurCar1": 247, "BlurCar3": 3, "BlurCar4": 18, "David": 300, "Tiger1": 6}


def sequence_and_tracker(stem):
    """The benchmark's name of the sequence, and the tracker's."""
    first, _, rest = stem.partition("_")
    number, _, after = rest.partition("_")
    small = first.lower()
    if small in TWO_TARGETS and number in ("1", "2") and after:
        return f"{TWO_TARGETS[small]}-{number}", after
    if small in ("human4", "human4-2"):
        return HUMAN4, after if number == "2" and after else rest
    return first[:1].upper() + first[1:], rest


def is_segment(value):
    return hasattr(value, "res")


def segments_of(path):
    """The structs of a file, whatever the variable is called."""
    content = loadmat(path, squeeze_me=True, struct_as_record=False)
    variables = {name: np.atleast_1d(value) for name, value in content.items() if not name.startswith("__")}
    fitting = {name: list(value) for name, value in variables.items() if len(value) and all(map(is_segment, value.flat))}
    if "results" in fitting:
        return fitting["results"]
    if len(fitting) == 1:
        return next(iter(fitting.values()))
    there = ", ".join(sorted(variables)) or "nothing"
    what = "several variables that may be results" if fitting else "no variable with a field `res`"
    raise ValueError(f"{what} in it, but: {there}; call the one that is meant `results`")


def protocol_of(segments):
    if len(segments) == 1:
        return "ope"
    return "sre" if getattr(segments[0], "shiftType", None) is not None else "tre"


def label_of(protocol, index, segment):
    return {"ope": "", "tre": f"_{index + 1:02}", "sre": f"_{getattr(segment, 'shiftType', '')}"}[protocol]


def rounded(value):
    """As MATLAB rounds: halves away from zero."""
    return math.copysign(math.floor(abs(value) + 0.5), value)


def of_affine(row, width, height):
    """The box between the first and the third corner of a template, placed by IVT's six numbers; rounded down."""
    x, y, xx, xy, yx, yy = row
    dx, dy = (xx * width + xy * height) / 2, (yx * width + yy * height) / 2
    left, top, right, bottom = (math.floor(value) for value in (x - dx, y - dy, x + dx, y + dy))
    return [left, top, right - left, bottom - top]


def around(xs, ys):
    """The upright box around four corners, whose last pixel belongs to it; rounded."""
    left, top = min(xs), min(ys)
    return [rounded(value) for value in (left, top, max(xs) - left + 1, max(ys) - top + 1)]


def boxes_of(segment):
    kind = str(getattr(segment, "type", "rect"))
    rows = np.asarray(segment.res, dtype=float)
    if rows.size == 0:
        raise ValueError("it has no boxes")
    if kind == "rect":
        return rows.reshape(-1, 4).tolist()
    if kind in ("ivtAff", "affine_ivt"):
        size = np.asarray(getattr(segment, "tmplsize", []), dtype=float).ravel()
        if size.size != 2:
            raise ValueError("its results are affine, but `tmplsize` has not two numbers")
        return [of_affine(row, *size) for row in rows.reshape(-1, 6)]
    if kind in ("4corner", "affine"):
        corners = rows.reshape(-1, 2, 4)
        return [around(xs, ys) for xs, ys in corners]
    raise ValueError(f"its results are of type `{kind}`, not boxes; turn them into `rect` in MATLAB first")


def number_of(segment, name):
    value = np.asarray(getattr(segment, name, np.nan), dtype=float).ravel()
    return int(value[0]) if value.size == 1 and np.isfinite(value[0]) else None


def first_rows(sequence, segments):
    """For each segment the row of ground truth, counted from 1, that it starts on; None where nothing tells."""
    starts = [number_of(segment, "startFrame") for segment in segments]
    known = [start for start in starts if start is not None]
    begins = number_of(segments[0], "annoBegin")
    if begins is None:
        begins = FIRST_FRAMES.get(sequence, 1)
    # The benchmark leaves the first five frames of Tiger1 out, and otb_eval's ground truth begins with the sixth.
    if sequence == "Tiger1" and known and min(known) >= FIRST_FRAMES["Tiger1"]:
        begins = FIRST_FRAMES["Tiger1"]
    elif known and min(known) < begins:
        begins = 1
    return [None if start is None else start - begins + 1 for start in starts]


def convert(path, out):
    sequence, tracker = sequence_and_tracker(path.stem)
    if not tracker:
        raise ValueError("the file's name must be SEQ_TRACKER.mat")
    segments = segments_of(path)
    protocol = protocol_of(segments)
    folder = out / protocol / tracker / "seed_0"
    first = first_rows(sequence, segments) if protocol == "tre" else [1] * len(segments)
    texts = {}
    for index, segment in enumerate(segments):
        stem = sequence + label_of(protocol, index, segment)
        boxes = boxes_of(segment)
        rows = "".join(",".join(repr(float(number)) for number in box) + "\n" for box in boxes)
        record = {"rows": len(boxes), "sha256": hashlib.sha256(rows.encode()).hexdigest()}
        if first[index] is not None:
            record = {"first_row": first[index], **record}
        fps = float(getattr(segment, "fps", 0) or 0)
        if fps > 0:
            texts[f"{stem}_time.txt"] = f"{1 / fps:.8f}\n" * len(boxes)
        texts[f"{stem}.result.json"] = json.dumps(record) + "\n"
        texts[f"{stem}.txt"] = rows
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / name).write_bytes(text.encode())
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
