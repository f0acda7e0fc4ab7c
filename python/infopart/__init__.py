"""InfoPart: a single-object visual tracker with the calls of OpenCV's; `Sort` tracks many from a detector's
boxes, `annotate` gives a box in every frame from a few that are drawn.

    import cv2, infopart

    video = cv2.VideoCapture("walk.mp4")
    ok, frame = video.read()
    tracker = infopart.Tracker(seed=1)
    tracker.init(frame, (120, 80, 40, 110))
    while (read := video.read())[0]:
        ok, box = tracker.update(read[1])

Boxes are (x, y, w, h) in pixels, the first pixel being 0. Frames are numpy arrays of uint8: (height, width) is grey,
(height, width, 3) and (height, width, 4) are BGR as OpenCV gives them, or RGB with rgb=True.
"""

from ._infopart import VERSION as __version__
from ._annotate import Annotator, ObjectTrack, Place, annotate
from ._sort import Sort, TrackedBox
from ._track import Sequence, open_sequence, track
from ._tracker import Estimate, Tracker, parameters

__all__ = [
    "Annotator", "Estimate", "ObjectTrack", "Place", "Sequence", "Sort", "TrackedBox", "Tracker", "__version__", "annotate",
    "open_sequence", "parameters", "track",
]
