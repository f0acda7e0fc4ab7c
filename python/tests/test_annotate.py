"""A box in every frame from a few: the program's boxes, what is refused, and what other people's readers make of the files."""

import json
import os
import subprocess

import numpy as np
import pytest

import infopart


@pytest.fixture(scope="session")
def pictures(walk, tmp_path_factory):
    """The walk as a folder of pictures."""
    cv2 = pytest.importorskip("cv2")
    folder = tmp_path_factory.mktemp("walk")
    for number, frame in enumerate(walk[0], 1):
        cv2.imwrite(str(folder / f"{number:04d}.png"), frame)
    return folder


def test_drawn_boxes_stay_the_others_are_followed_and_absence_leaves_none(walk, pictures):
    _, truth = walk
    [track] = infopart.annotate(pictures, {1: truth[0], 12: truth[11], 16: None}, seed=1, region="whole")
    assert track.boxes.shape == (20, 4) and track.confidence.shape == (20,)
    assert list(np.flatnonzero(track.drawn)) == [0, 11]
    assert tuple(track.boxes[0]) == truth[0] and tuple(track.boxes[11]) == truth[11]
    np.testing.assert_allclose(track.boxes[:15], truth[:15], atol=2)
    assert np.isnan(track.boxes[15:]).all() and np.isnan(track.confidence[15:]).all()
    assert (track.confidence[[0, 11]] == 1).all() and (track.confidence[:15] >= 0).all()


def test_what_was_tracked_serves_again_and_gives_the_boxes_of_a_new_start(walk, pictures):
    _, truth = walk
    annotator = infopart.Annotator(pictures, seed=1, region="whole")
    assert (annotator.frames, annotator.size) == (20, (160, 120))
    annotator.annotate({1: truth[0]})
    again = annotator.annotate({1: truth[0], 20: truth[19]})[0]
    anew = infopart.annotate(pictures, {1: truth[0], 20: truth[19]}, seed=1, region="whole")[0]
    np.testing.assert_array_equal(again.boxes, anew.boxes)
    forward = annotator.annotate({1: truth[0], 20: truth[19]}, sides="forward")[0]
    assert not np.array_equal(forward.boxes[1:19], anew.boxes[1:19])


def test_the_program_gives_the_same_boxes(walk, pictures, program, tmp_path):
    _, truth = walk
    keys = {"version": 1, "objects": [
        {"name": "first", "class": "square", "keys": [{"frame": 1, "box": truth[0]}, {"frame": 20, "box": truth[19]}]},
        {"name": "late", "keys": [{"frame": 5, "box": truth[4]}, {"frame": 9, "absent": True}]},
    ]}
    file, theirs, ours = (tmp_path / name for name in ("keys.json", "theirs.csv", "ours.csv"))
    file.write_text(json.dumps(keys))
    words = [program, "annotate", pictures, "--keys", file, "--out", theirs, "--seed", "1", "--quiet"]
    subprocess.run(words, check=True, capture_output=True)
    found = infopart.annotate(pictures, file, seed=1, out=ours)
    assert ours.read_bytes() == theirs.read_bytes()
    assert [(one.name, one.class_name) for one in found] == [("first", "square"), ("late", "object")]
    assert infopart.annotate(pictures, keys["objects"], seed=1)[1].boxes[3:6].tolist() == found[1].boxes[3:6].tolist()


@pytest.mark.parametrize(
    ("objects", "says"),
    [
        ({}, "no key frame with a box"),
        ([], "objects: there is none"),
        ({1: None}, "no key frame with a box"),
        ({21: (5, 5, 20, 20)}, "21"),
        ({0: (5, 5, 20, 20)}, "frames count from 1"),
        ({1: (500, 5, 20, 20)}, "500"),
        ({1: (5, 5, 20, 0)}, "frame 1"),
        ({1: (5, 5, 20)}, "objects"),
        ([{"name": "a"}], "objects: KeyError 'keys'"),
        (7, "objects: TypeError"),
        ("no/such/keys.json", "no/such/keys.json"),
    ],
)
def test_key_frames_that_cannot_be_are_refused(pictures, objects, says):
    with pytest.raises(ValueError) as refused:
        infopart.annotate(pictures, objects)
    assert says in str(refused.value)


def test_other_arguments_are_checked(walk, pictures, tmp_path):
    keys = {1: walk[1][0]}
    for arguments, says in [
        ({"sides": "left"}, "sides: it is 'left'"),
        ({"out": tmp_path / "a.csv", "format": "doc"}, "format: there is no `doc`"),
        ({"out": tmp_path, "format": "yolo"}, "out: it is there already"),
        ({"particels": 100}, "did you mean `particles`"),
    ]:
        with pytest.raises(ValueError) as refused:
            infopart.annotate(pictures, keys, **arguments)
        assert says in str(refused.value)
    with pytest.raises(ValueError, match="no/such"):
        infopart.annotate("no/such/video.mp4", keys)


def test_pycocotools_reads_coco(walk, pictures, tmp_path):
    coco = pytest.importorskip("pycocotools.coco")
    _, truth = walk
    out = tmp_path / "coco.json"
    [track] = infopart.annotate(pictures, {1: truth[0], 16: None}, seed=1, out=out)
    read = coco.COCO(str(out))
    assert len(read.getImgIds()) == 20 and [one["name"] for one in read.loadCats(read.getCatIds())] == ["object"]
    images = {one["id"]: one["file_name"] for one in read.loadImgs(read.getImgIds())}
    found = {images[one["image_id"]]: one for one in read.loadAnns(read.getAnnIds())}
    assert sorted(found) == [f"{number:04d}.png" for number in range(1, 16)]
    for number in range(1, 16):
        np.testing.assert_allclose(found[f"{number:04d}.png"]["bbox"], track.boxes[number - 1], atol=0.01)


@pytest.fixture
def keys(walk):
    """Key frames whose object is absent from frame 16 on."""
    _, truth = walk
    return {1: truth[0], 10: truth[9], 16: None}


def test_mot_score_reads_mot(pictures, keys, tmp_path):
    program = os.environ.get("MOT_PROGRAM")
    if not program:
        pytest.skip("set MOT_PROGRAM to the built program `mot`")
    truth, result, scored = (tmp_path / name for name in ("gt.txt", "tracks.txt", "scores.json"))
    [track] = infopart.annotate(pictures, keys, seed=1, out=truth, format="mot")
    # Written by hand, the first pixel being 1; one box is left out.
    rows = [f"{frame},7,{x + 1},{y + 1},{w},{h},1,-1,-1,-1" for frame, (x, y, w, h) in enumerate(track.boxes[:14], 1)]
    result.write_text("\n".join(rows) + "\n")
    words = [program, "score", truth, result, "--rules", "trackeval", "--json", scored]
    subprocess.run(words, check=True, capture_output=True)
    one = json.loads(scored.read_text())["sequences"][0]["scores"]
    assert (one["false_positives"], one["misses"], one["switches"]) == (0, 1, 0)
    assert one["mota"] == pytest.approx(14 / 15) and one["motp_overlap"] > 0.999


def test_yolo_follows_its_rule(pictures, keys, tmp_path):
    out = tmp_path / "labels_of_walk"
    objects = [{"name": "a", "class": "square", "keys": keys}, {"name": "b", "class": "bus", "keys": {20: (1, 2, 30, 40)}}]
    tracks = infopart.annotate(pictures, objects, seed=1, sides="forward", out=out, format="yolo")
    assert (out / "classes.txt").read_text().split() == ["square", "bus"]
    for number in range(1, 21):
        file = out / "labels" / f"{number:04d}.txt"
        rows = np.loadtxt(file, ndmin=2) if file.exists() and file.stat().st_size else np.empty((0, 5))
        expected = [
            [kind, (x + w / 2) / 160, (y + h / 2) / 120, w / 160, h / 120]
            for kind, track in enumerate(tracks)
            for x, y, w, h in track.boxes[number - 1 : number]
            if not np.isnan(x)
        ]
        np.testing.assert_allclose(rows, np.reshape(expected, (-1, 5)), atol=1e-5)


def test_datumaro_reads_cvat(pictures, keys, tmp_path):
    datumaro = pytest.importorskip("datumaro")
    folder = tmp_path / "cvat"
    folder.mkdir()
    objects = [{"name": '<a> & "b"', "class": "square", "keys": keys}]
    [track] = infopart.annotate(pictures, objects, seed=1, out=folder / "tracks.xml")
    read = datumaro.Dataset.import_from(str(folder), "cvat")
    labels = [label.name for label in read.categories()[datumaro.AnnotationType.label]]
    assert labels == ["square"]
    # Frames between key frames are interpolated by CVAT itself, so that only key frames are in the file.
    seen = {int(item.attributes["frame"]): one for item in read for one in item.annotations}
    assert 0 in seen and 9 in seen and max(seen) <= 15
    for frame, one in seen.items():
        if frame < 15:
            np.testing.assert_allclose(one.get_bbox(), track.boxes[frame], atol=0.01)
