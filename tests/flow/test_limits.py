"""Small cores stay within their stored area, and a core that does not is found."""

import copy

import pytest

from softdepth.flow.limits import Limit, load_limits, taken
from softdepth.flow.synthesis import TOP, core_netlist
from softdepth.hdl.built import missing
from softdepth.spec.config import PRESETS, Config
from tests.flow.conftest import SMALL

LIMITS = load_limits()


@pytest.mark.slow
@pytest.mark.parametrize("limit", LIMITS, ids=lambda limit: limit.name)
def test_a_small_core_stays_within_its_limit(limit):
    exceeded = limit.exceeded(taken(core_netlist(limit.config)))
    assert not exceeded, "\n".join(exceeded)


def test_every_preset_has_a_limit():
    assert {limit.preset for limit in LIMITS} == {p for p in PRESETS if not missing(Config.preset(p))}


@pytest.mark.slow
@pytest.mark.parametrize(("resource", "kind"), [("lut4", "LUT4"), ("ff", "TRELLIS_FF"), ("ebr", "DP16KD")])
def test_one_cell_too_many_is_found(small_netlist, resource, kind):
    """The limit is what the core takes; a netlist with one more cell must exceed it, by name and number."""
    now = taken(small_netlist)
    limit = Limit.model_validate({"name": "small", "preset": SMALL.name, "set": [], **now})
    assert limit.exceeded(now) == []
    grown = copy.deepcopy(small_netlist)
    cells = grown["modules"][TOP]["cells"]
    cells["one_more"] = next(cell for cell in cells.values() if cell["type"] == kind)
    assert limit.exceeded(taken(grown)) == [
        f"small: {now[resource] + 1} {resource}, and the limit is {now[resource]}"
    ]
