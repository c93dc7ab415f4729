"""Criteria, costs and stages in combinations that no preset has, against the fixed model: small and quick.

Random ones, in the compiled simulation, are in `tests/cocotb`.
"""

from typing import Any

import numpy as np
import pytest
from amaranth.hdl import Const

from softdepth.golden.fixed_model import disparity
from softdepth.golden.front.pair import Image
from softdepth.hdl.core import StereoCore
from softdepth.hdl.costs import whole_costs
from softdepth.hdl.costs.comparison import by_windows, plan
from softdepth.sim.transfers import pack_frame
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity
from tests.hdl.test_core import check, images
from tests.support.simulation import config, sad, stream_through

GRADIENTS = [sad(w, dx, 8) | {"source": "gradient"} for w, dx in ((3, 0), (5, -1), (3, 2))]
MIXED = [{"kind": "census", "taps": 3, "spacing": 1}, {"kind": "gradient", "rows": 3}, sad(3, 1, 9)]
ALL = {"check": True, "island": 4, "fraction_bits": 4, "fill": True, "median": 5, "masked_median": 2}
SIZE = {"disparities": 4, "lanes": 2, "membership_bits": 6}

COMBINATIONS: dict[str, Config] = {
    "SADs of gradients": config(**SIZE, criteria=GRADIENTS),
    "SADs of gradients, summed": config(**SIZE, cost="sum", criteria=GRADIENTS[:2]),
    "fuzzy, all of one kind": config(**SIZE, operator="min", criteria=MIXED[:2] + MIXED[:1]),
    "fuzzy and checked": config(**SIZE, criteria=MIXED, post=ALL | {"confidence": True}),
    "a SAD and every stage": config(**SIZE, cost="sum", criteria=[sad(3)], post=ALL),
    "few rows and coarse colours": config(
        **SIZE,
        pixel="rgb12",
        cost="sum",
        criteria=MIXED[:1],
        post=ALL
        | {"island_rows": 3, "island_columns": 7, "masked_median": 5, "masked_spacing": 2}
        | {"masked_rows": 2, "colour_bits": 3, "like": 72},
    ),
    "candidates from 3 on": config(**SIZE, min_disparity=3, cost="sum", criteria=MIXED[:1], post=ALL),
    "candidates from -3 on": config(
        **SIZE, min_disparity=-3, pixel="gray12", criteria=MIXED, post={"check": True, "fraction_bits": 4}
    ),
}


def frames(c: Config) -> list[tuple[Image, Image]]:
    """The narrowest, and one with a row of measurements beside the band."""
    pairs = [images(5, c.min_width, 2 * c.reach_rows + 3), images(6, c.min_width + 8, 9)]
    if c.pixel.channels == 1:
        pairs = [(left[..., 1], right[..., 1]) for left, right in pairs]
    if c.pixel.bits > 8:
        pairs = [(left.astype(np.uint16) * 16 + 3, right.astype(np.uint16) * 16) for left, right in pairs]
    return pairs


def results(c: Config, pairs: list[tuple[Image, Image]]) -> list[Any]:
    payloads = [word for pair in pairs for word in pack_frame(*pair, pixel=c.pixel).tolist()]
    return stream_through(StereoCore(c), payloads, o_rate=0.8, patience=2000).payloads


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=[pytest.mark.slow] if c.post.any else []) for name, c in COMBINATIONS.items()],
)
def test_combination(name: str) -> None:
    c = COMBINATIONS[name]
    assert not by_windows(c)
    pairs = frames(c)
    found = results(c, pairs)
    expected = [disparity(*pair, c) for pair in pairs]
    check(found, expected)
    assert len(np.unique(np.concatenate([e.code.ravel() for e in expected]))) > 1
    if c.post.confidence:
        sure = [each.confidence for each in expected]
        assert [o.confidence for o in found] == [v for s in sure if s is not None for v in s.ravel()]


def test_a_border_band_that_is_judged_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    c = COMBINATIONS["SADs of gradients, summed"]
    pairs = frames(c)
    monkeypatch.setattr(whole_costs, "in_border", lambda *_: Const(0, 1))
    with pytest.raises(AssertionError, match="y=0 x=0"):
        check(results(c, pairs), [disparity(*pair, c) for pair in pairs])


def test_windows_of_one_size_share_their_sums() -> None:
    row = config(**SIZE, criteria=[sad(3, dx) | {"source": "gradient"} for dx in (-2, 0, 2)])
    assert len(plan(row).columns) == 1
    assert len(plan(COMBINATIONS["SADs of gradients"]).columns) == 2
    assert len(plan(Config.preset("robust")).columns) == 2


def test_windows_of_colours_take_the_smaller_kind() -> None:
    assert by_windows(Config.preset("paper"))
    assert not by_windows(Config.preset("paper").override(["post.fill=true"]))
    assert not by_windows(Config.preset("robust"))


def test_what_lies_beside_the_overlap_has_no_result() -> None:
    c = COMBINATIONS["candidates from 3 on"]
    found = disparity(*frames(c)[1], c)
    assert (found.code[:, :3] == Validity.BORDER).all()
    assert (found.code[:, 3:] != Validity.BORDER).all()
