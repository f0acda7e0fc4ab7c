"""Whole sequences."""

import subprocess
import sys

import numpy as np
import pytest

import infopart


def columns(table, *names):
    return [tuple(float(table[name][row]) for name in names) for row in range(len(table))]


def test_frames_and_boxes_in_rows_out(walk):
    frames, truth = walk
    table = infopart.track(iter(frames), truth[0], progress=False, region="whole", seed=1)
    assert len(table) == len(frames)
    tracker = infopart.Tracker(region="whole", seed=1)
    tracker.init(frames[0], truth[0])
    expected = [truth[0], *(tracker.update(frame)[1] for frame in frames[1:])]
    assert columns(table, "x", "y", "w", "h") == expected
    assert set(table["status"]) <= {"tracking", "uncertain", "lost"}
    assert float(table["confidence"][0]) == 1


def test_a_given_tracker_is_used_and_parameters_besides_are_refused(walk):
    frames, truth = walk
    tracker = infopart.Tracker(seed=8)
    table = infopart.track(frames[:3], truth[0], progress=False, tracker=tracker)
    assert tracker.estimate.box == columns(table, "x", "y", "w", "h")[-1]
    other = infopart.track(frames[:3], truth[0], progress=False, seed=8)
    assert columns(other, "x", "y") == columns(table, "x", "y")
    with pytest.raises(ValueError, match="not both"):
        infopart.track(frames, truth[0], tracker=tracker, seed=1)


def test_what_is_missing_is_named(walk, tmp_path):
    with pytest.raises(ValueError, match="box: there is no ground truth"):
        infopart.track(walk[0])
    with pytest.raises(ValueError, match="no frame"):
        infopart.track([], (1, 2, 3, 4))
    with pytest.raises(ValueError, match="no/such/folder"):
        infopart.track("no/such/folder", (1, 2, 3, 4))


def test_an_otb_folder_needs_no_box(data):
    sequence = infopart.open_sequence(data / "otb" / "Crossing", start=3, end=6)
    assert sequence.name == "Crossing" and len(sequence) == 4 and len(sequence.ground_truth) == 4
    assert [frame.shape for frame in sequence] == [(240, 360, 3)] * 4
    table = infopart.track(data / "otb" / "Crossing", start=3, end=6, progress=False)
    assert columns(table[:1], "x", "y", "w", "h") == [sequence.ground_truth[0]]


def test_pandas_and_tqdm_are_not_needed(walk):
    code = """
import sys
sys.modules["pandas"] = sys.modules["tqdm"] = None
import numpy as np, infopart
frames = [np.random.default_rng(1).integers(0, 255, (60, 80, 3), np.uint8)] * 3
table = infopart.track(frames, (20, 20, 16, 16))
assert isinstance(table, np.ndarray) and table.dtype.names[:4] == ("x", "y", "w", "h"), table
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_stubs_say_what_there_is():
    mypy = pytest.importorskip("mypy.stubtest")
    assert mypy
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "infopart._infopart", "--concise"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_other_manners(walk, monkeypatch):
    frames, truth = walk
    from infopart import pytracking

    reference = infopart.Tracker(seed=2)
    reference.init(frames[0], truth[0])
    expected = [reference.update(frame)[1] for frame in frames[1:6]]
    rgb = [np.ascontiguousarray(frame[:, :, ::-1]) for frame in frames]

    tracker = pytracking.Tracker(seed=2)
    tracker.initialize(rgb[0], {"init_bbox": list(truth[0])})
    assert [tuple(tracker.track(image)["target_bbox"]) for image in rgb[1:6]] == expected
    with pytest.raises(ValueError, match="init_bbox"):
        tracker.initialize(rgb[0], {})
