"""The fixed model's `robust` presets against an independent transcription of the method, in every pixel.

It is a file ``robust.py`` in the folder that ``SOFTDEPTH_ORACLE`` names; without it these tests are skipped.
"""

import importlib.util
import os
from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.golden.data.pair import StereoPair
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity
from softdepth.studies.evaluate.variants import ABLATIONS

ORACLE, SCENES = "SOFTDEPTH_ORACLE", "SOFTDEPTH_SCENES"
KEYS = {"robust": {}, "robust-small": {"small": True}, "robust-gray": {"gray": True}}
OVERRIDES = {"robust-small": ABLATIONS["all of these"]}
"""The transcription's small method has sums over 9x9, and the filters of `robust`."""


@pytest.fixture(scope="module")
def oracle():
    folder = os.environ.get(ORACLE)
    if not folder:
        pytest.skip(f"{ORACLE} is unset: it names the folder of an independent robust.py")
    found = importlib.util.spec_from_file_location("robust_oracle", Path(folder) / "robust.py")
    assert found
    assert found.loader
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


def agree(oracle, preset, left, right, disparities=64):
    changes = [f"disparities={disparities}", "lanes=1", "max_multipliers=999", *OVERRIDES.get(preset, [])]
    config = Config.preset(preset).override(changes)
    views = StereoPair(left, right, preset).as_format(config.pixel)
    got = fixed_model.disparity(views.left, views.right, config)
    expected, measured = oracle.disparity(left, right, disparities, **KEYS[preset])
    np.testing.assert_array_equal(got.disparity, expected)
    np.testing.assert_array_equal(got.code < Validity.BORDER, measured)


def crop(path, size):
    image = cv2.imread(str(path))[..., ::-1]
    return image[: size[0], : size[1]]


@pytest.mark.parametrize("preset", KEYS)
@pytest.mark.parametrize("scene", ["teddy", "cones", "venus"])
def test_middlebury(oracle, data_dir, scene, preset):
    size = (999, 999) if (scene, preset) == ("teddy", "robust") else (120, 240)
    pair = (crop(data_dir / scene / f"{name}.png", size) for name in ("im2", "im6"))
    agree(oracle, preset, *pair)


@pytest.mark.parametrize("preset", KEYS)
@pytest.mark.parametrize("scene", ["plastic", "art", "eth_playground", "qPipes"])
def test_scenes(oracle, scene, preset):
    folder = os.environ.get(SCENES)
    if not folder:
        pytest.skip(f"{SCENES} is unset: it names a folder of scenes")
    agree(oracle, preset, *(crop(Path(folder) / scene / f"{s}.png", (90, 260)) for s in ("left", "right")))


@pytest.mark.parametrize(
    ("height", "width", "disparities"),
    [(1, 1, 2), (1, 9, 4), (2, 2, 3), (5, 4, 8), (9, 13, 5), (33, 40, 64), (40, 7, 16), (17, 70, 32)],
)
@pytest.mark.parametrize("preset", KEYS)
def test_small_frames(oracle, preset, height, width, disparities):
    rng = np.random.default_rng(height * width)
    scene = rng.integers(0, 256, (height, width + 3, 3), dtype=np.uint8) // 16 * 16
    agree(oracle, preset, scene[:, :width], scene[:, 3:], disparities)
    flat = np.full((height, width, 3), 99, np.uint8)
    agree(oracle, preset, flat, flat, disparities)
