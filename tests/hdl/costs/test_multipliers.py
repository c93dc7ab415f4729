"""The multipliers that a configuration announces, against those in the elaborated core."""

import re
from math import ceil
from typing import Any

import pytest
from amaranth.back import rtlil

from softdepth.hdl.core import StereoCore
from softdepth.spec.config import MULTIPLIER_BITS, Config
from softdepth.spec.errors import ConfigError
from tests.support.simulation import config, sad

MIXED = [{"kind": "census"}, {"kind": "gradient"}, {"window": 3, "source": "gradient"}]
"""The support of a census takes one in each lane."""
ROW = [sad(3, dx) for dx in (-1, 0, 1)]


def multiplications(c: Config) -> list[tuple[int, int]]:
    """The widths of the operands of every multiplication in the core, those by constants left out."""
    text = rtlil.convert(StereoCore(c), emit_src=False)
    cells = re.findall(r"cell \$mul .*?\n(.*?)\n *end\n", text, re.DOTALL)
    variable = [cell for cell in cells if not re.search(r"connect \\[AB] (\d+'[01]+|\{  \})\n", cell)]
    widths = ([int(bits) for bits in re.findall(r"\\[AB]_WIDTH (\d+)", cell)] for cell in variable)
    return [(a, b) for a, b in widths]


def tiles(a: int, b: int) -> int:
    """Multipliers that a product of these widths takes."""
    return ceil(a / MULTIPLIER_BITS) * ceil(b / MULTIPLIER_BITS)


@pytest.mark.parametrize(
    ("keys", "count"),
    [
        ({"operator": "mean", "disparities": 4, "lanes": 4}, 6),
        ({"operator": "min", "disparities": 6, "lanes": 3}, 6),
        ({"operator": "mean", "disparities": 6, "lanes": 1, "membership_bits": 12}, 2 * 3),
        # Both terms take 18 bits and a sign: four multipliers a product.
        ({"disparities": 6, "lanes": 1, "membership_bits": 12, "rules": "corrected"}, 4 * 2 * 3),
        ({"operator": "prod", "disparities": 4, "lanes": 2}, 4 + 2 * 4),
        ({"operator": "prod", "disparities": 2, "lanes": 1, "rules": "corrected"}, 2 + 4),
        ({"operator": "soft_min_1", "disparities": 4, "lanes": 2}, 4),
        ({"operator": "soft_min_1", "disparities": 2, "lanes": 1, "softness": 0.5}, 2),
        ({"operator": "soft_min_2", "disparities": 4, "lanes": 2}, 4),
        # Two lanes and steps: two comparisons, as many of the runner-up, and of the right winner one a lane,
        # and one of the two parts.
        ({"disparities": 4, "lanes": 2, "post": {"check": True}}, 2 * (2 + 3)),
        ({"disparities": 5, "lanes": 1, "post": {"check": True}}, 2 * (3 + 1)),
        ({"disparities": 5, "lanes": 5, "post": {"check": True}}, 2 * (4 + 5 + 3)),
        ({"disparities": 4, "lanes": 2, "post": {"fraction_bits": 4, "confidence": True}}, 2 * (2 + 2)),
        ({"disparities": 4, "lanes": 2, "post": {"check": True, "confidence": True}, "criteria": MIXED}, 16),
    ],
    ids=str,
)
def test_multipliers_are_those_of_the_core(keys: dict[str, Any], count: int) -> None:
    c = config(**{"criteria": ROW, **keys})
    found = multiplications(c)
    assert c.multipliers == sum(tiles(a, b) for a, b in found) == count


def test_plain_sad_takes_none() -> None:
    c = config(cost="sum", criteria=[sad(3)], disparities=4, lanes=2, operator="prod", max_multipliers=0)
    assert c.multipliers == len(multiplications(c)) == 0


@pytest.mark.parametrize(
    ("overrides", "count"),
    [
        ([], 34),  # 15 comparisons in the tree and 2 in the sequence of 4 steps
        (["operator=prod", "lanes=4"], 30),  # (3 + 4) * 2, and 4 in each of 4 lanes
        (["operator=prod", "lanes=1"], 16),
        (["lanes=64"], 126),
        (["operator=min"], 34),
    ],
)
def test_multipliers_of_the_paper(overrides: list[str], count: int) -> None:
    assert Config.preset("paper").override(overrides).multipliers == count


def test_more_than_the_part_has_is_refused() -> None:
    paper = Config.preset("paper")
    with pytest.raises(ConfigError) as refusal:
        paper.override(["operator=prod", "lanes=32"])
    text = str(refusal.value)
    for part in ("'prod'", "32 lanes", "192 multipliers", "max_multipliers = 156", "use fewer lanes"):
        assert part in text
    assert paper.override(["operator=prod", "lanes=32", "max_multipliers=192"]).multipliers == 192
    with pytest.raises(ConfigError, match=r"takes 34 multipliers.*max_multipliers = 33"):
        paper.override(["max_multipliers=33"])


def test_the_limit_does_not_shape_the_core() -> None:
    paper = Config.preset("paper")
    assert paper.hash == paper.override(["max_multipliers=1000"]).hash != paper.override(["lanes=8"]).hash
