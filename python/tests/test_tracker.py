"""The tracker's three ways in: what comes out, what is refused, and what survives."""

import copy
import multiprocessing
import pickle
import re
import subprocess
import threading
import time

import numpy as np
import pytest

import infopart
from conftest import scene


def boxes(tracker, frames):
    return [tracker.update(frame)[1] for frame in frames]


def started(walk, **parameters):
    frames, truth = walk
    tracker = infopart.Tracker(**parameters)
    tracker.init(frames[0], truth[0])
    return tracker


def overlap(a, b):
    w = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    h = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    shared = max(w, 0) * max(h, 0)
    return shared / (a[2] * a[3] + b[2] * b[3] - shared)


def test_it_follows_and_says_so(walk):
    frames, truth = walk
    tracker = started(walk, seed=1, region="whole")
    assert tracker.estimate.box == truth[0] and tracker.estimate.evidence is None
    for frame, true_box in zip(frames[1:], truth[1:]):
        ok, box = tracker.update(frame)
        assert ok is True and overlap(box, true_box) > 0.5
    found = tracker.estimate
    assert found.box == box and found.status == "tracking"
    assert tracker.getTrackingScore() == found.confidence > 0.7
    assert found.evidence["hog_distance"] >= 0 and sum(found.times.values()) > 0
    particles = tracker.particles()
    assert particles.shape == (tracker.config["particles"], 5)
    assert particles[:, 4].sum() == pytest.approx(1)
    centre = (particles[:, :2] + particles[:, 2:4] / 2).T @ particles[:, 4]
    assert centre == pytest.approx([box[0] + box[2] / 2, box[1] + box[3] / 2], abs=2)


def test_the_seed_and_nothing_else_decides(walk):
    frames = walk[0][1:]
    first = boxes(started(walk, seed=3), frames)
    assert boxes(started(walk, seed=3, threads=2), frames) == first
    assert boxes(started(walk, seed=4), frames) != first


def test_layouts_of_the_same_pixels_give_the_same_boxes(walk):
    frames, truth = walk
    expected = boxes(started(walk), frames[1:])

    def track(change, **parameters):
        tracker = infopart.Tracker(**parameters)
        tracker.init(change(frames[0]), truth[0])
        return boxes(tracker, [change(frame) for frame in frames[1:]])

    def inside_a_larger_one(frame):
        larger = np.full((frame.shape[0] + 9, frame.shape[1] + 7, 3), 77, np.uint8)
        larger[4:-5, 3:-4] = frame
        return larger[4:-5, 3:-4]

    def read_only(frame):
        frame = frame.copy()
        frame.flags.writeable = False
        return frame

    def with_alpha(frame):
        return np.dstack([frame, np.full(frame.shape[:2], 9, np.uint8)])

    swapped = lambda frame: frame[:, :, ::-1]
    assert track(inside_a_larger_one) == expected
    assert track(read_only) == expected
    assert track(with_alpha) == expected
    assert track(swapped, rgb=True) == expected
    assert track(lambda frame: swapped(frame).copy(), rgb=True) == expected
    assert track(lambda frame: swapped(inside_a_larger_one(frame)), rgb=True) == expected
    assert track(lambda frame: swapped(with_alpha(swapped(frame)[:, :, :])[:, :, :3])) == expected
    assert track(np.asfortranarray) == expected
    assert track(lambda frame: frame[::-1].copy()[::-1]) == expected
    assert track(lambda frame: frame[:, ::-1].copy()[:, ::-1]) == expected
    assert track(lambda frame: np.repeat(frame, 2, axis=1)[:, ::2]) == expected


def test_frames_of_one_row_or_column_are_frames():
    wide = np.arange(60, dtype=np.uint8).reshape(1, 20, 3)
    tall = np.arange(240, dtype=np.uint8).reshape(20, 4, 3)[:, 1:2]
    for frame in (wide, tall, wide[::-1], tall[::2], np.zeros((9, 30, 3), np.uint8)[4:5, 3::5]):
        tracker = infopart.Tracker(rgb=True)
        tracker.init(frame, (0, 0, frame.shape[1], frame.shape[0]))
        ok, box = tracker.update(frame)
        assert isinstance(ok, bool) and np.isfinite(box).all()


def test_grey_frames_of_two_and_three_axes_are_the_same(walk):
    frames, truth = walk
    found = []
    for change in (lambda frame: frame[:, :, 1].copy(), lambda frame: frame[:, :, 1:2], lambda frame: frame[:, :, 1]):
        tracker = infopart.Tracker()
        tracker.init(change(frames[0]), truth[0])
        found.append(boxes(tracker, [change(frame) for frame in frames[1:]]))
    assert found[0] == found[1] == found[2]


def test_boxes_are_any_four_numbers(walk):
    frames, truth = walk
    for box in (truth[0], list(truth[0]), np.array(truth[0]), np.float32(truth[0]), map(int, truth[0])):
        tracker = infopart.Tracker()
        tracker.init(frames[0], box)
        assert tracker.estimate.box == truth[0]


@pytest.mark.parametrize(
    ("frame", "said"),
    [
        ("picture.png", "frame: it is a str"),
        (None, "frame: it is a NoneType"),
        (np.zeros((20, 20, 3)), "dtype is float64"),
        (np.zeros((20, 20), bool), "dtype is bool"),
        (np.zeros((20, 20, 2), np.uint8), r"shape is \(20, 20, 2\)"),
        (np.zeros(20, np.uint8), r"shape is \(20\)"),
        (np.zeros((1, 20, 20, 3), np.uint8), r"shape is \(1, 20, 20, 3\)"),
        (np.zeros((0, 20, 3), np.uint8), "no pixel"),
        (np.zeros((20, 0), np.uint8), "no pixel"),
    ],
)
def test_what_is_no_image_is_refused(frame, said):
    with pytest.raises(ValueError, match=said):
        infopart.Tracker().init(frame, (2, 2, 8, 8))


@pytest.mark.parametrize(
    ("box", "said"),
    [
        ((1, 2, 3), "box: it has 3 numbers"),
        ((1, 2, 3, 4, 5), "more than 4"),
        (7, "box: it is a int"),
        ("1,2,3,4", "is no number"),
        ((1, 2, "x", 4), "x is no number"),
        ((float("nan"), 2, 3, 4), "box: .*finite"),
        ((1, 2, 0, 4), "box: .*positive"),
        ((1, 2, -3, 4), "box: .*positive"),
        ((500, 500, 9, 9), "box: .*inside"),
    ],
)
def test_what_is_no_box_is_refused(walk, box, said):
    with pytest.raises(ValueError, match=said):
        infopart.Tracker().init(walk[0][0], box)


def test_calls_out_of_order_are_refused_and_harm_nothing(walk):
    frames, truth = walk
    tracker = infopart.Tracker()
    for call in (lambda: tracker.update(frames[0]), tracker.getTrackingScore, lambda: tracker.estimate, tracker.particles):
        with pytest.raises(RuntimeError, match="call init"):
            call()
    assert "call init" in repr(tracker)
    tracker.init(frames[0], truth[0])
    with pytest.raises(ValueError, match="frame: .*resize"):
        tracker.update(frames[1][:50])
    assert overlap(tracker.update(frames[1])[1], truth[1]) > 0.5
    with tracker:
        pass
    for call in (lambda: tracker.update(frames[0]), lambda: tracker.init(frames[0], truth[0]), tracker.save):
        with pytest.raises(RuntimeError, match="closed"):
            call()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"partciles": 50}, "did you mean `particles`"),
        ({"zzz": 1}, "infopart.parameters"),
        ({"particles": 0}, "`particles` is 0"),
        ({"noise_x": float("nan")}, "noise_x"),
        ({"region": "half"}, "half"),
        ({"seed": "one"}, "seed"),
        ({"seed": -1}, "seed|-1"),
        ({"particles": [1]}, "particles: it is a list"),
        ({"preset": "best"}, "default, paper"),
        ({"threads": 0}, "threads: it is 0"),
        ({"threads": 2.5}, "threads: it is 2.5"),
        ({"config": "/no/such/file.toml"}, "config /no/such/file.toml"),
    ],
)
def test_wrong_parameters_are_refused_by_name(given, said):
    with pytest.raises(ValueError, match=said):
        infopart.Tracker(**given)


def test_parameters_go_over_the_file_over_the_preset(tmp_path):
    file = tmp_path / "my.toml"
    file.write_text("# mine\nparticles = 60\nseed = 9\n")
    config = infopart.Tracker(config=file, seed=4, preset="paper", noise_x=np.float64(0.25)).config
    expected = {**infopart.parameters("paper"), "particles": 60, "seed": 4, "noise_x": 0.25}
    assert config == expected
    file.write_text("particels = 60\n")
    with pytest.raises(ValueError, match=r"my\.toml: .*particels"):
        infopart.Tracker(config=file)


@pytest.mark.parametrize("through", [copy.copy, copy.deepcopy, lambda t: pickle.loads(pickle.dumps(t)), None])
def test_a_copy_at_any_frame_goes_on_to_the_same_boxes(walk, through):
    frames, _ = walk
    for at in (1, 6):
        tracker = started(walk, seed=2, threads=2)
        boxes(tracker, frames[1:at])
        tracker.note = "mine"
        other = through(tracker) if through else infopart.Tracker.load(tracker.save())
        assert other.estimate.box == tracker.estimate.box
        assert boxes(other, frames[at:]) == boxes(tracker, frames[at:])
        if through:
            assert (other.note, other.threads) == ("mine", 2)


def test_saved_bytes_that_are_none_are_refused():
    with pytest.raises(ValueError, match="no saved tracker"):
        infopart.Tracker.load(b"nonsense")
    with pytest.raises(ValueError, match="checksum"):
        infopart.Tracker.load(infopart.Tracker().save()[:-1] + b"!")


def test_two_threads_on_one_tracker_get_a_sentence():
    frames, truth = scene(3, 640, 480)
    tracker = infopart.Tracker(particles=20000)
    tracker.init(frames[0], truth[0])
    seen = []

    def work():
        for _ in range(5):
            tracker.update(frames[1])

    worker = threading.Thread(target=work)
    worker.start()
    while worker.is_alive():
        try:
            tracker.getTrackingScore()
        except RuntimeError as error:
            seen.append(str(error))
        time.sleep(0.0005)
    worker.join()
    assert seen and all("another thread" in text and "deepcopy" in text for text in seen)


def _in_child(tracker, frames, truth, queue):
    fresh = infopart.Tracker(threads=2)
    fresh.init(frames[0], truth[0])
    queue.put((boxes(tracker, frames[1:]), boxes(fresh, frames[1:])))


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork here")
def test_a_forked_child_tracks_and_does_not_hang(walk):
    frames, truth = walk
    tracker = started(walk, threads=2)
    expected = boxes(started(walk), frames[1:])
    assert boxes(tracker, frames[1:3]) == expected[:2], "the parent's pool exists now"
    tracker.init(frames[0], truth[0])
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_in_child, args=(tracker, frames, truth, queue))
    child.start()
    assert queue.get(timeout=60) == (expected, expected)
    child.join(60)
    assert child.exitcode == 0, "the child did not end"
    assert boxes(tracker, frames[1:]) == expected, "and the parent goes on"


def test_the_programs_boxes_bit_for_bit(data, program, tmp_path):
    """On frames that any decoder reads alike: JPEG decoders differ by up to a level, so these are PNG."""
    cv2 = pytest.importorskip("cv2")
    source = sorted((data / "otb" / "Crossing" / "img").glob("*.jpg"))[:40]
    folder = tmp_path / "img"
    folder.mkdir()
    for image in source:
        cv2.imwrite(str(folder / f"{image.stem}.png"), cv2.imread(str(image)))
    first = (data / "otb/Crossing/groundtruth_rect.txt").read_text().splitlines()[0]
    x, y, w, h = (int(word) for word in re.split(r"[,\s]+", first.strip()))
    box = (x - 1, y - 1, w, h)
    command = [program, "track", str(folder), "--init", ",".join(map(str, box)), "--quiet"]
    rows = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    theirs = [tuple(float(word) for word in row.split(",")) for row in rows]

    tracker = infopart.Tracker(seed=1)
    images = [cv2.imread(str(path)) for path in sorted(folder.iterdir())]
    tracker.init(images[0], box)
    assert [tracker.estimate.box, *boxes(tracker, images[1:])] == theirs
    found = infopart.track(folder, box, progress=False)
    assert [tuple(row) for row in np.array(found[["x", "y", "w", "h"]]).tolist()] == theirs
