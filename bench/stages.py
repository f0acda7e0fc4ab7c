#!/usr/bin/env python3
"""Shows where the time of an update goes: the stages of `infopart track --timing`, over sequences, at 1 and 2 threads.

A cell is the mean over the sequences, in milliseconds a frame, of the stage's mean over a run; each run is repeated and the
shortest taken, as other work on the machine only adds. Below stands the least time that the memory traffic of the sums and
integral images can take: their bytes over the speed at which numpy copies a large array. The second table is of processor time, which other
work hardly changes: what tracking a frame costs on one thread, and what all the rest of the program does, decoding above
all; it comes from the same run with and without `--stride` of a thousand million. Needs `cargo build --release` and numpy.
"""

import argparse
import json
import math
import os
import re
import resource
import statistics
import subprocess
import time

from rivals import executable, table
from sequences import NAMES_HELP, PROJECT, data_folder, expand, fail, locate

WINDOW, GRID = 4.0, 32  # Side of the searched window over the square root of the box's area; grid cells along it.
PART, MOST_CELLS = 0.625, 4000
COVERED = 3.0 * 2.0  # What the particles cover, over the part, about.
CUT = 3 + 3  # Bytes read from the frame and written for each cell of a region.
INTEGRALS, BLOCK_SUMS = 4 * (3 + 8), 4 * 12  # Bytes of an entry.


def passes(program, place, flags, rounds):
    folder, target, _ = place
    command = [program, "track", folder, *flags, "--timing", "--json", "--quiet", "--out", os.devnull]
    command += ["--target", target] if target else []
    found = []
    for _ in range(rounds):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            fail(f"{program} failed on {folder} with exit code {done.returncode}: {done.stderr.strip()}")
        found.append(json.loads(done.stderr))
    return found


def processor_seconds(program, place, flags, rounds):
    """The least that a run took, and its frames."""
    seconds = []
    for _ in range(rounds):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        summary = passes(program, place, ["--threads", 1, *flags], 1)[0]
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return min(seconds), summary["frames"]


def tracking_and_rest(program, place, rounds):
    """Milliseconds of processor time of an update, and of all else a frame."""
    whole, frames = processor_seconds(program, place, [], rounds)
    rest, _ = processor_seconds(program, place, ["--stride", 10**9], rounds)
    return 1e3 * (whole - rest) / (frames - 1), 1e3 * rest / frames


def milliseconds(runs):
    """{stage: the shortest mean of all runs}, the whole update among them."""
    times = {}
    for run in runs:
        of_run = {stage["stage"]: stage["mean_milliseconds"] for stage in run["stages"]}
        of_run["update"] = 1e3 / run["frames_per_second"]
        for stage, value in of_run.items():
            times[stage] = min(times.get(stage, value), value)
    return times


def frame_bytes(place):
    """Bytes that an update must at least read and write around the first box: the window's sums, the integral images."""
    folder, _, truth = place
    w, h = [float(number) for number in re.split(r"[,\s]+", (folder / truth).read_text().strip())[2:4]]
    cell = WINDOW * (w * h) ** 0.5 / GRID
    step = max(1, math.ceil(cell / 10))
    block = max(1, int(cell / step / 3))
    window = (cell * GRID / step) ** 2 * (CUT + BLOCK_SUMS / block**2)
    part_step = max(1, math.ceil((w * PART * h / MOST_CELLS) ** 0.5))
    return window + COVERED * w * PART * h / part_step**2 * (CUT + INTEGRALS)


def bytes_per_second():
    """Bytes that a copy reads and writes in a second, the best of some copies of 64 MB."""
    import numpy as np

    source, target = np.ones(1 << 26, np.uint8), np.ones(1 << 26, np.uint8)
    best = float("inf")
    for _ in range(20):
        start = time.perf_counter()
        np.copyto(target, source)
        best = min(best, time.perf_counter() - start)
    return 2 * source.size / best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--sequences", nargs="+", default=["people8"], metavar="NAME", help=f"{NAMES_HELP} [default: people8]")
    add("--rounds", type=int, default=5, help="runs of each sequence [default: 5]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    program = executable(options.infopart)
    data = data_folder(options.data)
    names = expand(options.sequences)
    places = [locate(data, name) for name in names]
    columns = []
    for threads in (1, 2):
        found = [milliseconds(passes(program, place, ["--threads", threads], options.rounds)) for place in places]
        columns.append({stage: statistics.mean(times.get(stage, 0.0) for times in found) for stage in found[0]})
    traffic, speed = statistics.mean(map(frame_bytes, places)), bytes_per_second()
    rows = [[stage, *(f"{column[stage]:.3f}" for column in columns)] for stage in columns[0]]
    rows.append([f"least for {traffic / 1e3:.0f} kB at {speed / 1e9:.1f} GB/s", f"{1e3 * traffic / speed:.3f}", ""])
    print(table(["wall milliseconds a frame", "1 thread", "2 threads"], rows))
    rows = []
    for name, place in zip(names, places):
        tracking, rest = tracking_and_rest(program, place, options.rounds)
        rows.append([name, f"{tracking:.2f}", f"{rest:.2f}", f"{tracking / rest:.2f}"])
    print("\n" + table(["processor milliseconds a frame", "tracking", "decoding and the rest", "ratio"], rows))


if __name__ == "__main__":
    main()
