"""CVAT's tracking function over a clip, called as CVAT's agent calls it: the program's boxes."""

import subprocess

import numpy as np
import pytest

cvataa = pytest.importorskip("cvat_sdk.auto_annotation")
PIL_Image = pytest.importorskip("PIL.Image")


class Context(cvataa.TrackingFunctionShapeContext):
    original_shape_type = "rectangle"


def images(frames):
    return [PIL_Image.fromarray(np.ascontiguousarray(frame[:, :, ::-1])) for frame in frames]


def rectangle(box):
    x, y, w, h = box
    return cvataa.TrackableShape(type="rectangle", points=[x, y, x + w, y + h])


def tracked(function, frames, box):
    shown = [function.preprocess_image(Context(), image) for image in images(frames)]
    state = function.init_tracking_state(Context(), shown[0], rectangle(box))
    return [function.track(Context(), image, state) for image in shown[1:]]


def test_it_gives_the_programs_boxes(walk, program, tmp_path):
    from infopart import cvat

    frames, truth = walk
    folder, out = tmp_path / "walk", tmp_path / "boxes.csv"
    folder.mkdir()
    for number, image in enumerate(images(frames)):
        image.save(folder / f"{number:04d}.png")
    words = [program, "track", folder, "--init", ",".join(map(str, truth[0])), "--seed", "3", "--out", out, "--quiet"]
    subprocess.run(words, check=True, capture_output=True)
    rows = np.genfromtxt(out, delimiter=",", names=True)
    shapes = tracked(cvat.create(seed=3), frames, truth[0])
    assert {shape.type for shape in shapes} == {"rectangle"} and len(shapes) == 19
    theirs = np.stack([rows[name][1:] for name in ("x", "y", "w", "h")], axis=1)
    theirs[:, 2:] += theirs[:, :2]
    np.testing.assert_allclose([shape.points for shape in shapes], theirs, atol=0.001)


def test_each_shape_has_a_state_of_its_own_and_a_lost_one_no_shape(walk):
    from infopart import cvat

    frames, truth = walk
    function = cvat.create(seed=1, region="whole")
    assert function.spec.supported_shape_types == {"rectangle"}
    shown = [function.preprocess_image(Context(), image) for image in images(frames)]
    states = [function.init_tracking_state(Context(), shown[0], rectangle(truth[0])) for _ in range(2)]
    first = [function.track(Context(), image, states[0]).points for image in shown[1:8]]
    assert [function.track(Context(), image, states[1]).points for image in shown[1:8]] == first
    noise = np.random.default_rng(1).integers(0, 256, frames[0].shape, np.uint8)
    seen = [function.track(Context(), noise, states[0]) for _ in range(12)]
    assert seen[-1] is None


def test_an_unknown_parameter_is_told_at_once():
    from infopart import cvat

    with pytest.raises(ValueError, match="did you mean `particles`"):
        cvat.create(particels=10)
