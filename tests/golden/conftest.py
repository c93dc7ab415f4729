"""Fixtures of the golden models' tests."""

import os
from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.golden.data.datasets import DATA_VARIABLE


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(2021)


@pytest.fixture
def picture(rng: np.random.Generator) -> np.ndarray:
    """A small uint8 RGB picture with no symmetry."""
    return rng.integers(0, 256, (13, 17, 3), dtype=np.uint8)


@pytest.fixture(scope="session")
def middlebury() -> Path:
    """The folder with Middlebury's images; tests that need it are skipped where there is none."""
    folder = os.environ.get(DATA_VARIABLE)
    if not folder:
        pytest.skip(f"needs Middlebury's images: set {DATA_VARIABLE} to a folder with teddy/, cones/, venus/")
    return Path(folder)


def save(path: Path, image: np.ndarray) -> Path:
    """Write an RGB(A) or gray array with OpenCV, in the format of the suffix."""
    bgr = image if image.ndim == 2 else image[:, :, [2, 1, 0, 3][: image.shape[2]]]
    assert cv2.imwrite(str(path), bgr)
    return path
