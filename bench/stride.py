#!/usr/bin/env python3
"""Tracks sequences with every K-th frame left to the tracker and shows what that costs: AUC against the stride.

Each cell is a mean over the seeds of the AUC over all frames, those that were predicted among them. The last columns are
of stride 1 with --threads threads, one run at a time: frames per second of update time, and the rate that the sequence
bears without skipping a frame (one may wait while the tracker is busy), each the median over the seeds. These two depend
on the machine and on what else it does. Needs `cargo build --release`; data as for rivals.py.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from rivals import OURS, executable, table
from sequences import NAMES_HELP, PROJECT, data_folder, expand, fail, locate


def track(program, place, flags):
    """The program's summary of one pass."""
    folder, target, _ = place
    command = [program, "track", folder, *flags, "--json", "--quiet", "--out", os.devnull]
    command += ["--target", target] if target else []
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{program} failed on {folder} with exit code {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stderr)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--sequences", nargs="+", default=["people8"], metavar="NAME", help=f"{NAMES_HELP} [default: people8]")
    add("--strides", nargs="+", type=int, default=[1, 2, 3, 5, 10], metavar="K", help="[default: 1 2 3 5 10]")
    add("--seeds", type=int, default=5, help="seeds 1 to this [default: 5]")
    add("--threads", type=int, default=2, help="threads where speed is measured [default: 2]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    add("--out", metavar="FILE", help="write the table to FILE too")
    options = parser.parse_args()
    options.infopart = executable(options.infopart)
    if min(options.strides) < 1 or options.seeds < 1 or options.threads < 1:
        fail("--strides, --seeds and --threads must be at least 1")
    return options


def main():
    options = arguments()
    data = data_folder(options.data)
    names = expand(options.sequences)
    places = {name: locate(data, name) for name in names}
    seeds = range(1, options.seeds + 1)

    jobs = [(name, stride, seed) for name in names for stride in options.strides for seed in seeds]
    auc = lambda job: track(
        options.infopart, places[job[0]], ["--stride", job[1], "--seed", job[2], "--threads", 1]
    )["scores"]["auc"]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        aucs = dict(zip(jobs, pool.map(auc, jobs)))
    mean = lambda name, stride: statistics.mean(aucs[name, stride, seed] for seed in seeds)

    rows = []
    for name in names:
        print(f"{name}: speed ...", file=sys.stderr, flush=True)
        runs = [track(options.infopart, places[name], ["--seed", seed, "--threads", options.threads]) for seed in seeds]
        rates = [statistics.median(run[key] for run in runs) for key in ("frames_per_second", "sustained_frames_per_second")]
        rows.append([name, *(f"{mean(name, stride):.3f}" for stride in options.strides), *(f"{rate:.0f}" for rate in rates)])
    means = [statistics.mean(mean(name, stride) for name in names) for stride in options.strides]
    rows.append(["mean", *(f"{value:.3f}" for value in means), "", ""])
    header = [f"{OURS}, AUC at stride", *map(str, options.strides), "frames per second", "borne without skipping"]
    text = table(header, rows)
    print(text)
    if options.out:
        partial = Path(f"{options.out}.partial")
        partial.write_text(text + "\n")
        partial.replace(options.out)


if __name__ == "__main__":
    main()
