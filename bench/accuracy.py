#!/usr/bin/env python3
"""Tracks sequences with several seeds and shows R1, R2 and AUC of each way to run InfoPart, side by side.

Each cell is a mean over the seeds; behind AUC stands its standard deviation over them, and behind R1 the worst seed's.
The numbers are those of the program's own summary. Needs `cargo build --release`; data as for rivals.py.
"""

import argparse
import json
import os
import statistics
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from rivals import OURS, PEOPLE8, PROJECT, data_folder, fail, locate, table

VARIANTS = {"part": [], "whole": ["--region", "whole"], "paper": ["--preset", "paper"]}
OTHER7 = "Deer David DragonBaby FaceOcc1 Freeman1 Football1 Diving".split()
LISTS = {"people8": PEOPLE8, "other7": OTHER7}


def track(job):
    """The program's summary of one pass."""
    program, (folder, target, _), flags, seed = job
    command = [program, "track", folder, *flags, "--seed", seed, "--threads", 1, "--json", "--quiet", "--out", os.devnull]
    command += ["--target", target] if target else []
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{program} failed on {folder} with exit code {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stderr)["scores"]


def cell(passes):
    of = lambda key: [scores[key] for scores in passes]
    r1, r2, auc = (statistics.mean(of(key)) for key in ("r1", "r2", "auc"))
    return f"{r1:.2f} ({min(of('r1')):.1f}) / {r2:.2f} / {auc:.3f} ± {statistics.pstdev(of('auc')):.3f}"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--sequences", nargs="+", default=["people8"], metavar="NAME", help="people8, other7, NAME or NAME-K [default: people8]")
    add("--variants", nargs="+", default=list(VARIANTS), choices=VARIANTS, help="[default: all]")
    add("--seeds", type=int, default=5, help="seeds 1 to this [default: 5]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    options.infopart = Path(options.infopart).resolve()
    if not os.access(options.infopart, os.X_OK):
        fail(f"no program at {options.infopart}: run `cargo build --release`, or give its path with --infopart")
    return options


def main():
    options = arguments()
    data = data_folder(options.data)
    names = [name for given in options.sequences for name in LISTS.get(given, [given])]
    seeds = range(1, options.seeds + 1)
    jobs = [
        (options.infopart, locate(data, name), VARIANTS[variant], seed)
        for name in names for variant in options.variants for seed in seeds
    ]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        passes = iter(list(pool.map(track, jobs)))
    found = {(name, variant): [next(passes) for _ in seeds] for name in names for variant in options.variants}
    rows = [[name, *(cell(found[name, variant]) for variant in options.variants)] for name in names]
    mean = lambda variant: statistics.mean(s["auc"] for name in names for s in found[name, variant])
    rows.append(["mean AUC", *(f"{mean(variant):.3f}" for variant in options.variants)])
    print(f"{OURS}, seeds 1-{options.seeds}: R1 (worst seed) / R2 / AUC ± standard deviation over seeds\n")
    print(table(["sequence", *options.variants], rows))


if __name__ == "__main__":
    main()
