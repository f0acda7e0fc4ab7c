"""A box in every frame of a video from a few that are drawn, with arguments checked."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _infopart
from ._tracker import over_file, to_toml


class Place(NamedTuple):
    """A run of frames in which the tracker is unsure; frames count from 1."""

    frame: int
    """The least sure of them: draw the object there, or say that it is absent."""
    first: int
    """The first."""
    last: int
    """The last."""
    confidence: float
    """That of ``frame``, in [0, 1]."""


class ObjectTrack(NamedTuple):
    """Where an object is. Row 0 of each array is frame 1."""

    name: str
    """What it is called."""
    class_name: str
    """What it is."""
    boxes: npt.NDArray[np.float64]
    """x, y, w, h in pixels a frame, the first pixel being 0; NaN where the object is absent."""
    confidence: npt.NDArray[np.float64]
    """In [0, 1], 1 where the box was drawn; NaN where the object is absent."""
    drawn: npt.NDArray[np.bool_]
    """Whether the box was drawn."""
    doubtful: list[Place]
    """Where to look, the most doubtful first."""


class Annotator(_infopart.NativeAnnotator):
    """A video, and what was tracked in it: another key frame costs the passes to its neighbours.

    video: a video (needs the ffmpeg program), a folder or a glob of images, or a benchmark's sequence. target: which of a
    sequence's several. memory: megabytes of decoded frames that are kept. threads, seed, preset, config and other keywords: as
    of `Tracker`.
    """

    def __new__(
        cls,
        video: str | os.PathLike[str],
        *,
        target: int | None = None,
        memory: int = 1024,
        threads: int = 1,
        seed: int | None = None,
        preset: str = "default",
        config: str | os.PathLike[str] | None = None,
        **parameters: Any,
    ) -> Annotator:
        if seed is not None:
            parameters["seed"] = seed
        text = to_toml(parameters, preset)
        if config is not None:
            text = over_file(config, text, parameters)
        return super().__new__(cls, os.fspath(video), target, memory, text, preset, threads)

    def annotate(
        self,
        objects: Any,
        *,
        sides: str = "both",
        out: str | os.PathLike[str] | None = None,
        format: str | None = None,
    ) -> list[ObjectTrack]:
        """The track of each object.

        objects: of one object a mapping from frame, counted from 1, to its box x, y, w, h in pixels, or to None from where on it
        is absent; of several a list of mappings with ``name``, ``keys`` (such a mapping, or a list as in a file of key frames)
        and perhaps ``class`` and ``colour``; or the path of a file of key frames. sides: ``both``, or ``forward`` only. out: a
        file that gets the tracks too, in ``format`` (otb, csv, jsonl, mot, cvat, coco, yolo), else that of its extension.
        """
        if sides not in ("both", "forward"):
            raise ValueError(f"sides: it is {sides!r}; give both or forward")
        found = self.tracks(_keys_text(objects), sides == "forward", None if out is None else os.fspath(out), format)
        return [
            ObjectTrack(name, kind, rows[:, :4], rows[:, 4], rows[:, 5] == 1, [Place(*one) for one in places])
            for name, kind, rows, places in found
        ]


def annotate(video: str | os.PathLike[str], objects: Any, **arguments: Any) -> list[ObjectTrack]:
    """A box in every frame of ``video``; arguments are those of `Annotator` and of its ``annotate``."""
    of_call = {name: arguments.pop(name) for name in ("sides", "out", "format") if name in arguments}
    return Annotator(video, **arguments).annotate(objects, **of_call)


def _keys_text(objects: Any) -> str:
    if isinstance(objects, (str, os.PathLike)):
        try:
            with open(objects, encoding="utf-8") as file:
                return file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise ValueError(f"objects: {error}; give a file of key frames, or key frames") from None
    if isinstance(objects, Mapping):
        objects = [{"name": "object", "keys": objects}]
    try:
        listed = [{**one, "keys": _entries(one["keys"])} for one in objects]
    except (TypeError, KeyError) as error:
        raise ValueError(
            f"objects: {type(error).__name__} {error}; give {{frame: box}}, or a list of mappings with name and keys"
        ) from None
    if not listed:
        raise ValueError("objects: there is none; give one with a key frame")
    return json.dumps({"version": 1, "objects": listed})


def _entries(keys: Mapping[int, Any] | Sequence[Any]) -> list[Any]:
    if not isinstance(keys, Mapping):
        return list(keys)
    return [
        {"frame": int(frame), "absent": True} if area is None else {"frame": int(frame), "box": [float(side) for side in area]}
        for frame, area in sorted(keys.items())
    ]
