"""A gray core of 12 bits whose candidates begin below 0, on Teddy: gateware, and a board at a serial port."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.golden.data import datasets
from softdepth.golden.data.pair import StereoPair
from softdepth.sim.frames import run_frames
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity
from tests.board.simulated import BOARD, plugged_in

ROWS, COLUMNS = slice(120, 144), slice(150, 230)
MOVED = 30
"""Columns by which the right view is moved, so that disparities of both signs occur."""


@pytest.fixture(scope="module")
def core() -> Config:
    keys = ("pixel=gray12", "min_disparity=-8", "disparities=24", "lanes=4", "max_width=96", "max_height=48")
    return Config.preset("lite").override([*keys, *(f"criteria.{k}.label_bits=12" for k in range(3))])


@pytest.fixture
def teddy(data_dir: Path, monkeypatch: pytest.MonkeyPatch) -> StereoPair:
    """A part of Teddy, gray, its 8 bits widened to 12."""
    monkeypatch.setenv("SOFTDEPTH_DATA", str(data_dir))
    pair = datasets.load("middlebury:teddy").as_format("gray12")
    assert pair.left.dtype == np.uint16
    left = pair.left[ROWS, COLUMNS]
    right = np.roll(pair.right, MOVED, axis=1)[ROWS, COLUMNS]
    return StereoPair(np.ascontiguousarray(left), np.ascontiguousarray(right), "teddy", bits=12)


@pytest.mark.slow
def test_the_gateware_and_a_board_equal_the_model(core, teddy, softdepth, tmp_path):
    expected = fixed_model.disparity(teddy.left, teddy.right, core)
    assert set(np.unique(expected.code)) == {Validity.FULL, Validity.PARTIAL, Validity.BORDER}
    found = expected.disparity[expected.valid]
    assert found.min() == -8
    assert (found < 0).mean() > 0.05
    assert (found > 0).mean() > 0.05

    (simulated,) = run_frames(core, [(teddy.left, teddy.right)]).maps
    assert list(expected.differences(simulated)) == []

    files = {"left": teddy.left, "right": teddy.right}
    for name, image in files.items():
        cv2.imwrite(str(tmp_path / f"{name}.png"), image)
    out = tmp_path / "out"
    with plugged_in(core, tmp_path) as board:
        outcome = softdepth(
            *("board", "--port", board.path, "--baud", BOARD.baud, "--timeout", 30, "--bits", 12),
            *(tmp_path / "left.png", tmp_path / "right.png", "-o", out),
        )
    assert outcome.code == 0, outcome.err
    assert "gray" not in outcome.err  # nothing is tripled or reduced
    assert f"0 mismatches in {expected.code.size} pixels" in outcome.out
    pfm = cv2.imread(str(out / "disparity.pfm"), cv2.IMREAD_UNCHANGED)
    np.testing.assert_array_equal(pfm[expected.valid], found)
    png = cv2.imread(str(out / "disparity.png"), cv2.IMREAD_UNCHANGED)
    np.testing.assert_array_equal(png[expected.valid], np.maximum((found + 8) * 256, 1))
