"""The tracker, with names checked and defaults filled in."""

from __future__ import annotations

import difflib
import json
import os
from typing import Any, NamedTuple

from . import _infopart


class Estimate(NamedTuple):
    """What the tracker says of a frame."""

    box: tuple[float, float, float, float]
    """The whole target: x, y, w, h in pixels, the first pixel being 0; not cut off at the frame's border."""
    part: tuple[float, float, float, float]
    """The part of it that was tracked, likewise."""
    confidence: float
    """How sure the tracker is that the box holds the target, in [0, 1]."""
    status: str
    """``tracking``, ``uncertain`` (nothing is learnt) or ``lost``."""
    effective_sample_size: float
    """Of the particles before resampling, in [1, particles]."""
    covariance: tuple[tuple[float, float, float], ...]
    """Of the part's (x, y, w), in square pixels."""
    evidence: dict[str, float | None] | None
    """What the confidence follows from; None in the first frame."""
    times: dict[str, float]
    """Seconds that each stage of the last ``init`` or ``update`` took."""


def parameters(preset: str = "default") -> dict[str, Any]:
    """Every parameter of a preset (``default`` or ``paper``) with its value, as ``infopart config`` explains them."""
    values: dict[str, Any] = json.loads(_infopart.parameters(preset))
    return values


class Tracker(_infopart.NativeTracker):
    """Follows one target through the frames of a video, with the calls of OpenCV's trackers.

    seed: of all randomness; the same seed gives the same boxes. preset: ``default`` or ``paper``. config: a TOML file as
    ``infopart config`` prints it; its keys go over the preset's, keyword parameters over both. threads: how many the
    tracker may use; 1 works on the calling thread and starts none, which also a process that forks can do with. rgb: whether
    frames of three or four channels are red first.
    """

    def __new__(
        cls,
        *,
        seed: int | None = None,
        preset: str = "default",
        config: str | os.PathLike[str] | None = None,
        threads: int = 1,
        rgb: bool = False,
        **parameters: Any,
    ) -> Tracker:
        if seed is not None:
            parameters["seed"] = seed
        if isinstance(threads, bool) or not isinstance(threads, int) or not 1 <= threads <= 1024:
            raise ValueError(f"threads: it is {threads!r}; give a whole number from 1 on")
        given = to_toml(parameters, preset)
        if config is None:
            return super().__new__(cls, given, preset, threads, bool(rgb))
        try:
            return super().__new__(cls, over_file(config, given, parameters), preset, threads, bool(rgb))
        except ValueError as error:
            raise ValueError(f"config {os.fspath(config)}: {error}") from None

    def init(self, frame: Any, box: Any) -> None:
        """Starts on ``frame`` with the target in ``box``: x, y, w, h in pixels. May be called again at any time.

        Raises ValueError, naming the argument, if the frame is no image of bytes or the box cannot be tracked.
        """
        self.init_with(frame, box)

    @property
    def estimate(self) -> Estimate:
        """What the tracker says of the last frame. Raises RuntimeError before the first ``init``."""
        return Estimate(*self.last_estimate())

    @property
    def config(self) -> dict[str, Any]:
        """Every parameter and its value."""
        values: dict[str, Any] = json.loads(self.config_json())
        return values

    @classmethod
    def load(cls, saved: bytes, *, threads: int = 1, rgb: bool = False) -> Tracker:
        """The tracker that ``save()`` made these bytes of; it goes on to the same boxes. The same version must read them."""
        return _infopart.NativeTracker.__new__(cls, "", "default", threads, rgb, bytes(saved))

    def __reduce__(self) -> tuple[Any, ...]:
        return _load, (type(self), self.save(), self.threads, self.rgb, self.__dict__)

    def __copy__(self) -> Tracker:
        return _load(type(self), self.save(), self.threads, self.rgb, self.__dict__)

    def __enter__(self) -> Tracker:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        try:
            found = self.estimate
        except RuntimeError as error:
            return f"<infopart.Tracker: {error}>"
        x, y, w, h = found.box
        return f"<infopart.Tracker: {found.status} at {x:.1f},{y:.1f},{w:.1f},{h:.1f}, confidence {found.confidence:.2f}>"


def _load(cls: type[Tracker], saved: bytes, threads: int, rgb: bool, attributes: dict[str, Any]) -> Tracker:
    tracker = cls.load(saved, threads=threads, rgb=rgb)
    tracker.__dict__.update(attributes)
    return tracker


def _file_text(path: str | os.PathLike[str]) -> str:
    try:
        with open(path, encoding="utf-8") as file:
            return file.read() + "\n"
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"config {os.fspath(path)}: {error}; give a TOML file (`infopart config` prints one)") from None


def over_file(path: str | os.PathLike[str], given: str, parameters: dict[str, Any]) -> str:
    """The TOML text ``given`` of parameters, over the lines of a file but for those of keys that are given besides."""
    lines = [line for line in _file_text(path).splitlines() if line.split("=")[0].strip() not in parameters]
    return "\n".join(lines) + "\n" + given


def to_toml(given: dict[str, Any], preset: str) -> str:
    """Parameters as a TOML text; an unknown one is refused with the nearest name."""
    known = parameters(preset)
    return "".join(f"{name} = {_literal(name, value, known)}\n" for name, value in given.items())


def _literal(name: str, value: Any, known: dict[str, Any]) -> str:
    if name not in known:
        near = difflib.get_close_matches(name, known, 1, 0.4)
        hint = f"; did you mean `{near[0]}`?" if near else ""
        raise ValueError(f"there is no parameter `{name}`{hint} `infopart.parameters()` has all of them")
    value = value.item() if hasattr(value, "item") else value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        # TOML has no exponent without digits before it, and writes these as Python does but for their names.
        return {"inf": "inf", "-inf": "-inf", "nan": "nan"}.get(str(value), repr(value))
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return json.dumps(value)
    raise ValueError(f"{name}: it is a {type(value).__name__}; give a {type(known[name]).__name__}")
