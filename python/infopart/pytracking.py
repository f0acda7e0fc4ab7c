"""The tracker with the calls of pytracking's: ``initialize(image, info)``, ``track(image) -> dict``."""

from __future__ import annotations

from typing import Any

from ._tracker import Tracker as _Tracker


class Tracker:
    """InfoPart as pytracking calls its trackers, on RGB images; arguments are those of `infopart.Tracker`."""

    multiobj_mode = "default"

    def __init__(self, params: Any = None, **parameters: Any) -> None:
        self.params = params
        self._tracker = _Tracker(rgb=True, **parameters)

    def initialize(self, image: Any, info: dict[str, Any]) -> dict[str, Any]:
        """Starts on an image with the target in ``info["init_bbox"]``: x, y, w, h."""
        if "init_bbox" not in info:
            raise ValueError("info: it has no `init_bbox`; give the target's box, [x, y, w, h], under that name")
        self._tracker.init(image, info["init_bbox"])
        return {}

    def track(self, image: Any, info: dict[str, Any] | None = None) -> dict[str, Any]:
        """The box, ``target_bbox``, and the confidence, ``object_presence_score``, in the next image."""
        _, box = self._tracker.update(image)
        return {"target_bbox": list(box), "object_presence_score": self._tracker.getTrackingScore()}
