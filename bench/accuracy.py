#!/usr/bin/env python3
"""Tracks sequences with several seeds and shows R1, R2 and AUC of each way to run InfoPart, side by side.

Each cell is a mean over the seeds; behind AUC stands its standard deviation over them, and behind R1 the worst seed's.
With --tre each seed's numbers are means over runs that start on frames spread evenly over the sequence, as in rivals.py.
The numbers are those of the program's own summary. Of targets that are no people (those of others12, and car) the
whole box is tracked, unless a variant says what. Needs `cargo build --release`; data as for rivals.py.
"""

import argparse
import json
import os
import random
import statistics
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from rivals import OURS, executable, table
from sequences import NAMES_HELP, PROJECT, data_folder, expand, fail, locate, read_rows, region_flags, tre_starts

RESAMPLES = 2000
VARIANTS = {"part": ["--region", "part"], "whole": ["--region", "whole"], "paper": ["--preset", "paper"]}


def track(job):
    """The program's summary of one pass, from the frame of that row of the ground truth, counted from 0."""
    program, (folder, target, _), flags, seed, start = job
    command = [program, "track", folder, *flags, "--seed", seed, "--start", start + 1, "--threads", 1, "--json", "--quiet"]
    command += ["--out", os.devnull, *(["--target", target] if target else [])]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{program} failed on {folder} with exit code {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stderr)["scores"]


def starts_of(place, runs):
    """The rows on which the runs start: the first alone, or those of so many runs of TRE."""
    folder, _, truth = place
    return tre_starts(read_rows(folder / truth), runs) if runs else [0]


def mean_scores(passes):
    return {key: statistics.mean(scores[key] for scores in passes) for key in ("r1", "r2", "auc")}


def cell(passes):
    of = lambda key: [scores[key] for scores in passes]
    r1, r2, auc = (statistics.mean(of(key)) for key in ("r1", "r2", "auc"))
    return f"{r1:.2f} ({min(of('r1')):.1f}) / {r2:.2f} / {auc:.3f} ± {statistics.pstdev(of('auc')):.3f}"


def difference(by_sequence):
    """Mean of paired differences and its bootstrap interval: sequences are drawn, and seeds within each."""
    draw = random.Random(1)
    mean = lambda rows: statistics.fmean(statistics.fmean(row) for row in rows)
    means = sorted(
        mean([draw.choices(row, k=len(row)) for row in draw.choices(by_sequence, k=len(by_sequence))])
        for _ in range(RESAMPLES)
    )
    low, high = means[RESAMPLES // 40], means[-1 - RESAMPLES // 40]
    return f"{mean(by_sequence):+.3f} [{low:+.3f}, {high:+.3f}]"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--sequences", nargs="+", default=["people8"], metavar="NAME", help=f"{NAMES_HELP} [default: people8]")
    add("--variants", nargs="*", default=list(VARIANTS), choices=VARIANTS, help="[default: all]")
    add("--set", nargs="+", default=[], metavar="KEY=VALUE[,...]", help="more variants: the default with other parameters")
    add("--means", action="store_true", help="a row a variant with its mean AUC on each sequence and its difference from the first, instead of whole cells")
    add("--seeds", type=int, default=5, help="seeds 1 to this [default: 5]")
    add("--tre", type=int, default=0, metavar="STARTS", help="run from so many start frames instead of from the first alone")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    options.infopart = executable(options.infopart)
    if options.seeds < 1 or options.tre < 0:
        fail("--seeds must be at least 1, --tre at least 0")
    return options


def write_configurations(settings, folder):
    """A configuration file for each KEY=VALUE[,...], and the flags that use it."""
    flags = {}
    for number, setting in enumerate(settings):
        path = Path(folder) / f"{number}.toml"
        path.write_text("\n".join(setting.split(",")) + "\n")
        flags[setting] = ["--config", path]
    return flags


def main():
    options = arguments()
    with tempfile.TemporaryDirectory() as folder:
        compare(options, write_configurations(options.set, folder))


def compare(options, configured):
    ways = {name: VARIANTS[name] for name in options.variants} | configured
    data = data_folder(options.data)
    names = expand(options.sequences)
    seeds = range(1, options.seeds + 1)
    places = {name: locate(data, name) for name in names}
    starts = {name: starts_of(places[name], options.tre) for name in names}
    region = lambda name, way: region_flags(name, ways[way], way if way in configured else "")
    jobs = [
        (options.infopart, places[name], [*ways[way], *region(name, way)], seed, start)
        for name in names for way in ways for seed in seeds for start in starts[name]
    ]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        passes = iter(list(pool.map(track, jobs)))
    found = {
        (name, way): [mean_scores([next(passes) for _ in starts[name]]) for _ in seeds] for name in names for way in ways
    }
    aucs = lambda name, way: [scores["auc"] for scores in found[name, way]]
    means = {way: statistics.mean(auc for name in names for auc in aucs(name, way)) for way in ways}
    runs = f"{OURS}, seeds 1-{options.seeds}" + (f", {options.tre} runs of TRE each" if options.tre else "")
    if options.means:
        print(f"{runs}: mean AUC\n")
        row = lambda way: [*(f"{statistics.mean(aucs(name, way)):.3f}" for name in names), f"{means[way]:.3f}"]
        first = next(iter(ways))
        lines = [
            [way, *row(way), "" if way == first else difference(
                [[a - b for a, b in zip(aucs(name, way), aucs(name, first))] for name in names]
            )]
            for way in ways
        ]
        print(table(["", *names, "mean", f"less {first} [95 %]"], lines))
    else:
        print(f"{runs}: R1 (worst seed) / R2 / AUC ± standard deviation over seeds\n")
        rows = [[name, *(cell(found[name, way]) for way in ways)] for name in names]
        print(table(["sequence", *ways], [*rows, ["mean AUC", *(f"{mean:.3f}" for mean in means.values())]]))


if __name__ == "__main__":
    main()
