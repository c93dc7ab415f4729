"""The plan of functional coverage, and which of its bins the suite's random runs reach.

A bin is a kind of cost with its rules and operator, beside a border band or none, and a pattern of stalls; or
a kind of fault beside a pattern of stalls. The runs are those of random configurations in tests/cocotb and of
broken video in tests/hdl/test_core_broken_video.py: what they draw is drawn here again, nothing is simulated.
"""

from collections import Counter
from collections.abc import Iterator
from itertools import product

from softdepth.hdl.signatures import Status
from softdepth.spec.config import OPERATORS, Config
from tests.cocotb.scenes import SEEDS, random_config, random_whole_config
from tests.hdl.test_core_broken_video import CONFIGS, SEEDS_OF_BROKEN
from tests.support.broken_video import broken_video
from tests.support.fault_table import mended

Bin = tuple[str, ...]
STALLS = ("full rate", "random stalls")
BORDERS = ("band", "no band")
WHOLE_SEEDS = range(6)


def plan() -> set[Bin]:
    """Every bin that is to be reached."""
    fuzzy = product(BORDERS, sorted(OPERATORS), ["all", "cell"], STALLS)
    sums = product(BORDERS, ["sum"], STALLS)
    faults = product(["fault"], ["none", *Status.members], STALLS)
    marks = product(["ends"], ["marked", "not marked"], STALLS)
    return {*fuzzy, *sums, *faults, *marks}


def reached(longer: int = 1) -> Counter[Bin]:
    """How often the suite's random runs reach each bin, or so many times as many configurations would."""
    return Counter(_runs(longer))


def _runs(longer: int) -> Iterator[Bin]:
    with_band = map(random_config, range(len(SEEDS) * longer))
    without = map(random_whole_config, range(len(WHOLE_SEEDS) * longer))
    for config in (*with_band, *without):
        for stalls in STALLS:
            yield (*_kind(config), stalls)
    for config in CONFIGS.values():
        for seed in SEEDS_OF_BROKEN:
            stalls = STALLS[seed % 3 == 0]
            found = mended(broken_video(seed, config)[0], config).counters
            for fault in found or ["none"]:
                yield ("fault", fault, stalls)
            yield ("ends", "not marked" if seed % 2 else "marked", stalls)


def _kind(config: Config) -> Bin:
    band = "no band" if config.whole_frame else "band"
    if config.cost == "sum":
        return band, "sum"
    return band, config.operator, config.firing
