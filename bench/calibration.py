#!/usr/bin/env python3
"""How far InfoPart's confidence can be trusted: does it rank frames well, and is 0.8 right eight times in ten?

Tracks people8 by the part and other7 by the whole box with several seeds. A frame is right if its overlap with the
ground truth is above one half. Says the area under the ROC curve of the confidence; for the coefficients of the
program and for logistic regressions fitted on one half of the sequences and judged on the other (in alphabetical
order every second sequence; first one of each frame alone, then one that adds the lowest of its log-odds so far),
the expected calibration error over ten bins of equal mass and the Brier score; and what is said while targets are
hidden. Writes a reliability plot. Needs numpy and `cargo build --release`; data as for rivals.py.
"""

import argparse
import json
import os
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from rivals import executable, load_numpy, overlaps, read_sequence, table
from sequences import CROWD, OTHER7, PEOPLE8, PROJECT, data_folder, fail, locate

BINS = 10
# As in src/tracker/confidence.rs: the lowest log-odds at most, what they rise by in a frame, and those of a frame alone.
HIGHEST, FORGOTTEN = 4.0, 0.005
PROGRAM = [-0.42, 2.59, -2.64, 1.29]
# (sequence, first and last frame in which the target is hidden or half hidden, frame from which it must be tracked)
HIDDEN = [("Jogging-1", 70, 76, 92), ("Jogging-2", 50, 55, 73)]
DIPS = [("David3", 80, 90), ("David3", 184, 192)]


def track(job):
    """Rows of one pass, each with the overlap of its box, from the second frame on; without truth it is None."""
    program, data, name, region, seed = job
    folder, target, truth_file = locate(data, name)
    with tempfile.TemporaryDirectory() as scratch:
        out = Path(scratch) / "rows.jsonl"
        command = [program, "track", folder, "--seed", seed, "--region", region, "--threads", 1, "--quiet", "--out", out]
        command += ["--target", target] if target else []
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            fail(f"{program} failed on {folder} with exit code {done.returncode}: {done.stderr.strip()}")
        rows = [json.loads(line) for line in out.read_text().splitlines()]
    truth = read_sequence(name, folder, target, truth_file).truth
    boxes = np.array([[row[key] for key in "xywh"] for row in rows])[: len(truth)]
    found = overlaps(boxes, truth[: len(boxes)])
    for row, value, box in zip(rows, found, truth):
        row["overlap"] = float(value) if box[2] > 0 and box[3] > 0 else None
    return name, seed, rows[: len(boxes)]


def area_under_roc(right, score):
    """Probability that a right frame scores above a wrong one, ties counting one half (Mann, Whitney 1947)."""
    values, inverse, counts = np.unique(score, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts - 1) / 2)[inverse]
    ours = int(right.sum())
    return (ranks[right].sum() - ours * (ours + 1) / 2) / (ours * (len(right) - ours))


def bins(right, probability):
    order = np.argsort(probability, kind="stable")
    return [(probability[part].mean(), right[part].mean(), len(part)) for part in np.array_split(order, BINS)]


def calibration_error(right, probability):
    parts = bins(right, probability)
    return sum(abs(said - was) * n for said, was, n in parts) / len(right)


def fit(features, right, weights):
    """Logistic regression by Newton's method, with a faint ridge that keeps it finite."""
    design = np.column_stack([np.ones(len(features)), features])
    ridge = 1e-4 * np.diag([0.0] + [1.0] * features.shape[1])
    coefficients = np.zeros(design.shape[1])
    weights = weights / weights.sum()
    for _ in range(50):
        probability = 1 / (1 + np.exp(-design @ coefficients))
        gradient = design.T @ (weights * (probability - right)) + ridge @ coefficients
        curvature = weights * probability * (1 - probability)
        step = np.linalg.solve(design.T @ (design * curvature[:, None]) + ridge, gradient)
        coefficients -= step
        if np.abs(step).max() < 1e-10:
            break
    return coefficients


def predict(features, coefficients):
    return 1 / (1 + np.exp(-(coefficients[0] + features @ coefficients[1:])))


def evidence(passes):
    """Of every pass, from its second frame on: the sequence, what a frame alone shows, what the program said, whether the
    frame has a truth, and whether it is right."""
    found = []
    for name, _, frames in passes:
        rows = [row for row in frames if row["frame"] > 1]
        shown = np.array([[row["mean_stump"], row["hog_distance"], np.log(max(row["peak_sharpness"], 1.0))] for row in rows])
        said = np.array([row["confidence"] for row in rows])
        known = np.array([row["overlap"] is not None for row in rows])
        right = np.array([row["overlap"] is not None and row["overlap"] > 0.5 for row in rows])
        found.append((name, shown, said, known, right))
    return found


def pooled(found):
    """Sequence, what is shown and said, and whether it is right, of all frames that have a truth."""
    sequence = np.array([name for name, _, _, known, _ in found for _ in range(known.sum())])
    return sequence, *(np.concatenate([one[k][one[3]] for one in found]) for k in (1, 2, 4))


def with_memory(found, of_frame):
    """Log-odds of every frame alone, and the lowest so far, forgotten little by little."""
    pairs = []
    for _, shown, _, known, _ in found:
        log_odds, lowest = of_frame[0] + shown @ of_frame[1:], HIGHEST
        for value, counts in zip(log_odds, known):
            lowest = min(value, lowest + FORGOTTEN, HIGHEST)
            if counts:
                pairs.append((value, lowest))
    return np.array(pairs)


def judge(passes, crowd):
    found = evidence(passes)
    sequence, shown, said, right = pooled(found)
    names = sorted(set(sequence), key=str.lower)
    weights = np.array([1 / np.sum(sequence == name) for name in names])[np.array([names.index(name) for name in sequence])]

    def fitted(inside):
        """Coefficients of the frame alone and of the frame and its memory, by some of the frames; and what they say of all."""
        of_frame = fit(shown[inside], right[inside], weights[inside])
        pairs = with_memory(found, of_frame)
        with_lowest = fit(pairs[inside], right[inside], weights[inside])
        return of_frame, with_lowest, predict(pairs, with_lowest)

    print(f"{len(right)} frames, {right.mean():.3f} of them right; area under ROC of the confidence: "
          f"**{area_under_roc(right, said):.3f}**\n")
    lines, held_out = [], np.empty(len(right))
    for label, half, judged in [("first half", names[::2], names[1::2]), ("second half", names[1::2], names[::2])]:
        outside = np.isin(sequence, judged)
        held_out[outside] = fitted(np.isin(sequence, half))[2][outside]
        lines.append([f"fitted on the {label}: {', '.join(half)}", *numbers(right[outside], held_out[outside])])
    lines.append(["the two together", *numbers(right, held_out)])
    of_frame, with_lowest, on_all = fitted(np.full(len(right), True))
    lines.append(["fitted on all, judged on all", *numbers(right, on_all)])
    lines.append(["the program's coefficients, on all", *numbers(right, said)])
    program = fit(with_memory(found, PROGRAM), right, weights)
    if crowd:
        in_crowd = evidence(crowd)
        _, _, crowd_said, crowd_right = pooled(in_crowd)
        lines.append(["fitted on all, judged in a crowd", *numbers(crowd_right, predict(with_memory(in_crowd, of_frame), with_lowest))])
        lines.append(["the program's coefficients, in a crowd", *numbers(crowd_right, crowd_said)])
    print(table(["", "ROC", "calibration error", "Brier"], lines))
    print(f"\nFitted on all: of a frame alone, intercept, mean stump, HOG distance, ln sharpness = {np.round(of_frame, 2)}; with its memory, "
          f"intercept, log-odds, lowest log-odds = {np.round(with_lowest, 2)}, and over the program's log-odds {np.round(program, 2)}\n")
    return bins(right, held_out), bins(right, said)


def numbers(right, probability):
    brier = ((probability - right) ** 2).mean()
    return [f"{area_under_roc(right, probability):.3f}", f"{calibration_error(right, probability):.3f}", f"{brier:.3f}"]


def hidden(passes):
    lines = []
    for name, first, last, again in HIDDEN:
        for _, seed, frames in (one for one in passes if one[0] == name):
            said = [row["status"] for row in frames[first - 1:last]]
            after = frames[again - 1:]
            lowest = min(row["overlap"] for row in after if row["overlap"] is not None)
            tracking = sum(row["status"] == "tracking" for row in after)
            counts = ", ".join(f"{said.count(status)} {status}" for status in ("tracking", "uncertain", "lost"))
            lines.append([name, str(seed), f"{first}-{last}: {counts}", f"from {again}: {tracking} of {len(after)} tracking, overlap >= {lowest:.2f}"])
    for name, first, last in DIPS:
        for _, seed, frames in (one for one in passes if one[0] == name):
            said = [row["confidence"] for row in frames]
            lines.append([name, str(seed), f"{first}-{last}: confidence down to {min(said[first - 1:last]):.2f}", f"median of all {np.median(said):.2f}"])
    print(table(["sequence", "seed", "while hidden", "else"], lines))


def plot(path, curves):
    """Reliability curves as SVG: said against was, on the unit square."""
    side, margin = 400, 60
    at = lambda said, was: f"{margin + said * side:.1f},{margin + (1 - was) * side:.1f}"
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {side + 2 * margin} {side + 2 * margin + 20}" '
             'font-family="sans-serif" font-size="14"><rect width="100%" height="100%" fill="white"/>']
    for tick in range(6):
        value = tick / 5
        x, y = at(value, value).split(",")
        parts.append(f'<path d="M{at(value, 0)} L{at(value, 1)} M{at(0, value)} L{at(1, value)}" stroke="#ddd"/>')
        parts.append(f'<text x="{x}" y="{margin + side + 20}" text-anchor="middle">{value:.1f}</text>')
        parts.append(f'<text x="{margin - 8}" y="{float(y) + 5}" text-anchor="end">{value:.1f}</text>')
    parts.append(f'<path d="M{at(0, 0)} L{at(1, 1)}" stroke="#888" stroke-dasharray="5 5"/>')
    for number, (label, colour, points) in enumerate(curves):
        line = " L".join(at(said, was) for said, was, _ in points)
        parts.append(f'<path d="M{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for point in points:
            x, y = at(*point[:2]).split(",")
            parts.append(f'<circle cx="{x}" cy="{y}" r="4" fill="{colour}"/>')
        parts.append(f'<text x="{margin + 12}" y="{margin + 20 + 20 * number}" fill="{colour}">{label}</text>')
    parts.append(f'<text x="{margin + side / 2}" y="{margin + side + 44}" text-anchor="middle">confidence</text>')
    parts.append(f'<text transform="translate(18,{margin + side / 2}) rotate(-90)" text-anchor="middle">'
                 'share of frames with overlap above 0.5</text></svg>\n')
    Path(path).write_text("\n".join(parts))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=5, help="seeds 1 to this [default: 5]")
    parser.add_argument("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    parser.add_argument("--data", help="the folder that holds otb/ and people/ [default: INFOPART_DATA]")
    parser.add_argument("--crowd", metavar="FOLDER", help="what crowd.py made: judge on it too, which nothing was fitted on")
    parser.add_argument("--plot", metavar="FILE.svg", help="write a reliability plot")
    options = parser.parse_args()
    program = executable(options.infopart)
    load_numpy()
    data = data_folder(options.data)
    sequences = [(name, "part") for name in PEOPLE8] + [(name, "whole") for name in OTHER7]
    jobs = [(program, data, *sequence, seed) for sequence in sequences for seed in range(1, options.seeds + 1)]
    if options.crowd:
        crowd = Path(options.crowd)
        if not (crowd / "otb" / CROWD[0]).is_dir():
            fail(f"--crowd {crowd}: no otb/{CROWD[0]} there: make it with `python3 bench/crowd.py {crowd}`")
        jobs += [(program, crowd, name, "part", seed) for name in CROWD for seed in range(1, options.seeds + 1)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        passes = list(pool.map(track, jobs))
    held_out, shipped = judge(
        [one for one in passes if one[0] not in CROWD], [one for one in passes if one[0] in CROWD]
    )
    hidden(passes)
    if options.plot:
        plot(options.plot, [("on sequences not fitted on", "#c03020", held_out), ("the program's, on all", "#2060b0", shipped)])


if __name__ == "__main__":
    main()
