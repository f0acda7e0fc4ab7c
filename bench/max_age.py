#!/usr/bin/env python3
"""Which --max-age each method of `mot sort` should have, judged on sequences that did not choose it.

Prints IDF1 and HOTA (TrackEval's rules) for each age and sequence with ground truth, then, leaving each sequence out in turn, the age
that is best in the mean of the others by IDF1 + HOTA, and what it is worth on the one left out, beside the default's. Needs `cargo
build --release --workspace`. Data: mot/SEQ/{det/det.txt,gt/gt.txt} in the data folder.
"""

import argparse
import tempfile
from pathlib import Path

from mot_program import add_options, check, detected_sequences, run, scores
from rivals import table

AGES = [1, 2, 3, 5, 8, 12, 20, 30, 45, 60, 90]
DEFAULTS = {"sort": 1, "byte": 30, "oc": 30}


def measured(options, sequence, method, age, scratch):
    """IDF1 and HOTA in per cent."""
    out = scratch / "tracks.txt"
    run(options, ["sort", sequence / "det/det.txt", "--method", method, "--max-age", age, "--out", out])
    found = scores(options, sequence / "gt/gt.txt", out)
    return 100 * found["idf1"], 100 * found["hota"]


def text(pair):
    return " ".join(f"{value:.1f}" for value in pair)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_options(parser, "mot/")
    parser.add_argument("--ages", type=int, nargs="+", default=AGES, metavar="FRAMES", help=f"[default: {AGES}]")
    options = check(parser.parse_args())
    sequences = detected_sequences(options)
    ages = sorted({*options.ages, *DEFAULTS.values()})
    rows, judged = [], []
    with tempfile.TemporaryDirectory() as scratch:
        for method, default in DEFAULTS.items():
            found = {
                one.name: {age: measured(options, one, method, age, Path(scratch)) for age in ages} for one in sequences
            }
            rows += [[method, name, *(text(of_age[age]) for age in ages)] for name, of_age in found.items()]
            for name, left_out in found.items():
                others = [of_age for other, of_age in found.items() if other != name]
                best = max(ages, key=lambda age: sum(sum(of_age[age]) for of_age in others))
                judged.append([method, name, str(best), text(left_out[best]), text(left_out[default])])
    print(table(["IDF1 HOTA", "sequence", *(f"{age}" for age in ages)], rows), end="\n\n")
    print(table(["method", "left out", "chosen by the others", "worth on it", "the default's"], judged))


if __name__ == "__main__":
    main()
