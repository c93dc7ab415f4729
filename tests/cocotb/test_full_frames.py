"""Real frames with the criteria of preset `paper`, every pixel."""

from pathlib import Path

import pytest

from softdepth.golden.data.datasets import load
from softdepth.spec.config import OPERATORS, Config, Operator
from tests.cocotb.conftest import Exact

ROWS = slice(130, 400)
"""Of Motorcycle: near and far parts."""


@pytest.mark.slow
def test_motorcycle(exact: Exact) -> None:
    """Whole lines of it, and more of them than 8 bits count."""
    pair = load("motorcycle")
    result = exact(Config.preset("paper"), [(pair.left[ROWS], pair.right[ROWS])])
    assert result.cycles_per_pixel == pytest.approx(Config.preset("paper").steps, rel=1e-4)


@pytest.mark.slow
@pytest.mark.middlebury
def test_middlebury(exact: Exact, data_dir: Path) -> None:
    """Teddy, Cones and Venus, one behind the other in one stream."""
    pairs = [load(f"middlebury:{scene}") for scene in ("teddy", "cones", "venus")]
    exact(Config.preset("paper"), [(pair.left, pair.right) for pair in pairs])


@pytest.mark.full
@pytest.mark.slow
@pytest.mark.middlebury
@pytest.mark.parametrize("operator", [operator for operator in OPERATORS if operator != "mean"])
def test_middlebury_with_every_operator(exact: Exact, data_dir: Path, operator: Operator) -> None:
    """The same with the other operators, in as many lanes as PROD's multipliers allow."""
    pairs = [load(f"middlebury:{scene}") for scene in ("teddy", "cones", "venus")]
    config = Config.preset("paper").override([f"operator={operator}", "lanes=4"])
    exact(config, [(pair.left, pair.right) for pair in pairs])


@pytest.mark.full
@pytest.mark.slow
@pytest.mark.middlebury
def test_teddy_in_gray_of_12_bits_from_below_0(exact: Exact, data_dir: Path) -> None:
    """Winners of both signs: 7 in 100 of Teddy's are below 0, wrongly, and the gateware's are the same."""
    pair = load("middlebury:teddy").as_format("gray12")
    keys = ("pixel=gray12", "min_disparity=-8", *(f"criteria.{k}.label_bits=12" for k in range(3)))
    result = exact(Config.preset("lite").override(keys), [(pair.left, pair.right)])
    found = result.maps[0]
    assert found.disparity.shape == pair.left.shape
    assert found.disparity[found.valid].min() == -8
