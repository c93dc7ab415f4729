"""The paper's Fig. 4: what the compensating rule does to one false near point of Teddy."""

from pathlib import Path

import numpy as np
import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.golden.data.datasets import load
from softdepth.spec.config import Config

# The paper counts from one, columns, rows and disparities alike: (254, 68), 62 and 16.
X, Y, WITHOUT, WITH = 254 - 1, 68 - 1, 62 - 1, 16 - 1

CONFIG = Config.preset("paper").override(
    ["operator=soft_min_1", "reference=right", *(f"criteria.{i}.window={5 + 2 * i}" for i in range(3))]
)
RULE = CONFIG.override(["compensation.reading=top", "compensation.criterion=3"])


@pytest.mark.middlebury
@pytest.mark.parametrize(("config", "disparity"), [(CONFIG, WITHOUT), (RULE, WITH)], ids=["without", "with"])
def test_the_false_near_point_goes(config: Config, disparity: int, data_dir: Path) -> None:
    pair = load("middlebury:teddy", reference="right")
    curve = float_model.costs(pair.left, pair.right, config, X, Y)
    assert np.argmin(curve) == disparity
    assert fixed_model.trace(pair.left, pair.right, config, X, Y).disparity == disparity
