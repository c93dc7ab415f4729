"""How long a frame takes at full rate, whichever room bounds it, against what is counted."""

import pytest

from softdepth.hdl.core import StereoCore
from softdepth.hdl.whole_latency import WholeLatency
from softdepth.sim.transfers import pack_frame
from softdepth.spec.config import Config
from tests.cocotb.scenes import textured
from tests.support.simulation import stream_through

WIDTH, HEIGHT = 24, 10
SMALL = [
    *("disparities=4", f"max_width={WIDTH}", "max_height=16", "pixel=gray8"),
    *("criteria.0.rows=3", "criteria.0.columns=3", "post.masked_median=0"),
]
ISLAND = ["post.island=2", "post.island_rows=3", "post.island_columns=9"]
CASES = {
    "costs": (["lanes=1", "post.island=0"], 0),
    "island test": (["lanes=4", *ISLAND], WIDTH),
    "island test, folded": (["lanes=2", *ISLAND], 2 * WIDTH),
    "median": (["lanes=4", "post.island=0", "post.median=5"], WIDTH),
    "masked medians": (["lanes=2", "post.island=0", "post.masked_median=9", "post.masked_rows=4"], 0),
}
"""Keys, and by how many clocks it may be otherwise: a line's, where a window bounds it."""


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_a_frame_takes_as_long_as_is_said(case: str) -> None:
    changes, within = CASES[case]
    config = Config.preset("robust-small").override([*SMALL, *changes])
    left, right = textured(HEIGHT, WIDTH, 1)
    frame = pack_frame(left[..., 1], right[..., 1], pixel=config.pixel).tolist()
    found = stream_through(StereoCore(config), frame * 4, patience=2000)
    begins = [found.taken[k * len(frame)] for k in range(4)]
    said = WholeLatency.of(config).frame_clocks(WIDTH, HEIGHT, config.steps)
    assert abs(begins[3] - begins[2] - said) <= within
