"""InfoPart as a tracking function of CVAT's auto-annotation interface, for `cvat-cli function create-native` and its agent.

    cvat-cli function create-native InfoPart --function-module infopart.cvat -p seed=int:1
    cvat-cli function run-agent ID --function-module infopart.cvat -p seed=int:1

Parameters (``-p NAME=TYPE:VALUE``) are those of `infopart.Tracker`. Rectangles are tracked; while the target is lost there is no
shape. Needs cvat-sdk.
"""

from __future__ import annotations

from typing import Any

import cvat_sdk.auto_annotation as cvataa
import numpy as np
import numpy.typing as npt
import PIL.Image

from ._tracker import Tracker


class Function:
    """What CVAT calls: the images of a video one after another, and a state for each shape."""

    spec = cvataa.TrackingFunctionSpec(supported_shape_types=["rectangle"])

    def __init__(self, **parameters: Any) -> None:
        # Said now rather than at the first shape.
        Tracker(rgb=True, **parameters).close()
        self._parameters = parameters

    def preprocess_image(
        self, context: cvataa.TrackingFunctionContext, image: PIL.Image.Image
    ) -> npt.NDArray[np.uint8]:
        """The image's pixels."""
        return np.asarray(image.convert("RGB"))

    def init_tracking_state(
        self,
        context: cvataa.TrackingFunctionShapeContext,
        pp_image: npt.NDArray[np.uint8],
        shape: cvataa.TrackableShape,
    ) -> Tracker:
        """A tracker that has started on the shape, whose points are left, top, right and bottom."""
        left, top, right, bottom = shape.points
        tracker = Tracker(rgb=True, **self._parameters)
        tracker.init(pp_image, (left, top, right - left, bottom - top))
        return tracker

    def track(
        self, context: cvataa.TrackingFunctionShapeContext, pp_image: npt.NDArray[np.uint8], state: Tracker
    ) -> cvataa.TrackableShape | None:
        """The rectangle in the next image, or None while the target is lost."""
        is_seen, (x, y, w, h) = state.update(pp_image)
        return cvataa.TrackableShape(type="rectangle", points=[x, y, x + w, y + h]) if is_seen else None


def create(**parameters: Any) -> Function:
    """The function, with parameters of `infopart.Tracker`; the name that cvat-cli asks for."""
    return Function(**parameters)
