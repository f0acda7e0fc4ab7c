"""The tracker for the GOT-10k toolkit: ``ExperimentOTB(...).run(infopart.got10k.Tracker())``."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._tracker import Tracker as _Tracker

try:
    from got10k.trackers import Tracker as _Base
except ImportError as error:
    raise ImportError(f"infopart.got10k needs the GOT-10k toolkit: pip install got10k ({error})") from None


class Tracker(_Base):  # type: ignore[misc]
    """InfoPart as that toolkit calls it: ``init(image, box)``, ``update(image) -> box`` on RGB images.

    origin: the number of the first pixel in the boxes; the toolkit hands over those of its data sets as they are, which is 1
    for OTB, GOT-10k and VOT. Other arguments are those of `infopart.Tracker`.
    """

    def __init__(self, name: str = "InfoPart", *, origin: int = 1, **parameters: Any) -> None:
        super().__init__(name=name, is_deterministic=True)
        self._shift = np.array([origin, origin, 0, 0], float)
        self._tracker = _Tracker(rgb=True, **parameters)

    def init(self, image: Any, box: Any) -> None:
        """Starts on an image with the target in ``box``."""
        self._tracker.init(np.asarray(image), np.asarray(box, float).ravel() - self._shift)

    def update(self, image: Any) -> np.ndarray:
        """The box in the next image."""
        return np.array(self._tracker.update(np.asarray(image))[1]) + self._shift
