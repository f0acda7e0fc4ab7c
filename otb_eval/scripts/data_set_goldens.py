#!/usr/bin/env python3
"""Makes again the numbers that tests/data_sets.rs expects of other data sets.

    pip install got10k==0.1.3 six matplotlib
    python3 otb_eval/scripts/data_set_goldens.py

Tiny copies of the data sets are made from formulas, the same as in the test. GOT-10k's numbers come from the GOT-10k toolkit's
own experiment, run whole; those by its OTB measures, for the rows of UAV123, Need for Speed and Temple Color 128, from
its functions. Those by the rules of LaSOT and UAV123 are computed here frame by frame as pytracking's documents and code state them.
"""

import json
import sys
import tempfile
import types
from pathlib import Path

import numpy as np

# Only for showing pictures.
sys.modules.setdefault("cv2", types.ModuleType("cv2"))

WIDTH, HEIGHT = 160, 120
SEQUENCES = [("GOT-10k_Val_000001", 12), ("GOT-10k_Val_000002", 30), ("GOT-10k_Val_000003", 7)]


def truth(sequence, frame):
    """The true box of a frame, which leaves the picture to the right in the end."""
    return [20 + 4 * frame + 9 * sequence, 30 + 2 * frame, 40 + sequence, 30 + (frame % 4)]


def result(sequence, frame, repetition=0):
    """A box off by a few pixels, now and then by many, and in part outside."""
    x, y, w, h = truth(sequence, frame)
    off = (frame * 7 + sequence * 3 + repetition) % 11
    far = 60 if frame % 9 == 8 else 0
    return [x + off - 5.25 - far, y - off + 3.5, w + off % 3, h - off % 4]


def cover(sequence, frame):
    """Visible eighths: nothing in every sixth frame."""
    return 0 if frame % 6 == 5 else 1 + (frame + sequence) % 8


def seconds(frame, repetition=0):
    return 0.01 + 0.001 * (frame % 5) + 0.002 * repetition


def rows(box, sequence, frames, *more):
    return np.array([box(sequence, frame, *more) for frame in range(frames)], dtype=float)


def got10k(repetitions):
    from got10k.experiments import ExperimentGOT10k
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        root, results = Path(folder, "data"), Path(folder, "results")
        (root / "val").mkdir(parents=True)
        (root / "val" / "list.txt").write_text("".join(f"{name}\n" for name, _ in SEQUENCES))
        for place, (name, frames) in enumerate(SEQUENCES):
            sequence, tracked = root / "val" / name, results / "GOT-10k" / "ours" / name
            sequence.mkdir()
            tracked.mkdir(parents=True)
            for frame in range(frames):
                Image.new("L", (2, 2)).save(sequence / f"{frame + 1:08d}.jpg")
            np.savetxt(sequence / "groundtruth.txt", rows(truth, place, frames), fmt="%.4f", delimiter=",")
            covers = [cover(place, frame) for frame in range(frames)]
            np.savetxt(sequence / "cover.label", covers, fmt="%d")
            np.savetxt(sequence / "absence.label", [int(c == 0) for c in covers], fmt="%d")
            np.savetxt(sequence / "cut_by_image.label", [0] * frames, fmt="%d")
            meta = f"[METAINFO]\nurl: none\nresolution: ({WIDTH}, {HEIGHT})\n"
            (sequence / "meta_info.ini").write_text(meta)
            times = []
            for repetition in range(repetitions):
                boxes = rows(result, place, frames, repetition)
                np.savetxt(tracked / f"{name}_{repetition + 1:03d}.txt", boxes, fmt="%.4f", delimiter=",")
                times.append([seconds(frame, repetition) for frame in range(frames)])
            np.savetxt(tracked / f"{name}_time.txt", np.array(times).T, fmt="%.8f", delimiter=",")
        experiment = ExperimentGOT10k(str(root), subset="val", result_dir=str(results), report_dir=f"{folder}/reports")
        kept = []
        evaluate = experiment._evaluate
        experiment._evaluate = lambda ious, times: (kept.append(ious), evaluate(ious, times))[1]
        report = experiment.report(["ours"])["ours"]["overall"]
        return {
            "ao": float(report["ao"]),
            "sr_50": float(report["sr"]),
            "sr_75": float(np.mean(kept[-1] > 0.75)),
            "fps": float(np.nan_to_num(report["speed_fps"])),
        }


def otb_measures():
    """The GOT-10k toolkit's OTB measures on rows with frames without a target."""
    from got10k.experiments import ExperimentOTB
    from got10k.utils.metrics import center_error, rect_iou

    scores = []
    for place, (_, frames) in enumerate(SEQUENCES):
        true, found = rows(truth, place, frames), rows(result, place, frames)
        true[[frame for frame in range(frames) if frame % 6 == 5]] = np.nan
        found[0] = true[0]
        overlaps, errors = rect_iou(found, true), center_error(found, true)
        experiment = types.SimpleNamespace(nbins_iou=21, nbins_ce=51)
        success, precision = ExperimentOTB._calc_curves(experiment, overlaps, errors)
        scores.append((np.mean(success), precision[20]))
    auc, precision = np.mean(scores, axis=0)
    return {"auc": float(auc), "precision_20": float(precision)}


def pytracking(data_set):
    """As pytracking scores LaSOT and UAV123: curves in 32 bits, an invalid frame a hit in precision on UAV123 alone."""
    curves = []
    for place, (_, frames) in enumerate(SEQUENCES):
        true, found = rows(truth, place, frames), rows(result, place, frames)
        hidden = np.array([frame % 6 == 5 for frame in range(frames)])
        if data_set == "uav":
            true[hidden] = np.nan
        found[0] = true[0]
        overlaps, errors, normalised = np.empty(frames), np.empty(frames), np.empty(frames)
        for frame in range(frames):
            (x, y, w, h), (fx, fy, fw, fh) = true[frame], found[frame]
            if not (x > 0 and y > 0 and w > 0 and h > 0) or (data_set == "lasot" and hidden[frame]):
                overlaps[frame] = -1
                errors[frame] = -1 if data_set == "uav" else np.inf
                normalised[frame] = np.inf if data_set == "lasot" and hidden[frame] else -1
                continue
            across = max(min(x + w, fx + fw) - max(x, fx), 0)
            down = max(min(y + h, fy + fh) - max(y, fy), 0)
            overlaps[frame] = across * down / (w * h + fw * fh - across * down)
            dx, dy = fx + (fw - 1) / 2 - x - (w - 1) / 2, fy + (fh - 1) / 2 - y - (h - 1) / 2
            errors[frame] = np.hypot(dx, dy)
            normalised[frame] = np.hypot(dx / w, dy / h)
        share = lambda hits: (hits.sum(0).astype(np.float32) / np.float32(frames)).astype(float)
        curves.append((
            share(overlaps[:, None] > np.arange(21) * 0.05),
            share(errors[:, None] <= np.arange(51)),
            share(normalised[:, None] <= np.arange(51) / 100),
        ))
    success, precision, normalised = (np.mean([one[kind] for one in curves], axis=0) for kind in range(3))
    return {
        "auc": float(success.mean()),
        "precision_20": float(precision[20]),
        "normalised_20": float(normalised[20]),
        "normalised_area": float(normalised.mean()),
    }


if __name__ == "__main__":
    numbers = {
        "got10k, one repetition": got10k(1),
        "got10k, three repetitions": got10k(3),
        "otb measures": otb_measures(),
        "lasot": pytracking("lasot"),
        "uav123": pytracking("uav"),
    }
    print(json.dumps(numbers, indent=2))
