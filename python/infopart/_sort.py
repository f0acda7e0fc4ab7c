"""Many objects from any detector's boxes, with arguments checked."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _infopart


class TrackedBox(NamedTuple):
    """A track as it is reported in a frame."""

    identity: int
    """The track, counted from 1."""
    box: tuple[float, float, float, float]
    """x, y, w, h in pixels; the filter's, or with ``method="oc"`` the detection's own."""
    class_id: int | None
    """The class of its detection, if classes were given."""
    detection: int
    """The row of its detection among the boxes given for the frame."""


class Sort(_infopart.NativeSort):
    """Tracks many objects: a call a frame with whatever boxes a detector gives.

    method: ``sort`` (Bewley et al. 2016; the reference's tracks), ``byte`` (ByteTrack: boxes of low confidence prolong tracks) or
    ``oc`` (OC-SORT). max_age: frames that a track is kept without a box; 1 for sort, else 30. min_hits: boxes in a row before a
    track is reported; 3; not for byte. min_overlap: of a box and a prediction that are paired, from 0 to 1; .3, .1 for byte. high:
    the confidence from which a box is sure, .6, for byte and oc; low: that from which byte looks at it, .1. camera_motion: whether
    the camera's motion is told from the frames, which ``update`` then needs. rgb: whether these are red first.
    """

    def __new__(
        cls,
        method: str = "sort",
        *,
        max_age: int | None = None,
        min_hits: int | None = None,
        min_overlap: float | None = None,
        high: float | None = None,
        low: float | None = None,
        camera_motion: bool = False,
        rgb: bool = False,
    ) -> Sort:
        ages = [_whole(name, value) for name, value in (("max_age", max_age), ("min_hits", min_hits))]
        self = super().__new__(cls, method, *ages, min_overlap, high, low, bool(camera_motion), bool(rgb))
        self._camera_motion = bool(camera_motion)
        return self

    _camera_motion: bool

    def update(self, boxes: Any, scores: Any = None, classes: Any = None, frame: Any = None) -> list[TrackedBox]:
        """Takes the next frame's boxes, also if there are none, and gives the tracks to report.

        boxes: a row of x, y, w, h in pixels each. scores: a confidence each, usually from 0 to 1; 1 where they are left out.
        classes: a whole number each; byte and oc pair boxes of one class only. frame: the image, with ``camera_motion=True``.
        Raises ValueError, naming argument and row; the tracker is then as it was.
        """
        areas = _numbers("boxes", boxes, np.float64)
        areas = areas.reshape(0, 4) if areas.size == 0 else areas
        if areas.ndim != 2 or areas.shape[1] != 4:
            raise ValueError(f"boxes: their shape is {areas.shape}; give (number, 4): x, y, w, h a row")
        sure = np.ones(len(areas)) if scores is None else _column("scores", scores, np.float64, len(areas))
        kinds = None if classes is None else _column("classes", classes, np.int64, len(areas))
        if self._camera_motion and frame is None:
            raise ValueError("frame: camera_motion=True tells the camera's motion from it; give the frame's image")
        found = self.step(areas, sure, kinds, frame if self._camera_motion else None)
        return [TrackedBox(*one) for one in found]


def _whole(name: str, value: int | None) -> int | None:
    if value is None or (isinstance(value, (int, np.integer)) and not isinstance(value, bool) and 0 <= value < 1 << 32):
        return None if value is None else int(value)
    raise ValueError(f"{name}: it is {value!r}; give a whole number from 0 on")


def _numbers(name: str, given: Any, kind: type[Any]) -> npt.NDArray[Any]:
    try:
        return np.ascontiguousarray(given, dtype=kind)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"{name}: {error}; give an array of numbers") from None


def _column(name: str, given: Any, kind: type[Any], count: int) -> npt.NDArray[Any]:
    column = _numbers(name, given, kind)
    column = column.reshape(0) if column.size == 0 else column
    if column.shape != (count,):
        raise ValueError(f"{name}: their shape is {column.shape}; give one for each of the {count} boxes")
    return column
