"""A tracker as a TraX server: ``python -m infopart.trax [module:Class] [--option name=value ...]``.

TraX is how the VOT toolkit and ``otb_eval run --tracker`` speak with trackers of any language: lines on standard input
and output. Without a name InfoPart is served. A class, or a function that makes a tracker, may have the calls of OpenCV
(``init(image, box)``, ``update(image) -> (ok, box)``), of got10k (``update(image) -> box``) or of pytracking
(``initialize(image, {"init_bbox": box})``, ``track(image) -> {"target_bbox": box}``). Whatever the tracker prints goes to
standard error, for standard output belongs to the protocol.

    python -m infopart.trax cv2:TrackerMIL_create
    python -m infopart.trax infopart.rivals:CSRT
    python -m infopart.trax my_tracker:Tracker --option weights=net.pt --rgb

The seed is in the environment, INFOPART_SEED; a tracker that takes a keyword ``seed`` is given it.
"""

from __future__ import annotations

import argparse
import base64
import importlib
import inspect
import json
import math
import os
import re
import sys
import time
from collections.abc import Callable
from typing import IO, Any

import numpy as np

PREFIX = "@@TRAX:"
_WORD = re.compile(r'\s*(?:"((?:[^"\\]|\\.)*)"|([^\s"]+))')
_KEY = re.compile(r"([A-Za-z0-9._]{1,64})=(.*)\Z", re.DOTALL)


class ProtocolError(ValueError):
    """Something that the other side should not have said."""


def encode(kind: str, arguments: tuple[str, ...] = (), /, **properties: object) -> str:
    """A message as a line; in the names of properties a double underscore stands for a dot."""
    words = [*arguments, *(f"{name.replace('__', '.')}={value}" for name, value in properties.items())]
    quoted = (word.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") for word in words)
    return f"{PREFIX}{kind}" + "".join(f' "{word}"' for word in quoted) + "\n"


def decode(line: str) -> tuple[str, list[str], dict[str, str]] | None:
    """The kind, arguments and properties of a message; None for a line that is none."""
    if not line.startswith(PREFIX):
        return None
    kind, _, rest = line[len(PREFIX) :].strip().partition(" ")
    arguments, properties, at = [], {}, 0
    while rest[at:].strip():
        found = _WORD.match(rest, at)
        if not found:
            raise ProtocolError(f"the message {line.strip()!r} has an unpaired quote")
        quoted, bare = found.groups()
        word = re.sub(r"\\(.)", lambda m: "\n" if m[1] == "n" else m[1], quoted) if bare is None else bare
        named = _KEY.match(word)
        if named:
            properties[named[1]] = named[2]
        else:
            arguments.append(word)
        at = found.end()
    return kind, arguments, properties


def parse_region(text: str) -> tuple[float, float, float, float]:
    """x, y, w, h of a rectangle, or of the upright box around a polygon."""
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        raise ProtocolError(f"the region {text!r} is no list of numbers; give a rectangle or a polygon") from None
    if len(numbers) == 4:
        return numbers[0], numbers[1], numbers[2], numbers[3]
    if len(numbers) < 6 or len(numbers) % 2:
        raise ProtocolError(f"the region {text!r} has {len(numbers)} numbers; give 4, or x and y of 3 corners or more")
    xs, ys = numbers[0::2], numbers[1::2]
    return min(xs), min(ys), max(xs) - min(xs), max(ys) - min(ys)


def read_image(text: str) -> np.ndarray:
    """The image of an address, BGR; it needs OpenCV."""
    import cv2

    if text.startswith("file://"):
        image = cv2.imread(text[len("file://") :])
    elif text.startswith("data:"):
        coded = re.split(r";base64[;,]", text, maxsplit=1)[-1]
        image = cv2.imdecode(np.frombuffer(base64.b64decode(coded), np.uint8), cv2.IMREAD_COLOR)
    elif text.startswith("image:"):
        width, height, format, coded = text[len("image:") :].split(";", 3)
        return _from_memory(int(width), int(height), format, base64.b64decode(coded))
    else:
        image = cv2.imread(text)
    if image is None:
        raise ProtocolError(f"the image {text[:200]} cannot be read")
    return image


def _from_memory(width: int, height: int, format: str, raw: bytes) -> np.ndarray:
    if format == "rgb":
        return np.ascontiguousarray(np.frombuffer(raw, np.uint8).reshape(height, width, 3)[:, :, ::-1])
    if format == "gray8":
        grey = np.frombuffer(raw, np.uint8)
    elif format == "gray16":
        grey = (np.frombuffer(raw, np.uint16) >> 8).astype(np.uint8)
    else:
        raise ProtocolError(f"images of format {format!r} are not known; send rgb, gray8 or gray16")
    return np.repeat(grey.reshape(height, width, 1), 3, axis=2)


class Adapter:
    """Any of the three manners of calling a tracker behind one."""

    def __init__(self, make: Callable[[], Any], rgb: bool = False) -> None:
        self._make, self._rgb = make, rgb
        self._tracker: Any = None
        self._last: tuple[float, ...] = ()

    def prepared(self, image: np.ndarray) -> np.ndarray:
        """An image as the tracker wants it; ``start`` and ``step`` take it so, and their time is the tracker's alone."""
        return np.ascontiguousarray(image[:, :, ::-1]) if self._rgb else image

    def start(self, image: np.ndarray, box: tuple[float, float, float, float]) -> None:
        """A new tracker on its first image."""
        self._tracker, self._last = self._make(), box
        if hasattr(self._tracker, "initialize"):
            self._tracker.initialize(image, {"init_bbox": list(box)})
        elif hasattr(self._tracker, "init"):
            self._tracker.init(image, self._first_box(box))
        else:
            raise TypeError(f"{type(self._tracker).__name__} has neither `init` nor `initialize`: it is no tracker")

    def step(self, image: np.ndarray) -> tuple[tuple[float, ...], dict[str, object]]:
        """The box in the next image and what else the tracker says. Where it has none, the last one stands."""
        tracker = self._tracker
        said: dict[str, object] = {}
        answer = tracker.track(image) if hasattr(tracker, "initialize") else tracker.update(image)
        if isinstance(answer, dict):
            score = answer.get("object_presence_score")
            answer = answer["target_bbox"]
            said = {} if score is None else {"confidence": float(score)}
        elif isinstance(answer, tuple) and len(answer) == 2:
            found, answer = answer
            said = {"status": "tracking" if found else "lost"}
            # A tracker that tells more has a best guess even then.
            if hasattr(tracker, "estimate"):
                said = {"confidence": tracker.estimate.confidence, "status": tracker.estimate.status}
            elif not found:
                answer = self._last
        box = tuple(float(side) for side in np.asarray(answer, float).ravel())
        if len(box) != 4:
            raise ValueError(f"the tracker gave a box of {len(box)} numbers instead of 4: {answer!r}")
        if not all(math.isfinite(side) for side in box):
            raise ValueError(f"the tracker gave a box with numbers that are not finite: {answer!r}")
        self._last = box
        return box, said

    def _first_box(self, box: tuple[float, ...]) -> tuple[float, ...]:
        # OpenCV's own trackers take whole numbers only.
        if type(self._tracker).__module__.split(".")[0] == "cv2":
            return tuple(int(round(side)) for side in box)
        return box


def serve(adapter: Any, name: str, identifier: str, source: IO[str], sink: IO[str]) -> None:
    """Speaks TraX until the other side says quit or goes away."""

    def say(line: str) -> None:
        sink.write(line)
        sink.flush()

    hello: dict[str, object] = {"trax__version": 4, "trax__name": name, "trax__identifier": identifier}
    formats = {"trax__image": "path;memory;data;", "trax__region": "rectangle;", "trax__channels": "color"}
    say(encode("hello", (), **hello, **formats))
    waiting: list[tuple[float, float, float, float]] = []
    started = False
    for line in source:
        message = decode(line)
        if message is None:
            continue
        kind, arguments, _ = message
        if kind == "quit":
            return
        if kind == "initialize":
            if not arguments:
                waiting, started = [], False
                continue
            waiting = [parse_region(arguments[-1])]
            if len(arguments) == 1:  # Since version 4 the image comes with `frame`.
                continue
        elif kind != "frame" or not arguments or not (waiting or started):
            raise ProtocolError(f"the message {line.strip()[:200]!r} was not expected here")
        image = adapter.prepared(read_image(arguments[0]))
        begin = time.perf_counter()
        if waiting:
            box: tuple[float, ...] = waiting[0]
            said: dict[str, object] = {}
            adapter.start(image, waiting.pop())
            started = True
        else:
            box, said = adapter.step(image)
        said["time"] = f"{time.perf_counter() - begin:.6f}"
        say(encode("state", (",".join(repr(float(side)) for side in box),), **said))


def find(name: str) -> Callable[..., Any]:
    """The class or function of ``module:name``."""
    module, colon, attribute = name.partition(":")
    if not colon or not module or not attribute:
        raise SystemExit(f"error: `{name}` names no tracker; give MODULE:CLASS, such as cv2:TrackerMIL_create")
    if os.getcwd() not in sys.path:
        sys.path.insert(0, os.getcwd())
    try:
        found: Any = importlib.import_module(module)
    except ImportError as error:
        raise SystemExit(f"error: {error}; install what `{module}` needs, or give the module's right name") from None
    for part in attribute.split("."):
        if not hasattr(found, part):
            raise SystemExit(f"error: `{module}` has no `{part}`; give the name of a class or function of it")
        found = getattr(found, part)
    maker: Callable[..., Any] = found
    return maker


def _maker(name: str | None, options: dict[str, Any]) -> tuple[Callable[[], Any], str, str]:
    from . import Tracker, __version__

    seed = os.environ.get("INFOPART_SEED")
    make = find(name) if name else Tracker
    if seed is not None and "seed" not in options and (make is Tracker or _takes_seed(make)):
        options = {**options, "seed": int(seed)}
    if name is None:
        return lambda: make(**options), "infopart", f"infopart {__version__}"
    version = getattr(sys.modules.get(name.split(":")[0].split(".")[0]), "__version__", "")
    return lambda: make(**options), name.split(":")[-1], f"{name} {version}".strip()


def _takes_seed(make: Callable[..., Any]) -> bool:
    try:
        return "seed" in inspect.signature(make).parameters
    except (TypeError, ValueError):
        return False


def _value(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return text


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m infopart.trax", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tracker", nargs="?", metavar="MODULE:CLASS", help="what to serve [default: InfoPart]")
    parser.add_argument("--option", action="append", default=[], metavar="NAME=VALUE", help="a keyword argument of it")
    parser.add_argument("--rgb", action="store_true", help="hand images over red first")
    parser.add_argument("--name", help="the name in the introduction [default: the class's]")
    given = parser.parse_args()
    options = {}
    for option in given.option:
        name, equals, value = option.partition("=")
        if not equals:
            parser.error(f"--option {option}: give NAME=VALUE")
        options[name] = _value(value)
    # Standard output belongs to the protocol: what anything prints, also below Python, goes to standard error.
    sink = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    make, name, identifier = _maker(given.tracker, options)
    try:
        serve(Adapter(make, given.rgb), given.name or name, identifier, sys.stdin, sink)
    except ProtocolError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        return 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
