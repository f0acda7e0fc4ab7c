#!/usr/bin/env python3
"""Tables of the colour-histogram particle filter.

  trackers    mean overlap, R1, R2 and AUC on people8 and boat1: colour, infopart, whole-body, and the published CPF
  variants    mean overlap of the colour tracker with one setting changed at a time
  resampling  mean squared error of the centre and N_eff of four filters over several sampling steps
  errors      a plot (SVG) of the centre error in each frame of one sequence

A cell is a mean over the seeds. A sampling step of s shows the filter every s-th frame only. Mean overlap is over the
frames with ground truth, the first among them, as the benchmark has it. Needs a built program; data as for rivals.py.
"""

import argparse
import csv
import os
import statistics
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from rivals import executable, load_numpy, overlaps, read_sequence, score, table
from sequences import PEOPLE8, PROJECT, data_folder, fail, locate

load_numpy()

BOAT = "boat1"
# Mean overlap that the benchmark published for its own colour particle filter (Perez et al. 2002).
CPF = {"Crossing": 0.534, "Walking2": 0.321, "David3": 0.580, "Jogging-1": 0.519, "Jogging-2": 0.610, "Couple": 0.567}
WAYS = {
    "colour": ["--tracker", "colour"],
    "infopart": [],
    "whole-body": ["--region", "whole"],
}
FILTERS = {
    "none (SIS)": 'resampling = "none"',
    "plain": 'resampling = "multinomial"\nresampling_threshold = 1.1',
    "improved": 'resampling = "systematic"\nresampling_threshold = 0.5',
    "regularised": 'resampling = "regularised"\nresampling_threshold = 0.5',
}
VARIANTS = {
    "default": "",
    'normalisation = "l1"': 'normalisation = "l1"',
    "gradient = false": "gradient = false",
    'halves = "mean"': 'halves = "mean"',
    'halves = "whole"': 'halves = "whole"',
    'velocity = "none"': 'velocity = "none"',
    'velocity = "window"': 'velocity = "window"',
    "brightness = true": "brightness = true",
    "model_rate = 0.05": "model_rate = 0.05",
    "noise_w = 0.01": "noise_w = 0.01",
    "noise_w = 0.03": "noise_w = 0.03",
    "similarity_weight = 20": "similarity_weight = 20",
    "similarity_weight = 40": "similarity_weight = 40",
    "noise half": "noise_x = 0.2\nnoise_y = 0.1",
    "noise double": "noise_x = 0.8\nnoise_y = 0.4",
    'resampling = "none"': 'resampling = "none"',
    'resampling = "multinomial"': 'resampling = "multinomial"',
    'resampling = "stratified"': 'resampling = "stratified"',
    'resampling = "residual"': 'resampling = "residual"',
    'resampling = "regularised"': 'resampling = "regularised"',
    "particles = 1000": "particles = 1000",
}


def track(options, folder, target, flags, seed, extra=()):
    """Rows of the program as a list of dictionaries."""
    with tempfile.TemporaryDirectory() as scratch:
        rows = Path(scratch) / "rows.csv"
        command = [options.infopart, "track", folder, *flags, "--seed", seed, "--threads", 1, "--quiet", "--out", rows, *extra]
        command += ["--target", target] if target else []
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            fail(f"{options.infopart} failed on {folder} with exit code {done.returncode}: {done.stderr.strip()}")
        return list(csv.DictReader(rows.open()))


def boxes_of(rows):
    return np.array([[float(row[key]) for key in ("x", "y", "w", "h")] for row in rows])


def mean_overlap(boxes, truth):
    present = np.isfinite(truth).all(axis=1) & (truth[:, 2:] > 0).all(axis=1)
    return float(overlaps(boxes[present], truth[present]).mean())


def each(jobs):
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(lambda job: job(), jobs))


def configurations(texts, folder):
    """Flags of the colour tracker for each name."""
    flags = {}
    for number, (name, text) in enumerate(texts.items()):
        path = Path(folder) / f"{number}.toml"
        path.write_text(text + "\n")
        flags[name] = ["--tracker", "colour", "--config", path]
    return flags


def measure(options, sequences, flags):
    """{(sequence, way): boxes of each seed}."""
    keys = [(name, way, seed) for name in sequences for way in flags for seed in range(1, options.seeds + 1)]
    one = lambda name, way, seed: boxes_of(track(options, *sequences[name][1:3], flags[way], seed))
    done = each([lambda key=key: one(*key) for key in keys])
    found = {}
    for (name, way, _), boxes in zip(keys, done):
        found.setdefault((name, way), []).append(boxes)
    return found


def trackers(options, sequences):
    ways = {way: WAYS[way] for way in options.ways}
    found = measure(options, sequences, ways)
    rows = []
    for name, sequence in sequences.items():
        cells = []
        for way in ways:
            overlap = statistics.mean(mean_overlap(boxes, sequence.truth) for boxes in found[name, way])
            scores = [score(boxes, sequence.truth) for boxes in found[name, way]]
            mean = lambda key: statistics.mean(s[key] for s in scores)
            cells.append(f"{overlap:.3f} / {mean('r1'):.1f} / {mean('r2'):.1f} / {mean('auc'):.3f}")
        rows.append([name, *cells, f"{CPF[name]:.3f}" if name in CPF else ""])
    six = lambda way: statistics.mean(mean_overlap(boxes, sequences[name].truth) for name in CPF for boxes in found[name, way])
    if all(name in sequences for name in CPF):
        mean = statistics.mean(CPF.values())
        rows.append(["mean overlap of the six", *(f"{six(way):.3f}" for way in ways), f"{mean:.3f}"])
    print(table(["mean overlap / R1 / R2 / AUC", *ways, "CPF, published"], rows))


def variants(options, sequences):
    with tempfile.TemporaryDirectory() as folder:
        texts = {name: VARIANTS[name] for name in (options.only or VARIANTS)}
        flags = configurations(texts, folder)
        found = measure(options, sequences, flags)
    rows = []
    for way in flags:
        means = [statistics.mean(mean_overlap(b, sequences[n].truth) for b in found[n, way]) for n in sequences]
        rows.append([way, *(f"{mean:.3f}" for mean in means), f"{statistics.mean(means):.3f}"])
    print(table(["mean overlap", *sequences, "mean"], rows))


def every(sequence, step, folder):
    """An OTB folder of each step-th frame, and its truth."""
    images = Path(folder) / f"{sequence.name}-{step}" / "img"
    images.mkdir(parents=True)
    for number, file in enumerate(sequence.files[::step], 1):
        (images / f"{number:04}{file.suffix}").symlink_to(file.resolve())
    truth = sequence.truth[::step]
    text = "".join(",".join(repr(float(value)) for value in row) + "\n" for row in truth)
    (images.parent / "groundtruth_rect.txt").write_text(text)
    return images.parent, truth


def squared_errors(rows, truth):
    boxes = boxes_of(rows)
    return ((boxes[:, :2] + boxes[:, 2:] / 2 - truth[:, :2] - truth[:, 2:] / 2) ** 2).sum(axis=1)


def resampling(options, sequences):
    seeds = range(1, options.seeds + 1)
    header = ["", *(f"step {step}" for step in options.steps)]
    with tempfile.TemporaryDirectory() as folder:
        flags = configurations(FILTERS, folder)
        thinned = {(name, step): every(s, step, folder) for name, s in sequences.items() for step in options.steps}
        keys = [(name, step, way, seed) for name, step in thinned for way in flags for seed in seeds]
        one = lambda name, step, way, seed: track(options, thinned[name, step][0], None, flags[way], seed)
        done = dict(zip(keys, each([lambda key=key: one(*key) for key in keys])))
    for names in [*([name] for name in sequences), list(sequences)]:
        rows = []
        for way in FILTERS:
            cells = []
            for step in options.steps:
                runs = [(done[name, step, way, seed], thinned[name, step][1]) for name in names for seed in seeds]
                error = statistics.mean(float(np.nanmean(squared_errors(r, t))) for r, t in runs)
                sizes = statistics.mean(statistics.mean(float(row["effective_sample_size"]) for row in r[1:]) for r, _ in runs)
                cells.append(f"{error:.0f} ({sizes:.0f})")
            rows.append([way, *cells])
        print(f"\n{names[0] if len(names) == 1 else 'mean of all'}: squared pixels (mean N_eff)\n\n{table(header, rows)}")


COLOURS = {"none (SIS)": "#999999", "plain": "#d95f02", "improved": "#1b9e77", "regularised": "#7570b3"}


def errors(options, sequences):
    (name, sequence), *others = sequences.items()
    if others:
        fail("errors: give one sequence with --sequences")
    with tempfile.TemporaryDirectory() as folder:
        flags = configurations(FILTERS, folder)
        del flags["none (SIS)"]
        done = each([lambda f=f: track(options, sequence.folder, sequence.target, f, 1) for f in flags.values()])
    curves = {way: np.sqrt(squared_errors(rows, sequence.truth)) for way, rows in zip(flags, done)}
    options.out.write_text(svg(name, curves))
    worst = {way: ", ".join(str(i + 1) for i in np.argsort(-curve)[:4]) for way, curve in curves.items()}
    rows = [[way, f"{curve.mean():.2f}", f"{curve.max():.1f}", worst[way]] for way, curve in curves.items()]
    print(table([name, "mean error, pixels", "largest", "frames of the largest"], rows))


def svg(name, curves):
    width, height, left, bottom = 860, 300, 56, 44
    frames, top = len(next(iter(curves.values()))), max(curve.max() for curve in curves.values()) * 1.05
    x = lambda frame: left + frame / max(frames - 1, 1) * (width - left - 16)
    y = lambda error: height - bottom - error / top * (height - bottom - 34)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">']
    parts.append(f'<rect width="{width}" height="{height}" fill="white"/>')
    spacing = 10 ** np.floor(np.log10(top))
    spacing = next(spacing * part for part in (1, 0.5, 0.2, 0.1) if top / (spacing * part) >= 4)
    for tick in np.arange(0, top, spacing):
        parts.append(f'<line x1="{left}" x2="{width - 16}" y1="{y(tick):.1f}" y2="{y(tick):.1f}" stroke="#e4e4e4"/>')
        parts.append(f'<text x="{left - 6}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick:g}</text>')
    for frame in range(0, frames, max(1, frames // 10)):
        parts.append(f'<text x="{x(frame):.1f}" y="{height - bottom + 18}" text-anchor="middle">{frame + 1}</text>')
    parts.append(f'<text x="{(left + width) / 2}" y="{height - 8}" text-anchor="middle">frame</text>')
    parts.append(f'<text transform="translate(14 {(height - bottom) / 2 + 60}) rotate(-90)">centre error, pixels</text>')
    for place, (way, curve) in enumerate(curves.items()):
        points = " ".join(f"{x(i):.1f},{y(error):.1f}" for i, error in enumerate(curve))
        colour = COLOURS[way]
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        parts.append(f'<text x="{left + 110 * place + 150}" y="20" fill="{colour}">{way}</text>')
    parts.append(f'<text x="{left}" y="20" font-weight="bold">{name}</text></svg>\n')
    return "\n".join(parts)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("table", choices=TABLES)
    add("--sequences", nargs="+", default=None, metavar="NAME", help="[default: people8 and boat1; boat1 for errors]")
    add("--seeds", type=int, default=5, help="seeds 1 to this [default: 5]")
    add("--ways", nargs="+", default=list(WAYS), choices=WAYS, help="trackers of `trackers` [default: all]")
    add("--only", nargs="+", default=None, choices=VARIANTS, metavar="VARIANT", help="rows of `variants` [default: all]")
    add("--steps", nargs="+", type=int, default=[1, 2, 3, 5], help="sampling steps of `resampling` [default: 1 2 3 5]")
    add("--out", type=Path, default=Path("errors.svg"), help="the plot of `errors` [default: errors.svg]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/, people/ and ships/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    options.infopart = executable(options.infopart)
    if options.seeds < 1 or min(options.steps) < 1:
        fail("--seeds and --steps must be at least 1")
    options.sequences = options.sequences or ([BOAT] if options.table == "errors" else [*PEOPLE8, BOAT])
    return options


TABLES = {"trackers": trackers, "variants": variants, "resampling": resampling, "errors": errors}


def main():
    options = arguments()
    data = data_folder(options.data)
    sequences = {name: read_sequence(name, *locate(data, name)) for name in options.sequences}
    TABLES[options.table](options, sequences)


if __name__ == "__main__":
    main()
