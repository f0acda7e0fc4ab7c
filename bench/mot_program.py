"""How the scripts beside this run `mot`: its flags, what it tracks, how that scores."""

import json
import subprocess
from pathlib import Path

from rivals import executable
from sequences import PROJECT, data_folder, fail


def add_options(parser, holds):
    """--mot and --data; `holds` says what of the data is needed."""
    add = parser.add_argument
    add("--mot", type=Path, default=PROJECT / "target/release/mot", help="the program [default: target/release/mot]")
    add("--data", help=f"the folder that holds {holds} [default: INFOPART_DATA]")


def check(options, kinds=("mot",)):
    """The options with a program that runs and a folder that holds the data."""
    options.mot = executable(options.mot, "mot")
    options.data = data_folder(options.data, kinds)
    return options


def run(options, words):
    done = subprocess.run([options.mot, *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{options.mot} {words[0]} failed with exit code {done.returncode}: {done.stderr.strip()}")


def scores(options, truth, tracks, rules="trackeval"):
    """What `mot score` makes of a sequence's tracks."""
    scored = tracks.with_suffix(".json")
    run(options, ["score", truth, tracks, "--rules", rules, "--json", scored])
    return json.loads(scored.read_text())["sequences"][0]["scores"]


def detected_sequences(options, truth=True):
    """The folders of sequences with detections, and ground truth if it is needed."""
    wanted = "gt/gt.txt" if truth else "det/det.txt"
    folders = [path.parent.parent for path in sorted(options.data.glob(f"mot/*/{wanted}"))]
    if not folders:
        fail(f"no mot/SEQ/{wanted} in {options.data}: give the folder that holds mot/ with --data")
    return folders
