"""Both models on real images, and the memory they take."""

import tracemalloc

import cv2
import numpy as np
import pytest

from softdepth.config import Config
from softdepth.golden import fixed_model, float_model


def scene(folder):
    left, right = (np.asarray(cv2.imread(str(folder / f"{n}.png")))[:, :, ::-1] for n in ("im2", "im6"))
    truth = cv2.imread(str(next(folder.glob("disp2.p[gn][mg]"))), cv2.IMREAD_GRAYSCALE)
    return left, right, np.asarray(truth)


def paper_rmse(disparity, truth):
    """Eq. 1: gray levels, disparities times four, every pixel counted."""
    return float(np.sqrt(((4.0 * disparity - truth) ** 2).mean()))


@pytest.mark.middlebury
@pytest.mark.parametrize(("name", "rmse"), [("teddy", 46.98), ("cones", 48.50), ("venus", 47.46)])
def test_fixed_is_as_accurate_as_float(middlebury, name, rmse):
    left, right, truth = scene(middlebury / name)
    config = Config.preset("paper")
    fixed, real = (m.disparity(left, right, config) for m in (fixed_model, float_model))
    assert paper_rmse(real.disparity, truth) == pytest.approx(rmse, abs=0.01)
    assert abs(paper_rmse(fixed.disparity, truth) - paper_rmse(real.disparity, truth)) < 0.5
    assert (fixed.code == real.code).all()


def peak(model, height):
    """Bytes allocated at most for a 960-wide frame of 128 candidates."""
    config = Config.from_dict({"disparities": 128, "criteria": [{"window": w} for w in (3, 5, 7)]})
    left, right = np.random.default_rng(0).integers(0, 256, (2, height, 960, 3), dtype=np.uint8)
    tracemalloc.start()
    try:
        model.disparity(left, right, config)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("model", [fixed_model, float_model])
def test_memory_is_a_band_and_the_map(model):
    low, high = 40, 80
    small, large = peak(model, low), peak(model, high)
    assert small < 6 * 2**20  # a cost volume of 128 candidates would take 9.4 MiB in 16 bits alone
    assert large - small < 16 * 960 * (high - low)  # bytes per further pixel: map and codes
