"""Trackers as TraX servers: the protocol itself, our server, and the reference client."""

import base64
import os
import subprocess
import sys

import numpy as np
import pytest

import infopart
from infopart import trax

cv2 = pytest.importorskip("cv2")

TRACKERS = '''
import numpy as np
print("loading weights")

class OpenCvLike:
    def init(self, image, box): self.box = box
    def update(self, image):
        print("a print of the tracker's")
        x, y, w, h = self.box
        self.box = x + 1, y, w, h
        return True, self.box

class Loses(OpenCvLike):
    def update(self, image): return False, (0, 0, 0, 0)

class Got10kLike(OpenCvLike):
    def update(self, image): return np.array(super().update(image)[1], np.float32)

class PyTrackingLike:
    def __init__(self, step=1): self.step = step
    def initialize(self, image, info): self.box = info["init_bbox"]
    def track(self, image):
        self.box = [self.box[0] + self.step, *self.box[1:]]
        return {"target_bbox": self.box, "object_presence_score": 0.25}

class Red:
    def init(self, image, box): self.box = box
    def update(self, image): return True, (float(image[9, 4, 0]), *self.box[1:])

class Three(OpenCvLike):
    def update(self, image): return True, (1, 2, 3)

class NotANumber(OpenCvLike):
    def update(self, image): return True, (1, 2, 3, float("nan"))

class Seeded(OpenCvLike):
    def __init__(self, seed=0): self.seed = seed
    def update(self, image): return True, (self.seed, *self.box[1:])
'''


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("trax")
    (folder / "mine.py").write_text(TRACKERS)
    from conftest import scene

    frames, boxes = scene(4)
    for number, frame in enumerate(frames):
        cv2.imwrite(str(folder / f"{number}.png"), frame)
    return folder, frames, boxes


def converse(folder, words, lines, **environment):
    done = subprocess.run(
        [sys.executable, "-m", "infopart.trax", *words],
        input="".join(lines), capture_output=True, text=True, cwd=folder, env={**os.environ, **environment}, timeout=60,
    )
    messages = [trax.decode(line) for line in done.stdout.splitlines()]
    return done, messages


def session(folder, box="5,6,20,30", version=4, frames=3):
    path = lambda number: f"file://{folder / f'{number}.png'}"
    first = [trax.encode("initialize", (box,)), trax.encode("frame", (path(0),))]
    if version < 4:
        first = [trax.encode("initialize", (path(0), box))]
    return [*first, *(trax.encode("frame", (path(number),)) for number in range(1, frames)), trax.encode("quit")]


def states(messages):
    return [(tuple(map(float, arguments[0].split(","))), said) for kind, arguments, said in messages if kind == "state"]


@pytest.mark.parametrize("version", [1, 4])
@pytest.mark.parametrize("name", ["OpenCvLike", "Got10kLike", "PyTrackingLike"])
def test_three_manners_are_served_and_their_prints_kept_apart(folder, name, version):
    done, messages = converse(folder[0], [f"mine:{name}"], session(folder[0], version=version))
    assert done.returncode == 0, done.stderr
    assert messages[0][0] == "hello" and messages[0][2]["trax.name"] == name
    assert [box for box, _ in states(messages)] == [(5, 6, 20, 30), (6, 6, 20, 30), (7, 6, 20, 30)]
    assert all(float(said["time"]) >= 0 for _, said in states(messages))
    assert "loading weights" in done.stderr
    if name == "PyTrackingLike":
        assert states(messages)[1][1]["confidence"] == "0.25"


def test_a_lost_target_keeps_its_last_box_and_options_and_seed_arrive(folder):
    _, messages = converse(folder[0], ["mine:Loses"], session(folder[0]))
    assert [(box, said.get("status")) for box, said in states(messages)][1:] == [((5, 6, 20, 30), "lost")] * 2
    _, messages = converse(folder[0], ["mine:PyTrackingLike", "--option", "step=3"], session(folder[0]))
    assert states(messages)[1][0][0] == 8
    _, messages = converse(folder[0], ["mine:Seeded"], session(folder[0]), INFOPART_SEED="7")
    assert states(messages)[1][0][0] == 7
    _, messages = converse(folder[0], ["mine:Red", "--rgb"], session(folder[0]))
    assert states(messages)[1][0][0] == folder[1][1][9, 4, 2] != folder[1][1][9, 4, 0]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["mine:Three"], "3 numbers instead of 4"),
        (["mine:NotANumber"], "not finite"),
        (["mine:Nobody"], "`mine` has no `Nobody`"),
        (["nobody:Tracker"], "No module named 'nobody'"),
        (["mine"], "give MODULE:CLASS"),
        (["mine:OpenCvLike", "--option", "x"], "give NAME=VALUE"),
    ],
)
def test_what_goes_wrong_is_said_on_standard_error(folder, words, said):
    done, _ = converse(folder[0], words, session(folder[0]))
    assert done.returncode != 0 and said in done.stderr


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ([trax.encode("frame", ("file:///a.png",))], "not expected"),
        ([trax.encode("initialize", ("1,2,3",))], "3 numbers"),
        ([trax.encode("initialize", ("a,b,c,d",))], "no list of numbers"),
        ([trax.encode("initialize", ("file:///no/such.png", "1,2,3,4"))], "cannot be read"),
        (['@@TRAX:initialize "1,2,3,4\n'], "quote"),
    ],
)
def test_what_a_client_must_not_say_ends_it(folder, lines, said):
    done, _ = converse(folder[0], ["mine:OpenCvLike"], lines)
    assert done.returncode == 2 and said in done.stderr and "Traceback" not in done.stderr


def test_our_own_tracker_gives_the_boxes_of_its_class(folder):
    place, frames, boxes = folder
    tracker = infopart.Tracker(seed=5)
    tracker.init(frames[0], boxes[0])
    expected = [tracker.estimate.box, *(tracker.update(frame)[1] for frame in frames[1:])]
    box = ",".join(map(str, boxes[0]))
    _, messages = converse(place, [], session(place, box, frames=4), INFOPART_SEED="5")
    assert [found for found, _ in states(messages)] == expected


def test_images_come_as_paths_bytes_and_pixels(folder):
    place, frames, _ = folder
    coded = base64.b64encode((place / "0.png").read_bytes()).decode()
    raw = base64.b64encode(np.ascontiguousarray(frames[0][:, :, ::-1]).tobytes()).decode()
    for address in (f"file://{place / '0.png'}", f"data:image/png;base64;{coded}", f"image:160;120;rgb;{raw}"):
        assert np.array_equal(trax.read_image(address), frames[0])
    with pytest.raises(trax.ProtocolError, match="cannot be read"):
        trax.read_image("file:///no/such.png")


def test_messages_are_read_back():
    for words in ((), ("a b", 'q"uote'), ("back\\slash", "new\nline", "file:///x=1.png")):
        assert trax.decode(trax.encode("frame", words, a__b='x "y"')) == ("frame", list(words), {"a.b": 'x "y"'})
    assert trax.decode("chatter") is None


@pytest.mark.parametrize("server", ["program", "package"])
def test_the_reference_client_drives_it(folder, server, request):
    client = pytest.importorskip("trax.client", reason="pip install vot-trax")
    from trax import FileImage, Rectangle

    place, frames, boxes = folder
    if server == "program":
        command = f"{request.getfixturevalue('program')} trax"
    else:
        command = f"{sys.executable} -m infopart.trax"
    tracker = infopart.Tracker(seed=1)
    tracker.init(frames[0], boxes[0])
    expected = [tracker.estimate.box, *(tracker.update(frame)[1] for frame in frames[1:])]
    words = command.split()
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env={**os.environ, "INFOPART_SEED": "1"})
    try:
        streams = (process.stdin.fileno(), process.stdout.fileno())
        connection = client.Client(stream=streams, log=lambda text: None)
        images = [{"color": FileImage.create(str(place / f"{number}.png"))} for number in range(4)]
        found = [connection.initialize(images[0], [(Rectangle.create(*boxes[0]), {})], {})[0]]
        found += [connection.frame(image, {}, [])[0] for image in images[1:]]
        connection.quit()
        assert process.wait(30) == 0
    finally:
        process.kill()
    # The client's regions are of single precision.
    assert np.allclose([objects[0][0].bounds() for objects in found], expected, atol=1e-3)
