"""The range in metres is that of the disparities which the models give."""

import numpy as np
import pytest

from softdepth.golden import fixed_model
from softdepth.golden.data.synthetic import generate
from softdepth.metric.reach import Reach
from softdepth.rig.geometry import Geometry
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


@pytest.mark.parametrize("preset", ["sad", "robust-small"])
@pytest.mark.parametrize("doffs", [0.0, 3.3, -2.0, -2.5, -20.0])
def test_no_result_of_the_model_lies_outside(preset, doffs):
    config = Config.preset(preset).override(["disparities=16", "lanes=8", "max_width=64", "max_height=48"])
    pair = generate("random", width=64, height=48, disparities=16, seed=5).as_format(config.pixel)
    found = fixed_model.disparity(pair.left, pair.right, config)
    geometry = Geometry(400, 0.1, doffs)
    reach = Reach.of(geometry, config)
    depth = geometry.depth(found.pixels, found.valid | (found.code == Validity.FILLED))
    known = depth[np.isfinite(depth)].astype(np.float64)
    if doffs == -20:
        assert reach.disparities is None
        assert len(known) == 0
        assert reach.step(1.0) is None
        return
    assert reach.nearest * (1 - 1e-6) <= known.min()
    assert known.max() <= reach.farthest * (1 + 1e-6)
    assert reach.farthest == pytest.approx(geometry.distance(reach.disparities[0]))


def test_the_step_is_that_between_neighbours():
    config = Config.preset("robust")
    geometry = Geometry(400, 0.1, 1.5)
    reach = Reach.of(geometry, config)
    for disparity in (4.0, 20.0, 50.0):
        at = geometry.distance(disparity)
        apart = (geometry.distance(disparity - 1 / 16) - geometry.distance(disparity + 1 / 16)) / 2
        assert reach.step(at) == pytest.approx(apart, rel=1e-3)
    assert reach.step(reach.farthest * 1.01) is None
    assert reach.step(reach.nearest * 0.99) is None
