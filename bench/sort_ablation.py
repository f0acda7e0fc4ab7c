#!/usr/bin/env python3
"""What changes in SORT change: filters, noise, how long lost tracks are kept, colours in the association.

Runs `mot sort` and `mot score` on each sequence of mot/ that has ground truth and prints IDF1, ID switches, fragments, MOTA and
HOTA. Colours need frames: give the video or folder of a sequence with --frames NAME=PATH; sequences without are left out of
those rows. Needs `cargo build --release --workspace`.
"""

import argparse
import tempfile
from pathlib import Path

from mot_program import add_options, check, detected_sequences, run, scores

FILTERS = ("kalman", "ekf", "ukf", "pf")


def scores_of(options, folder, flags, scratch):
    result = scratch / "result.txt"
    run(options, ["sort", folder / "det/det.txt", *flags, "--out", result])
    return scores(options, folder / "gt/gt.txt", result, rules="motmetrics")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add_options(parser, "mot/")
    add("--frames", nargs="*", default=[], metavar="NAME=PATH", help="the frames of a sequence")
    add("--max-age", nargs="*", type=int, default=[1, 5, 30], metavar="FRAMES", help="[default: 1 5 30]")
    add("--seeds", type=int, default=5, help="seeds of the particle filter, whose rows are means [default: 5]")
    options = check(parser.parse_args())
    frames = dict(given.split("=", 1) for given in options.frames)
    print("sequence        noise         filter  max-age  colours   IDF1  IDSW    FM   MOTA   HOTA")
    with tempfile.TemporaryDirectory() as scratch:
        for folder in detected_sequences(options):
            for noise in ("reference", "proportional"):
                for name in FILTERS:
                    for age in options.max_age:
                        for colours in (False, True) if folder.name in frames else (False,):
                            row(options, folder, noise, name, age, frames[folder.name] if colours else None, Path(scratch))


def row(options, folder, noise, name, age, frames, scratch):
    flags = ["--noise", noise, "--filter", name, "--max-age", age] + (["--frames", frames] if frames else [])
    seeds = range(1, options.seeds + 1) if name == "pf" else [1]
    found = [scores_of(options, folder, [*flags, "--seed", seed], scratch) for seed in seeds]
    mean = lambda key: sum(one[key] for one in found) / len(found)
    print(
        f"{folder.name:15} {noise:13} {name:7} {age:7}  {'on' if frames else 'off':7} {100 * mean('idf1'):6.1f}"
        f" {mean('switches'):5.0f} {mean('fragments'):5.0f} {100 * mean('mota'):6.1f} {100 * mean('hota'):6.1f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
