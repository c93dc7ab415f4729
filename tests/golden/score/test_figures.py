"""Figures: PNG files of the promised layout, with what their legends say."""

import cv2
import numpy as np
import pytest

from softdepth.golden.score.figures import error_figure, side_by_side, triptych
from softdepth.golden.score.pictures import ERROR_COLOURS, NO_RESULT, colour
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity


def decode(data: bytes) -> np.ndarray:
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
    assert image is not None
    return image[:, :, ::-1].astype(int)


def test_error_figure_has_its_legend() -> None:
    picture = np.full((60, 90, 3), ERROR_COLOURS["within 1 px"], np.uint8)
    picture[30, 45] = ERROR_COLOURS["over 2 px"]
    image = decode(error_figure(picture))
    zoom = 10
    assert (np.abs(image - ERROR_COLOURS["over 2 px"]).max(2) <= 2).sum() > zoom**2, "single pixels are seen"
    below = image[-image.shape[0] // 10 :]
    for name, shade in ERROR_COLOURS.items():
        assert (np.abs(below - shade).max(2) <= 3).any(), name


def test_triptych_tells_the_shades_that_occur() -> None:
    image = np.zeros((60, 80, 3), np.uint8)
    disparity, code = np.full((60, 80), 9), np.zeros((60, 80), np.uint8)
    valid = np.ones(code.shape, bool)
    plain = decode(triptych(image, image, disparity, valid, 64, code=code))
    code[:, :20] = Validity.PARTIAL
    told = decode(triptych(image, image, disparity, valid, 64, code=code))
    assert told.shape[0] > plain.shape[0]


def test_triptych_shows_left_right_and_map() -> None:
    """Flat pictures, so that each panel's place and colour can be asked for."""
    left, right = (np.full((300, 400, 3), shade, np.uint8) for shade in ((250, 10, 10), (10, 10, 250)))
    disparity, valid = np.full((300, 400), 32), np.ones((300, 400), bool)
    valid[:, :40] = False
    image = decode(triptych(left, right, disparity, valid, 64))
    row = image[image.shape[0] * 3 // 5]
    green = tuple(int(v) for v in colour(disparity, valid, 64)[0, 200])
    places = []
    for shade in ((250, 10, 10), (10, 10, 250), NO_RESULT, green):
        hits = np.nonzero(np.abs(row - shade).max(1) <= 2)[0]
        assert len(hits) > 40
        places.append(int(np.median(hits)))
    assert places == sorted(places)
    bar = image[:, places[-1] + 250 :]
    assert (bar.max(2) - bar.min(2) > 150).any(), "the colour bar stands right of the map"
    assert (image[:4] == 255).all(), "the margin is white"


def test_legend_and_bar_take_room() -> None:
    panels = [("a", np.zeros((50, 80, 3), np.uint8)), ("b", np.zeros((50, 80, 3), np.uint8))]
    plain, bar, legend = (
        decode(side_by_side(panels, **o)) for o in ({}, {"maximum": 64}, {"legend": ERROR_COLOURS})
    )
    assert bar.shape[1] > plain.shape[1]
    assert legend.shape[0] > plain.shape[0]
    for name in ("1 to 2 px", "over 2 px"):
        assert (np.abs(legend - ERROR_COLOURS[name]).max(2) <= 2).any(), name
        assert not (np.abs(plain - ERROR_COLOURS[name]).max(2) <= 2).any()


def test_pictures_are_reproducible(picture: np.ndarray) -> None:
    assert side_by_side([("a", picture)], maximum=9) == side_by_side([("a", picture)], maximum=9)


def test_no_panel() -> None:
    with pytest.raises(InputError, match="no picture"):
        side_by_side([])
