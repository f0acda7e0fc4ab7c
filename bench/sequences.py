"""The sequences that the scripts beside this run on: named lists, where they are, their rows, and where trackers start."""

import math
import os
import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
KINDS = ("otb", "people", "ships", "others", "longterm")
PEOPLE8 = "Crossing Walking2 David3 Jogging-1 Jogging-2 Couple pedestrian1 person11".split()
PEOPLE11 = "Woman Bolt Singer2 Skating1 Human3 pedestrian2 campus2 campus3 campus4 campus5 campus7".split()
OTHER7 = "Deer David DragonBaby FaceOcc1 Freeman1 Football1 Diving".split()
OTHERS12 = OTHER7 + "boat1 Bird2 Man bag MotorRolling".split()
LONGTERM = "pedestrian1 pedestrian2 car".split()
CROWD = [f"pets{identity}" for identity in range(1, 20)]  # Made by crowd.py.
LISTS = {
    "people8": PEOPLE8, "people11": PEOPLE11, "people19": PEOPLE8 + PEOPLE11, "other7": OTHER7, "others12": OTHERS12,
    "longterm": LONGTERM, "crowd19": CROWD, "crowd": CROWD,
}
NAMES_HELP = f"{', '.join(LISTS)}, NAME, or NAME-K for target K"
# No people: all of the box is tracked, unless a flag or a parameter says what.
WHOLE = {*OTHERS12, "car"}
SHORTEST_RUN = 20  # Frames of the shortest run of TRE, the absent ones among them.


def fail(message):
    print(f"{Path(sys.argv[0]).name}: {message}", file=sys.stderr)
    sys.exit(2)


def usual_folder():
    """Where the data is if --data does not say."""
    return Path(os.environ.get("INFOPART_DATA") or PROJECT.parent / "shared" / "data")


def data_folder(given, kinds=KINDS):
    """The folder of the data, if it holds any of those kinds."""
    folder = Path(given) if given else usual_folder()
    if not any((folder / kind).is_dir() for kind in kinds):
        holds = " or ".join(f"{kind}/" for kind in kinds)
        fail(f"no {holds} in {folder}: give the folder that holds it with --data or INFOPART_DATA")
    return folder


def expand(given):
    """The sequences of a list's name, or the name itself, of each that is given; each once."""
    return list(dict.fromkeys(name for word in given for name in LISTS.get(word, [word])))


def locate(data, name):
    """NAME, or NAME-K for target K of a folder with groundtruth_rect.K.txt: its folder, target and ground-truth file."""
    plain, _, target = name.rpartition("-")
    for kind in KINDS:
        if (data / kind / name / "groundtruth_rect.txt").is_file():
            return data / kind / name, None, "groundtruth_rect.txt"
        if plain and (data / kind / plain / f"groundtruth_rect.{target}.txt").is_file():
            return data / kind / plain, target, f"groundtruth_rect.{target}.txt"
    remedy = " (bench/crowd.py makes it; give its folder with --data)" if name in CROWD else ""
    fail(f"no sequence {name} in {data}{remedy}; use NAME, or NAME-K for a folder of several targets")


def region_flags(name, flags=(), parameters=""):
    """What tells InfoPart to track the whole box of a target that is no person, unless flags or parameters tell it."""
    is_told = "--region" in flags or re.search(r"(^|,)\s*region\s*=", parameters)
    return ["--region", "whole"] if name in WHOLE and not is_told else []


def read_rows(path):
    """The rows of a ground truth: lists of four numbers, NaN where the target is absent."""
    rows = [re.split(r"[,\s]+", line.strip()) for line in path.read_text().split("\n") if line.strip()]
    try:
        numbers = [[float(number) for number in row] for row in rows]
    except ValueError as error:
        fail(f"{path}: {error}; every row must be four numbers x,y,w,h, or NaN where the target is absent")
    if any(len(row) != 4 for row in numbers):
        fail(f"{path}: a row has not four numbers; every row must be x,y,w,h, or NaN where the target is absent")
    return numbers


def is_present(row):
    """Whether the row is a box: only such frames are scored, and only on such does a tracker start."""
    return all(map(math.isfinite, row)) and row[2] > 0 and row[3] > 0


def tre_starts(rows, runs):
    """Rows, counted from 0, on which the runs of temporal robustness evaluation start: the benchmark's rule for 20 runs,
    for any number. They are spread evenly over the frames that have the target and at least 20 frames left, theirs
    among them; fewer where there are not enough. The benchmark also leaves out boxes that reach beyond the left or the
    upper side of the picture; here these count, as the first frame of a sequence does in one-pass evaluation."""
    kept = [number for number, row in enumerate(rows) if is_present(row)]
    last = sum(len(rows) - number >= SHORTEST_RUN for number in kept)
    if last == 0 or runs == 1:
        return kept[:1]
    step = last / (runs - 1)
    positions = [int(1 + run * step) for run in range(runs - 1)] + [last]
    return sorted({kept[position - 1] for position in positions if position <= last})
