"""A video to look at a sequence with: the left view, and beside it the disparity in colour."""

from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from PIL import Image

from softdepth.golden.data.truth import read_truth
from softdepth.golden.maps import has_value
from softdepth.golden.score import pictures
from softdepth.sequence.frame import LEFT, Record

WIDEST = 1920
"""Pixels across both pictures; larger ones are made smaller."""


def shown(records: list[Record], folder: Path) -> Iterator[np.ndarray]:
    """The pictures, RGB uint8, from each frame's written results; one range of colours for all."""
    low, high = min(record.low for record in records), max(record.high for record in records)
    for record in records:
        place = folder / record.name
        disparity = read_truth(place / "disparity.pfm").disparity
        code = np.array(Image.open(place / "code.png"))
        coloured = pictures.colour(disparity, has_value(code), high, minimum=low, code=code)
        left = np.array(Image.open(place / LEFT))
        picture = np.hstack([left, coloured])
        height, width = picture.shape[:2]
        if width > WIDEST:
            size = WIDEST, max(round(height * WIDEST / width), 2)
            picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
        yield picture
