"""OpenCV's trackers and dlib's, ready for ``otb_eval run --tracker NAME='python -m infopart.trax infopart.rivals:CSRT'``.

CSRT, KCF, MIL, Boosting, MedianFlow, MOSSE and TLD need opencv-contrib-python-headless, and NanoTrack its two networks too:
``--option backbone=backbone.onnx --option head=head.onnx``, or the folder that holds them in NANOTRACK_MODELS.

``infopart.rivals:Dlib --rgb`` needs dlib-bin.

A tracker that does not take a first box beyond the picture is given the part of it that is inside.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Each network that OpenCV 5 reads warns of a setting that it does not heed.
os.environ.setdefault("OPENCV_LOG_LEVEL", "ERROR")

try:
    import cv2
except ImportError as _error:
    raise ImportError(f"{_error}: pip install opencv-contrib-python-headless") from None


class OpenCv:
    """One of OpenCV's trackers, on one thread unless told otherwise."""

    name = ""

    def __init__(self, *, threads: int = 1) -> None:
        cv2.setNumThreads(threads)
        self._tracker: Any = None

    def create(self) -> Any:
        """A new tracker."""
        for module in (cv2, getattr(cv2, "legacy", None)):
            create: Callable[[], Any] | None = getattr(module, f"Tracker{self.name}_create", None)
            if create:
                return create()
        raise RuntimeError(
            f"OpenCV {cv2.__version__} has no {self.name} tracker: pip install opencv-contrib-python-headless"
        )

    def init(self, image: Any, box: tuple[float, float, float, float]) -> None:
        """Starts on an image with the target in ``box``."""
        x, y, w, h = (int(round(side)) for side in box)
        self._tracker = self.create()
        try:
            self._tracker.init(image, (x, y, w, h))
        except cv2.error:
            left, top = max(x, 0), max(y, 0)
            right, bottom = min(x + w, image.shape[1]), min(y + h, image.shape[0])
            self._tracker = self.create()
            self._tracker.init(image, (left, top, right - left, bottom - top))

    def update(self, image: Any) -> tuple[bool, Any]:
        """Whether the target is found, and its box."""
        return self._tracker.update(image)


class CSRT(OpenCv):
    """Discriminative correlation filter with channel and spatial reliability."""

    name = "CSRT"


class KCF(OpenCv):
    """Kernelised correlation filter."""

    name = "KCF"


class MIL(OpenCv):
    """Online multiple instance learning."""

    name = "MIL"


class Boosting(OpenCv):
    """Online AdaBoost."""

    name = "Boosting"


class MedianFlow(OpenCv):
    """Median of the optical flow of points."""

    name = "MedianFlow"


class MOSSE(OpenCv):
    """Minimum output sum of squared error filter."""

    name = "MOSSE"


class TLD(OpenCv):
    """Tracking, learning and detection."""

    name = "TLD"


class NanoTrack(OpenCv):
    """NanoTrack, from its two networks."""

    name = "Nano"

    def __init__(self, *, backbone: str | None = None, head: str | None = None, threads: int = 1) -> None:
        super().__init__(threads=threads)
        folder = Path(os.environ.get("NANOTRACK_MODELS", "."))
        self._files = [Path(backbone or folder / "backbone.onnx"), Path(head or folder / "head.onnx")]
        for file in self._files:
            if not file.is_file():
                raise FileNotFoundError(
                    f"no {file}: give NanoTrack's networks with --option backbone=FILE --option head=FILE, "
                    "or their folder in NANOTRACK_MODELS"
                )

    def create(self) -> Any:
        """A new tracker."""
        parameters = cv2.TrackerNano_Params()
        parameters.backbone, parameters.neckhead = map(str, self._files)
        return cv2.TrackerNano_create(parameters)


class Dlib:
    """dlib's correlation tracker. It wants RGB."""

    def __init__(self) -> None:
        try:
            import dlib
        except ImportError as error:
            raise ImportError(f"{error}: pip install dlib-bin") from None
        self._rectangle, self._make = dlib.rectangle, dlib.correlation_tracker
        self._tracker: Any = None

    def create(self) -> Any:
        """A new tracker."""
        return self._make()

    def init(self, image: Any, box: tuple[float, float, float, float]) -> None:
        """Starts on an image with the target in ``box``."""
        x, y, w, h = (int(round(side)) for side in box)
        self._tracker = self.create()
        self._tracker.start_track(image, self._rectangle(x, y, x + w - 1, y + h - 1))

    def update(self, image: Any) -> tuple[bool, tuple[float, float, float, float]]:
        """The target's box; dlib never says that it is lost."""
        self._tracker.update(image)
        found = self._tracker.get_position()
        return True, (found.left(), found.top(), found.width(), found.height())
