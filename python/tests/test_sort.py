"""Many objects from given boxes: who is who, what is refused, and that the program `mot sort` says the same."""

import os
import subprocess
from collections import defaultdict

import numpy as np
import pytest

import infopart


def walker(x, y=50):
    return (x, y, 20, 40)


def test_a_late_track_is_reported_at_its_third_box_after_the_first_and_keeps_its_detections_index():
    tracker = infopart.Sort()
    found = [tracker.update([walker(3.0 * frame), walker(200)], classes=[7, 5]) for frame in range(6)]
    assert [[one.identity for one in frame] for frame in found] == [[2, 1]] * 6
    still, moving = found[-1]
    assert (still.class_id, still.detection, moving.class_id, moving.detection) == (5, 1, 7, 0)
    np.testing.assert_allclose(still.box, walker(200), atol=1e-6)
    np.testing.assert_allclose(moving.box, walker(15), atol=0.5)
    # One who comes later waits, as he may be a mistake.
    late = [tracker.update([walker(15), walker(200), walker(400)]) for _ in range(5)]
    assert [3 in [one.identity for one in frame] for frame in late] == [False, False, False, True, True]


def test_boxes_of_low_confidence_prolong_a_track_of_byte_and_of_no_other():
    def names(method):
        tracker = infopart.Sort(method)
        return [
            [one.identity for one in tracker.update([walker(3.0 * frame)], scores=[score])]
            for frame, score in enumerate([0.9, 0.9, 0.9, 0.2, 0.9])
        ]

    assert names("byte") == [[1]] * 5
    assert names("oc") == [[1], [1], [1], [], []]
    assert names("sort") == [[1]] * 5


def test_frames_without_boxes_and_max_age_decide_how_long_a_track_is_kept():
    def name_after(gap, **parameters):
        tracker = infopart.Sort(min_hits=0, **parameters)
        for _ in range(5):
            tracker.update([walker(100)])
        for empty in ([], np.empty((0, 4)), np.empty((0, 6))[:, :4])[:gap]:
            assert tracker.update(empty) == []
        return tracker.update([walker(100)])[0].identity

    assert [name_after(gap) for gap in (0, 1, 2)] == [1, 1, 2]
    assert [name_after(gap, max_age=2) for gap in (1, 2, 3)] == [1, 1, 2]


def test_a_camera_that_pans_takes_its_tracks_along():
    rng = np.random.default_rng(5)
    ground = np.kron(rng.integers(0, 256, (40, 60), np.uint8), np.ones((8, 8), np.uint8))
    before, after = ground[:240, :320], ground[8:248, 24:344]

    def names(camera_motion):
        tracker = infopart.Sort(max_age=5, min_hits=1, camera_motion=camera_motion)
        for _ in range(5):
            tracker.update([walker(100, 80), walker(200, 80)], frame=before)
        found = [tracker.update([walker(76, 72), walker(176, 72)], frame=after) for _ in range(3)][-1]
        return sorted(one.identity for one in found)

    assert names(True) == [1, 2]
    assert names(False) == [3, 4]


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"boxes": [1, 2, 3, 4]}, "boxes: their shape is (4,)"),
        ({"boxes": [[1, 2, 3]]}, "boxes: their shape is (1, 3)"),
        ({"boxes": "all"}, "boxes: "),
        ({"boxes": [walker(1), (5, 5, 0, 7)]}, "boxes: row 1 is 5,5,0,7"),
        ({"boxes": [(5, 5, np.nan, 7)]}, "boxes: row 0"),
        ({"boxes": [(1e30, 5, 5, 7)]}, "boxes: row 0"),
        ({"boxes": [(5, 5, 1e308, 1e308)]}, "boxes: row 0"),
        ({"scores": [0.5, 0.5]}, "scores: their shape is (2,)"),
        ({"scores": [np.nan]}, "scores: that of row 0"),
        ({"classes": [-1]}, "classes: that of row 0 is -1"),
        ({"classes": ["person"]}, "classes: "),
        ({"scores": []}, "scores: their shape is (0,)"),
    ],
)
def test_what_cannot_be_tracked_is_refused_by_name_and_changes_nothing(given, says):
    tracker = infopart.Sort()
    for _ in range(4):
        tracker.update([walker(100)])
    with pytest.raises(ValueError) as refused:
        tracker.update(**{"boxes": [walker(100)], **given})
    assert says in str(refused.value) and "give" in str(refused.value)
    assert [one.identity for one in tracker.update([walker(100)])] == [1]


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"method": "deep"}, "method: there is no `deep`"),
        ({"max_age": -1}, "max_age: it is -1"),
        ({"min_hits": 1.5}, "min_hits: it is 1.5"),
        ({"min_overlap": 2.0}, "min_overlap: it is 2"),
        ({"method": "byte", "low": 0.7}, "low: 0.7 is above high, 0.6"),
        ({"method": "byte", "min_hits": 3}, "min_hits: method byte"),
        ({"method": "oc", "low": 0.1}, "low: method oc"),
        ({"high": 0.5}, "high: method sort"),
    ],
)
def test_parameters_are_checked(given, says):
    with pytest.raises(ValueError) as refused:
        infopart.Sort(**given)
    assert says in str(refused.value)


def test_without_the_frame_the_cameras_motion_cannot_be_told():
    with pytest.raises(ValueError, match="frame: camera_motion=True"):
        infopart.Sort(camera_motion=True).update([walker(1)])


@pytest.mark.parametrize("method", ["sort", "byte", "oc"])
def test_the_program_gives_the_same_tracks(method, data, tmp_path):
    program = os.environ.get("MOT_PROGRAM")
    if not program:
        pytest.skip("set MOT_PROGRAM to the built program `mot`")
    detections, out = data / "mot/PETS09-S2L1/det/det.txt", tmp_path / "tracks.txt"
    subprocess.run([program, "sort", detections, "--method", method, "--out", out], check=True, capture_output=True)
    theirs = defaultdict(list)
    for line in out.read_text().split():
        frame, identity, *box = line.split(",")[:6]
        theirs[int(frame)].append((int(identity), *map(float, box)))
    rows = np.loadtxt(detections, delimiter=",", ndmin=2)
    tracker, reported = infopart.Sort(method), 0
    for frame in range(1, int(rows[:, 0].max()) + 1):
        seen = rows[rows[:, 0] == frame]
        ours = [(one.identity, *one.box) for one in tracker.update(seen[:, 2:6], seen[:, 6])]
        np.testing.assert_allclose(ours, theirs[frame], atol=0.00501)
        reported += len(ours)
    assert reported > 3000
