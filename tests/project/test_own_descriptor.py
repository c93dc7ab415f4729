"""A criterion with a descriptor of its own, in a core without a border band: two files, here in one."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from itertools import chain
from typing import Any, ClassVar, Literal

import numpy as np
import pytest
from amaranth.hdl import Module, Signal, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out
from pydantic import Field

from softdepth.golden import fixed_model
from softdepth.golden.costs.criteria import EVALUATE
from softdepth.golden.costs.values import Values
from softdepth.golden.front.luma import luma
from softdepth.golden.front.pair import Image
from softdepth.hdl.core import StereoCore
from softdepth.hdl.costs.comparison import COMPARISONS, Comparison
from softdepth.hdl.costs.criteria.unlikeness import GradientDifference
from softdepth.hdl.front.descriptor import Descriptor
from softdepth.sim.transfers import pack_frame
from softdepth.spec.config import Config
from softdepth.spec.criteria import CRITERIA, AnyCriterion
from softdepth.spec.pixel import PixelFormat
from tests.hdl.test_core import check, images
from tests.support.simulation import stream_through

LARGEST = 255


# Statement and model.


class Brighter(AnyCriterion):
    """Criterion: the difference of the larger luma of a pixel and its right neighbour, edges replicated."""

    whole_frame: ClassVar[bool] = True
    kind: Literal["brighter"] = "brighter"  # pyright: ignore[reportIncompatibleVariableOverride]
    label_bits: int = Field(default=8, ge=4, le=20)

    def maximum_of(self, pixel: PixelFormat) -> int:
        """White against black."""
        return LARGEST

    @property
    def below(self) -> int:
        """The window's reach."""
        return 1

    @property
    def beside(self) -> int:
        """Likewise."""
        return 1


class BrighterValues:
    """The criterion over a frame."""

    first_column = 0

    def __init__(self, criterion: Brighter, left: Image, right: Image, bits: int) -> None:
        planes = (luma(view).astype(np.int32) for view in (left, right))
        self._left, self._right = (np.maximum(p, np.hstack([p[:, 1:], p[:, -1:]])) for p in planes)

    def band(self, first: int, stop: int) -> Callable[[int], Values]:
        """See `softdepth.golden.costs.criteria.FrameValues`."""
        left, right = self._left[first:stop], self._right[first:stop]
        return lambda d: np.abs(left[:, d:] - right[:, : right.shape[1] - d])


# Gateware.


class Larger(wiring.Component):
    """The descriptor: of a window of 3x3 lumas."""

    latency = 1

    def __init__(self, bits: int) -> None:
        window = data.ArrayLayout(data.ArrayLayout(unsigned(bits), 3), 3)
        super().__init__({"window": In(window), "o": Out(bits)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        held = Signal.like(self.o, reset_less=True)
        here, right = self.window[1][1], self.window[1][2]
        m.d.sync += held.eq(here)
        with m.If(right > here):
            m.d.sync += held.eq(right)
        m.d.comb += self.o.eq(held)
        return m


def comparison(criterion: Brighter, pixel: PixelFormat) -> Comparison:
    shape = unsigned(pixel.bits)
    return Comparison(
        descriptor=Descriptor("brighter", shape, reach=1, latency=Larger.latency, block=Larger),
        rows=1,
        reach=0,
        pixel_maximum=LARGEST,
        block=GradientDifference,
        parameters=(shape, LARGEST, LARGEST, 0),
    )


@pytest.fixture(autouse=True)
def known() -> Iterator[None]:
    """The criterion is known within a test."""
    registries: tuple[tuple[Any, Any], ...] = (
        (CRITERIA, Brighter),
        (EVALUATE, BrighterValues),
        (COMPARISONS, comparison),
    )
    with ExitStack() as scopes:
        for registry, item in registries:
            scopes.enter_context(registry.scope())
            registry.register("brighter", item)
        yield


@pytest.mark.parametrize("others", [[], [{"kind": "gradient", "rows": 3, "columns": 3}]], ids=len)
def test_the_gateware_is_the_model(others: list[dict[str, Any]]) -> None:
    sizes = {"disparities": 4, "lanes": 2, "max_width": 32, "max_height": 16, "pixel": "gray8"}
    c = Config.from_dict({"cost": "sum", "criteria": [{"kind": "brighter"}, *others], **sizes})
    pairs = [images(3, 14, 6, 2), images(4, 9, 5, 1)]
    gray = [(left[:, :, 0], right[:, :, 0]) for left, right in pairs]
    payloads = list(chain.from_iterable(pack_frame(*pair, pixel=c.pixel).tolist() for pair in gray))
    expected = [fixed_model.disparity(*pair, c) for pair in gray]
    assert len(np.unique(expected[0].disparity)) > 2
    check(stream_through(StereoCore(c), payloads).payloads, expected)
