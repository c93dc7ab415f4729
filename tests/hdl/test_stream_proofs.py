"""Proofs of whole blocks between streams: one result a pixel, with its markers, on offer until it is taken.

Sound frames of every size within bounds, any pauses on both sides, every run of so many clocks from reset on.
More clocks take minutes: `make formal`.

When all results of a frame have left is known from what a block says of its latency. It is tight: of `Fill`,
`Island` and a whole core, a clock less is refuted.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import pytest

from softdepth.hdl.band_latency import BandLatency
from softdepth.hdl.core import StereoCore
from softdepth.hdl.front.front import Front
from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY
from softdepth.hdl.memory.window import Window
from softdepth.hdl.post.fill import Fill
from softdepth.hdl.post.island import Island
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import some_clocks
from tests.support.rasters import Fault, Rasters
from tests.support.simulation import config, sad

pytestmark = pytest.mark.formal

BAND = {"cost": "sum", "pixel": "gray8", "disparities": 2, "lanes": 2, "criteria": [sad(3)]}
SMALL = {"max_width": 8, "max_height": 8}

CORE = config(**BAND, **SMALL)
"""The smallest core: two candidates by 3x3 SADs, side by side."""

REACH = 2
"""Rows and columns that `Island` looks at on either side."""
BLOCKS: dict[str, Callable[[], Any]] = {
    "fill": lambda: Fill(1, 1, 4),
    "island": lambda: Island(1, 1, 4, 5, rows=REACH, columns=REACH),
    "front": lambda: Front(CORE),
    "core": lambda: StereoCore(CORE),
}


def core_latency() -> int:
    """Clocks from a pixel to the result that it completes."""
    return BandLatency.of(CORE).full_rate


LINE, ISLAND_LINE = 3, 4
"""Pixels of the longest lines of `Fill` and `Island`."""
QUIET = {
    # Without a measurement, a line's results leave one after the other once its end has come through.
    "fill": Fill.latency + LINE,
    # Behind the last pixel its column is repeated, and the rows below, at both ends, too.
    "island": REACH
    + REACH * (ISLAND_LINE + 2 * REACH)
    + Window.latency_of(1)
    + Island.latency
    + QUEUE_LATENCY,
    "front": 2 * ItemQueue.latency,
    # What is behind the last pixel's own result leaves without a pixel.
    "core": CORE.reach_rows * CORE.min_width + CORE.reach_right + core_latency(),
}
"""Clocks after the last pixel, with nothing in the way, when all results have left."""
SIZES: dict[str, dict[str, Any]] = {
    "fill": {"widths": range(1, LINE + 1), "heights": range(1, 3)},
    "island": {"widths": range(ISLAND_LINE, ISLAND_LINE + 1), "heights": range(1, 2)},
    "front": {"widths": range(4, 7), "heights": range(1, 4)},
    "core": {
        "widths": range(CORE.min_width, CORE.min_width + 1),
        "heights": range(CORE.min_height, CORE.min_height + 1),
        "blank": ("left", "right"),
    },
}


FRAMES = Claim(
    "of sound frames, one result leaves for each pixel, in order, with its markers; it stands on offer until"
    " it is taken; and so many clocks after the last pixel, with nothing in the way, all have left",
    sizes=f"fill: 1 to {LINE} by 1 or 2 pixels, {QUIET['fill']} clocks; island: {ISLAND_LINE} by 1,"
    f" {QUIET['island']} clocks; the input's guard and queue: 4 to 6 by 1 to 3, {QUIET['front']} clocks; a"
    f" whole core of two candidates: {CORE.min_width} by {CORE.min_height}, all pixels alike,"
    f" {QUIET['core']} clocks",
    depth="fill: 13 clocks, at full depth 16 clocks; island: 40 clocks, at full depth 55 clocks; input: 10"
    " clocks, at full depth 13 clocks; core: 20 clocks, at full depth 32 clocks, in which a frame ends",
)


def known(
    name: str,
    folder: Path,
    clocks: int,
    *,
    block: Any = None,
    fault: Fault = "none",
    sooner: int = 0,
) -> str:
    """What a proof over so many clocks says of a block, or of one in its place, or with a fault behind."""
    quiet = QUIET[name] - sooner
    dut = Rasters(block or BLOCKS[name](), **SIZES[name], quiet=quiet, fault=fault)
    return some_clocks(dut, folder, clocks)


@FRAMES.proven
@pytest.mark.parametrize(
    ("name", "clocks"),
    [
        ("fill", 13),
        ("island", 40),
        ("front", 10),
        pytest.param("fill", 16, marks=pytest.mark.full),
        pytest.param("island", 55, marks=pytest.mark.full),
        pytest.param("front", 13, marks=pytest.mark.full),
        ("core", 20),
        pytest.param("core", 32, marks=pytest.mark.full),
    ],
)
def test_one_result_a_pixel_with_its_markers(name: str, clocks: int, tmp_path: Path) -> None:
    assert known(name, tmp_path, clocks) == "runs of some clocks"


@FRAMES.refuted
@pytest.mark.parametrize("fault", sorted(set(get_args(Fault)) - {"none"}))
def test_a_fault_behind_a_block_is_refuted(fault: Fault, tmp_path: Path) -> None:
    assert known("fill", tmp_path, 13, fault=fault) == "refuted"


@FRAMES.refuted
@pytest.mark.parametrize(
    ("name", "clocks"),
    [("fill", 13), ("island", 40), pytest.param("core", 32, marks=pytest.mark.full)],
)
def test_results_that_are_wanted_a_clock_too_soon_are_refuted(name: str, clocks: int, tmp_path: Path) -> None:
    assert known(name, tmp_path, clocks, sooner=1) == "refuted"


MUTANTS = {
    "a result is overwritten": (Fill, (1, 1, 4), "~ending & places.i.ready", "~ending"),
}


@FRAMES.refuted
@pytest.mark.parametrize("name", MUTANTS)
def test_a_block_with_a_fault_is_refuted(name: str, tmp_path: Path) -> None:
    block, sizes, old, new = MUTANTS[name]
    assert known("fill", tmp_path, 13, block=mutated(block, old, new)(*sizes)) == "refuted"
