"""The lanes of the costs that are compared, as their area is measured."""

import pytest
from amaranth.back import rtlil

from softdepth.studies.evaluate.lanes import core_of
from softdepth.studies.evaluate.variants import compared
from softdepth.studies.summed_lane import SummedLane

VARIANTS = compared()


@pytest.mark.parametrize("name", VARIANTS)
def test_the_lane_is_built_as_in_a_core(name: str) -> None:
    """Of everything between the descriptors and the cost, once, whatever the core's lanes are."""
    text = rtlil.convert(SummedLane(core_of(VARIANTS[name])), name="lane")
    for block in ("differences", "sums", "running_0"):
        assert text.count(f"module \\lane.{block}\n") == 1
    assert "lane.running_16" not in text
