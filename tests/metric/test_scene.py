"""Which results become depth."""

import numpy as np
import pytest

from softdepth.metric.scene import Choice, Scene
from softdepth.rig.geometry import Geometry
from softdepth.spec.errors import InputError
from softdepth.spec.validity import Validity

GEOMETRY = Geometry(100, 0.1)
CODES = np.array([[code.value for code in Validity]], np.uint8)
CONFIDENCE = np.full(CODES.shape, 90, np.uint8)


def chosen(choice: Choice, confidence: np.ndarray | None = CONFIDENCE) -> set[Validity]:
    return {code for code, counts in zip(Validity, choice.of(CODES, confidence)[0], strict=True) if counts}


def test_measured_and_filled_results_count():
    assert chosen(Choice()) == {Validity.FULL, Validity.PARTIAL, Validity.FILLED}
    assert chosen(Choice(measured_only=True)) == {Validity.FULL, Validity.PARTIAL}


def test_a_floor_of_confidence():
    assert chosen(Choice(min_confidence=90)) == chosen(Choice())
    assert chosen(Choice(min_confidence=91)) == set()
    with pytest.raises(InputError, match="no confidence"):
        chosen(Choice(min_confidence=1), None)
    with pytest.raises(InputError, match="use 0 to 255"):
        Choice(min_confidence=256)


def test_points_carry_colour_and_what_was_filled():
    image = np.arange(21, dtype=np.uint8).reshape(1, 7, 3)
    scene = Scene.of(GEOMETRY, np.full(CODES.shape, 4.0), CODES, image=image)
    points, colours, filled = scene.points()
    assert colours is not None
    np.testing.assert_allclose(points[:, 2], 2.5)
    np.testing.assert_array_equal(colours, image[0, [0, 1, 3]])
    np.testing.assert_array_equal(filled, [False, False, True])
