#!/usr/bin/env python3
"""Times `otb_eval score` against the GOT-10k toolkit's own functions on the same result files, and compares the numbers.

Every round scores all trackers over all sequences once with each, in turn. Ours is the whole program, from its start
to its last file: reading, scoring and printing. The toolkit's is reading the files with numpy.loadtxt as it does
itself, rect_iou, center_error and the curves of its OTB experiment; Python's start and imports are not timed. Rows
beyond the shorter of result and ground truth are dropped in both, where the toolkit's release stops with an error.

Needs: pip install got10k (matplotlib, numpy and shapely come with it), and `cargo build --release -p otb_eval`.
Data: the folder given with --data or INFOPART_DATA, which holds otb_meta/OTB100.json and otb_results/TRACKER/SEQ.txt;
else ../shared/data beside the project. Exit code 1 if a number differs, 2 if something is missing.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
# Sums are in another order, so the last bits may differ.
TOLERANCE = 1e-9


def fail(message):
    print(f"{Path(sys.argv[0]).name}: {message}", file=sys.stderr)
    sys.exit(2)


try:
    import matplotlib

    matplotlib.use("Agg")
    import numpy as np
    from got10k.experiments.otb import ExperimentOTB
    from got10k.utils.metrics import center_error, rect_iou
except ImportError as error:
    fail(f"{error}: pip install got10k")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--rounds", type=int, default=5, help="[default: 5]")
    add("--program", type=Path, default=PROJECT / "target/release/otb_eval", help="[default: target/release/otb_eval]")
    add("--data", help="the folder that holds otb_meta/ and otb_results/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    data = Path(options.data or os.environ.get("INFOPART_DATA") or PROJECT.parent / "shared" / "data")
    options.truth, options.results = data / "otb_meta" / "OTB100.json", data / "otb_results"
    if not (options.truth.is_file() and options.results.is_dir()):
        fail(f"no otb_meta/OTB100.json and otb_results/ in {data}: give their folder with --data or INFOPART_DATA")
    if not os.access(options.program, os.X_OK):
        fail(f"no program at {options.program}: run `cargo build --release -p otb_eval`, or give its path with --program")
    return options


def score_with_toolkit(truth_file, results):
    """Success and precision of every tracker on every sequence: {tracker: {sequence: (success, precision)}}."""
    experiment = ExperimentOTB.__new__(ExperimentOTB)
    experiment.nbins_iou, experiment.nbins_ce = 21, 51
    truths = {name: np.array(one["gt_rect"], float) for name, one in json.loads(truth_file.read_text()).items()}
    scores = {}
    for folder in sorted(path for path in results.iterdir() if path.is_dir()):
        scores[folder.name] = {}
        for name, truth in truths.items():
            boxes = np.loadtxt(folder / f"{name}.txt", delimiter=",")
            length = min(len(boxes), len(truth))
            boxes, truth = boxes[:length], truth[:length]
            boxes[0] = truth[0]
            success, precision = experiment._calc_curves(rect_iou(boxes, truth), center_error(boxes, truth))
            scores[folder.name][name] = (float(np.mean(success)), float(precision[20]))
    return scores


def score_with_ours(options, report):
    command = [options.program, "score", "--data", options.truth, "--results", options.results, "--toolkit", "got10k",
               "--missing-rows", "drop", "--json", report]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"{options.program} failed with exit code {done.returncode}: {done.stderr.strip()}")


def read_ours(report):
    table = json.loads(Path(report).read_text())["tables"][0]["table"]
    of = lambda row: (row["scores"]["auc"]["mean"], row["scores"]["precision_20"]["mean"])
    return {one["tracker"]: {row["sequence"]: of(row) for row in one["sequences"]} for one in table["trackers"]}


def compare(ours, theirs):
    """The largest difference, and a table of the means."""
    if {name: set(rows) for name, rows in ours.items()} != {name: set(rows) for name, rows in theirs.items()}:
        fail("the two did not score the same trackers and sequences")
    largest, lines = 0.0, []
    for tracker, rows in theirs.items():
        for sequence, values in rows.items():
            largest = max([largest] + [abs(a - b) for a, b in zip(ours[tracker][sequence], values)])
        mean = lambda scores, which: statistics.mean(pair[which] for pair in scores.values())
        values = [mean(scores, which) for which in (0, 1) for scores in (ours[tracker], rows)]
        lines.append(f"{tracker:<10}" + "".join(f"{value:>12.6f}" for value in values))
    return largest, lines


def timed(function, *words):
    start = time.perf_counter()
    result = function(*words)
    return time.perf_counter() - start, result


def main():
    options = arguments()
    warnings.simplefilter("ignore", RuntimeWarning)  # comparisons with NaN boxes
    ours_seconds, their_seconds = [], []
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "ours.json"
        for _ in range(options.rounds):
            ours_seconds.append(timed(score_with_ours, options, report)[0])
            seconds, theirs = timed(score_with_toolkit, options.truth, options.results)
            their_seconds.append(seconds)
        ours = read_ours(report)
    largest, lines = compare(ours, theirs)
    print(f"{'tracker':<10}{'AUC, ours':>12}{'got10k':>12}{'P20, ours':>12}{'got10k':>12}")
    print("\n".join(lines))
    sequences = len(next(iter(theirs.values())))
    ratio = statistics.median(b / a for a, b in zip(ours_seconds, their_seconds))
    a, b = statistics.median(ours_seconds), statistics.median(their_seconds)
    print(f"\n{len(theirs)} trackers, {sequences} sequences, {options.rounds} rounds, medians: "
          f"otb_eval {a:.3f} s, got10k {b:.3f} s, ratio {ratio:.1f}")
    print(f"largest difference of a sequence's AUC or precision: {largest:.1e}")
    if largest > TOLERANCE:
        print("the numbers differ", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
