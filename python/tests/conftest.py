"""Small scenes drawn here, and where real sequences are."""

import os
from pathlib import Path

import numpy as np
import pytest


def scene(count, width=160, height=120):
    """Frames of a textured square that moves by (2, 1) pixels a frame over a textured ground, BGR, and its boxes."""
    y, x = np.mgrid[:height, :width]
    ground = np.stack([(x * 3 + y * 7) % 120, (x * 5 + y * 2) % 90 + 40, (x + y * 11) % 70], axis=2).astype(np.uint8)
    square = np.stack([(x * 9 + y * 5) % 60 + 190, (x * 2 + y * 9) % 50, (x * 7 + y) % 80 + 90], axis=2)[:32, :20]
    frames, boxes = [], []
    for number in range(count):
        left, top = 30 + 2 * number, 20 + number
        frame = ground.copy()
        frame[top : top + 32, left : left + 20] = square
        frames.append(frame)
        boxes.append((left, top, 20, 32))
    return frames, boxes


@pytest.fixture(scope="session")
def walk():
    return scene(20)


@pytest.fixture(scope="session")
def data():
    """The folder of real sequences; without it a test is skipped."""
    beside = Path(__file__).resolve().parents[3] / "shared" / "data"
    folder = Path(os.environ.get("INFOPART_DATA", beside))
    if not (folder / "otb").is_dir():
        pytest.skip(f"no data at {folder}; set INFOPART_DATA to the folder that has otb/")
    return folder


@pytest.fixture(scope="session")
def program():
    """The program `infopart` that INFOPART_PROGRAM names; without it a test is skipped."""
    found = os.environ.get("INFOPART_PROGRAM")
    if not found:
        pytest.skip("set INFOPART_PROGRAM to the built program `infopart`")
    return found
