"""Whole sequences: frames of files, and a tracker over them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from . import _infopart
from ._tracker import Tracker

ROW = np.dtype(
    [(name, "f8") for name in ("x", "y", "w", "h", "confidence")] + [("status", "U9"), ("effective_sample_size", "f8")]
)


class Sequence:
    """Frames of a folder, a glob, an image or a video, decoded as the program ``infopart`` decodes them: grey, or RGB.

    A video needs the ffmpeg program. Iterate over it once; open it again for another pass.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        target: int | None = None,
        start: int | None = None,
        end: int | None = None,
    ) -> None:
        self._native = _infopart.NativeSequence(os.fspath(path), target, start, end)

    @property
    def name(self) -> str:
        """The folder's or file's name, with the target's number if there are several."""
        return self._native.name

    @property
    def ground_truth(self) -> list[tuple[float, float, float, float] | None]:
        """The true box of each frame, None where the target is absent, the first pixel being 0; empty if unknown."""
        return self._native.ground_truth

    def __iter__(self) -> Iterator[np.ndarray]:
        return self._native

    def __len__(self) -> int:
        """Frames still to come. Raises TypeError for a video, which does not tell."""
        count = self._native.remaining()
        if count is None:
            raise TypeError("a video does not tell how many frames it has; iterate over it")
        return count


def open_sequence(path: str | os.PathLike[str], **options: Any) -> Sequence:
    """Opens a folder of images (an OTB folder has ground truth), a glob, an image or a video. See `Sequence`."""
    return Sequence(path, **options)


def track(
    source: str | os.PathLike[str] | Iterable[np.ndarray],
    box: Any = None,
    *,
    target: int | None = None,
    start: int | None = None,
    end: int | None = None,
    progress: bool = True,
    tracker: Any = None,
    rgb: bool = False,
    **parameters: Any,
) -> Any:
    """Tracks through a path or an iterable of frames; a row a frame, the first being the given box.

    source: a path as of `Sequence`, whose frames 'start' to 'end' (counted from 1) are tracked, or frames. box: x, y, w, h
    in the first frame, the first pixel being 0; of an OTB folder it may be left out. tracker: one that is to be used, else
    ``Tracker(**parameters)``. progress: a bar, if tqdm is installed. rgb: whether given frames are red first.

    Gives a pandas.DataFrame if pandas is installed, else a numpy structured array, with x, y, w, h, confidence, status and
    effective_sample_size.
    """
    if isinstance(source, (str, os.PathLike)):
        frames: Any = Sequence(source, target=target, start=start, end=end)
        if box is None:
            truth = frames.ground_truth
            box = truth[0] if truth else None
        rgb = True
    else:
        frames = source
    if box is None:
        raise ValueError("box: there is no ground truth to take it from; give four numbers, (x, y, w, h) in pixels")
    if tracker is None:
        tracker = Tracker(rgb=rgb, **parameters)
    elif parameters:
        raise ValueError("give either tracker= or parameters, not both")
    rows: list[tuple[Any, ...]] = []
    for frame in _with_bar(frames, progress):
        if rows:
            tracker.update(frame)
        else:
            tracker.init(frame, box)
        found = tracker.estimate
        rows.append((*found.box, found.confidence, found.status, found.effective_sample_size))
    if not rows:
        raise ValueError("source: there is no frame")
    return _table(np.array(rows, ROW))


def _with_bar(frames: Any, wanted: bool) -> Any:
    if not wanted:
        return frames
    try:
        from tqdm import tqdm
    except ImportError:
        return frames
    try:
        total = len(frames)
    except TypeError:
        total = None
    return tqdm(frames, total=total, unit="frame", disable=None)


def _table(rows: np.ndarray) -> Any:
    try:
        import pandas
    except ImportError:
        return rows
    return pandas.DataFrame(rows)
