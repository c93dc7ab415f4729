"""Blocks that are only asked for their latency leave no warnings that they were not used."""

import gc
import warnings
from collections.abc import Callable

import pytest
from amaranth.hdl import Fragment, UnusedElaboratable

from softdepth.hdl.band_latency import BandLatency
from softdepth.hdl.core import StereoCore
from softdepth.hdl.left_pixels import LeftPixels
from softdepth.hdl.memory.item_queue import ItemQueue
from softdepth.hdl.whole_latency import WholeLatency
from softdepth.spec.config import Config

BAND, WHOLE = Config.preset("sad"), Config.preset("robust-small")


def unused(ask: Callable[[], object]) -> bool:
    """Whether Amaranth says so, once all that `ask` made and did not keep is freed."""
    Fragment.get(ItemQueue(1), None)  # before anything was used, it says nothing
    gc.collect()
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", UnusedElaboratable)
        ask()
        gc.collect()
    return any(warning.category is UnusedElaboratable for warning in found)


@pytest.mark.parametrize(
    "ask",
    [
        lambda: BandLatency.of(BAND),
        lambda: WholeLatency.of(WHOLE),
        lambda: LeftPixels.of(BAND),
        lambda: LeftPixels.of(WHOLE),
    ],
)
def test_who_is_asked_leaves_no_warning(ask: Callable[[], object]) -> None:
    assert not unused(ask)


def test_a_core_that_is_not_used_does() -> None:
    assert unused(lambda: StereoCore(BAND))
