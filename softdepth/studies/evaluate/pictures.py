"""A scene's pictures, small enough for a page of many."""

from collections.abc import Mapping

import cv2
import numpy as np

from softdepth.golden.data.pair import StereoPair
from softdepth.golden.score.pictures import colour, error_picture

WIDTH = 320
QUALITY = 82


def scene_pictures(pair: StereoPair, maps: Mapping[str, np.ndarray]) -> dict[str, bytes]:
    """JPEG files: ``left``, ``truth``, and of every map ``NAME`` and ``NAME error``."""
    truth = pair.truth
    assert truth is not None
    maximum = float(np.nanmax(truth.disparity))
    pictures = {
        "left": pair.left,
        "truth": colour(np.where(truth.known, truth.disparity, 0), truth.known, maximum),
    }
    for name, pixels in maps.items():
        pictures[name] = colour(pixels, np.ones(pixels.shape, bool), maximum)
        pictures[f"{name} error"] = error_picture(pixels, truth)
    return {name: _jpeg(picture) for name, picture in pictures.items()}


def _jpeg(picture: np.ndarray) -> bytes:
    height, width = picture.shape[:2]
    if width > WIDTH:
        size = WIDTH, max(1, round(height * WIDTH / width))
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    encoded, data = cv2.imencode(".jpg", picture[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    assert encoded
    return data.tobytes()
