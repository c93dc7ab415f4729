"""Proofs of whole blocks between streams: one result a pixel, with its markers, on offer until it is taken.

Sound frames of every size within bounds, any pauses on both sides, every run of so many clocks from reset on.
More clocks take minutes: `make formal`.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import pytest

from softdepth.hdl.front.front import Front
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import proof
from tests.support.rasters import Fault, Rasters
from tests.support.simulation import config, sad

pytestmark = pytest.mark.formal

BAND = {"cost": "sum", "pixel": "gray8", "disparities": 2, "lanes": 2, "criteria": [sad(3)]}
SMALL = {"max_width": 8, "max_height": 8}

BLOCKS: dict[str, Callable[[], Any]] = {
    "fill": lambda: Fill(1, 1, 4),
    "island": lambda: Island(1, 1, 4, 5),
    "front": lambda: Front(config(**BAND, **SMALL)),
}
SIZES: dict[str, dict[str, Any]] = {
    "fill": {"widths": range(1, 4), "heights": range(1, 3), "quiet": 9},
    "island": {"widths": range(4, 5), "heights": range(1, 2), "quiet": 20},
    "front": {"widths": range(4, 7), "heights": range(1, 4), "quiet": 4},
}


FRAMES = Claim(
    "of sound frames, one result leaves for each pixel, in order, with its markers; it stands on offer"
    " until it is"
    " taken; all have left some clocks after the last pixel",
    sizes="fill: 1 to 3 by 1 or 2 pixels; island: 4 by 1, of which the last does not come within the"
    " depth; the"
    " input's guard and queue: 4 to 6 by 1 to 3",
    depth="fill: 11 clocks, at full depth 14 clocks; island: 12 clocks; input: 9 clocks",
)


def known(name: str, folder: Path, clocks: int, *, block: Any = None, fault: Fault = "none") -> str:
    """What a proof over so many clocks says of a block, or of one in its place, or with a fault behind."""
    dut = Rasters(block or BLOCKS[name](), **SIZES[name], fault=fault)
    return proof(dut, folder, clocks=clocks, induction=False)


@FRAMES.proven
@pytest.mark.parametrize(
    ("name", "clocks"),
    [
        ("fill", 11),
        ("island", 12),
        ("front", 9),
        pytest.param("fill", 14, marks=pytest.mark.full),
    ],
)
def test_one_result_a_pixel_with_its_markers(name: str, clocks: int, tmp_path: Path) -> None:
    assert known(name, tmp_path, clocks) == "runs of some clocks"


@FRAMES.refuted
@pytest.mark.parametrize("fault", sorted(set(get_args(Fault)) - {"none"}))
def test_a_fault_behind_a_block_is_refuted(fault: Fault, tmp_path: Path) -> None:
    assert known("fill", tmp_path, 11, fault=fault) == "refuted"


MUTANTS = {
    "a result is overwritten": (Fill, (1, 1, 4), "~ending & places.i.ready", "~ending"),
}


@FRAMES.refuted
@pytest.mark.parametrize("name", MUTANTS)
def test_a_block_with_a_fault_is_refuted(name: str, tmp_path: Path) -> None:
    block, sizes, old, new = MUTANTS[name]
    assert known("fill", tmp_path, 11, block=mutated(block, old, new)(*sizes)) == "refuted"
