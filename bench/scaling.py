#!/usr/bin/env python3
"""Measures what the cost of an update follows: frame size, particles, threads, and what is tracked.

Frames are 1280 x 720 pictures of texture with a textured target that moves by a pixel or two a frame; the same target
lies in a crop of 400 x 300 that holds all of it. Costs are processor time, so that other work on the machine hardly counts:
that of a run without that of the same run at a stride that leaves the tracker only the first frame, over the number of
updates, the least of --rounds runs. The gain of a second thread needs wall time, which is taken from the rows (the shortest
of each frame), and so a quiet machine. Needs `cargo build --release` and numpy.
"""

import argparse
import csv
import json
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from rivals import PROJECT, data_folder, executable, fail, locate, table

WIDTH, HEIGHT, CROP = 1280, 720, (440, 210, 400, 300)
TARGET = (600, 300, 40, 96)


def write_scene(folder, frames):
    """The large frames and their crops, as bitmaps: decoding is not measured."""
    import numpy as np

    rng = np.random.default_rng(1)
    coarse = rng.integers(0, 256, (HEIGHT // 8, WIDTH // 8, 3))
    street = np.kron(coarse, np.ones((8, 8, 1))) * 0.5 + rng.integers(0, 64, (HEIGHT, WIDTH, 3))
    x, y, w, h = TARGET
    person = np.kron(rng.integers(0, 256, (h // 8, w // 8, 3)), np.ones((8, 8, 1)))
    for name in ("large", "crop"):
        (folder / name).mkdir()
    cx, cy, cw, ch = CROP
    for number in range(frames):
        picture = street.copy()
        dx, dy = round(30 * np.sin(number / 20)), round(15 * np.sin(number / 13))
        picture[y + dy : y + dy + h, x + dx : x + dx + w] = person
        picture = np.clip(picture + rng.normal(0, 4, picture.shape), 0, 255).astype(np.uint8)
        write_bmp(folder / "large" / f"{number + 1:04}.bmp", picture)
        write_bmp(folder / "crop" / f"{number + 1:04}.bmp", picture[cy : cy + ch, cx : cx + cw])


def write_bmp(path, picture):
    """A 24-bit bitmap; the widths here are multiples of four, so that rows need no padding."""
    height, width, _ = picture.shape
    size = 54 + width * height * 3
    header = b"BM" + size.to_bytes(4, "little") + bytes(4) + (54).to_bytes(4, "little") + (40).to_bytes(4, "little")
    header += width.to_bytes(4, "little") + height.to_bytes(4, "little") + (1).to_bytes(2, "little") + (24).to_bytes(2, "little")
    path.write_bytes(header + bytes(24) + picture[::-1, :, ::-1].tobytes())


class Runner:
    def __init__(self, program, rounds, folder):
        self.program, self.rounds, self.rows = program, rounds, folder / "rows.csv"

    def run(self, flags):
        """Seconds of processor time that a run took, and its summary."""
        command = [self.program, "track", *flags, "--timing", "--json", "--quiet", "--format", "csv", "--out", self.rows]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if done.returncode != 0:
            fail(f"{self.program} failed with exit code {done.returncode}: {done.stderr.strip()}")
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, json.loads(done.stderr)

    def processor_ms(self, jobs):
        """For each {name: flags} the milliseconds of processor time of an update on one thread."""
        costs = {name: ([], []) for name in jobs}
        updates = {}
        for _ in range(self.rounds):
            for name, flags in jobs.items():
                with_updates, summary = self.run([*flags, "--threads", 1])
                without, _ = self.run([*flags, "--threads", 1, "--stride", 10**9])
                updates[name] = summary["frames"] - 1
                costs[name][0].append(with_updates)
                costs[name][1].append(without)
        return {name: 1e3 * (min(whole) - min(rest)) / updates[name] for name, (whole, rest) in costs.items()}

    def wall_ms(self, jobs):
        """For each {name: flags} the milliseconds of an update: the shortest of all rounds, in the mean over frames."""
        rounds = {name: [] for name in jobs}
        for _ in range(self.rounds):
            for name, flags in jobs.items():
                self.run(flags)
                with open(self.rows, newline="") as rows:
                    rounds[name].append([float(row["update_ms"]) for row in csv.DictReader(rows)][1:])
        return {name: statistics.mean(map(min, zip(*times))) for name, times in rounds.items()}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--frames", type=int, default=120, help="frames of the scene [default: 120]")
    add("--rounds", type=int, default=5, help="runs of each kind [default: 5]")
    add("--sequence", default="Crossing", help="where part and whole body are compared [default: Crossing]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    options.infopart = executable(options.infopart)
    return options


def main():
    options = arguments()
    sequence = locate(data_folder(options.data), options.sequence)[0]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        runner = Runner(options.infopart, options.rounds, folder)
        print("drawing the scene ...", file=sys.stderr, flush=True)
        write_scene(folder, options.frames)
        x, y, w, h = TARGET
        box = lambda left, top: ["--init", f"{x - left},{y - top},{w},{h}"]
        large, crop = [folder / "large", *box(0, 0)], [folder / "crop", *box(*CROP[:2])]
        report(runner, large, crop, sequence)


def report(runner, large, crop, sequence):
    rows = []
    add = lambda name, value: rows.append([name, value])
    ratio = lambda name, times, a, b: add(f"{name} ({times[a]:.3f} / {times[b]:.3f} ms)", f"{times[a] / times[b]:.2f}")

    ratio("1280 x 720 / crop of 400 x 300", runner.processor_ms({"large": large, "crop": crop}), "large", "crop")
    counts = (250, 500, 1000, 2000, 4000)
    flags = lambda count: [*crop, "--particles", count]
    times = runner.processor_ms({count: flags(count) for count in counts})
    slopes = [1e3 * (times[b] - times[a]) / (b - a) for a, b in zip(counts, counts[1:])]
    add(f"milliseconds at {', '.join(map(str, counts))} particles", ", ".join(f"{times[count]:.2f}" for count in counts))
    add("microseconds a particle, from each of these to the next", ", ".join(f"{slope:.2f}" for slope in slopes))
    for preset in ("default", "paper"):
        times = runner.wall_ms({t: [*flags(2000), "--threads", t, "--preset", preset] for t in (1, 2)})
        ratio(f"1 / 2 threads, 2000 particles, preset {preset}", times, 1, 2)
    for preset in ("default", "paper"):
        jobs = {region: [sequence, "--region", region, "--preset", preset] for region in ("part", "whole")}
        ratio(f"part / whole, {sequence.name}, preset {preset}", runner.processor_ms(jobs), "part", "whole")
    print(table(["cost of an update", "ratio"], rows))


if __name__ == "__main__":
    main()
