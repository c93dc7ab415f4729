"""What a criterion compares of a pixel, and what computes it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from amaranth.hdl import Shape, unsigned
from amaranth.lib import wiring

from softdepth.hdl.front.census import CENSUS_REACH, SQUARES, Census
from softdepth.hdl.front.gradient import Gradient

COLOUR = "colour"


@dataclass(frozen=True)
class Descriptor:
    """A number that is computed once for a view's pixel, before it is compared with many others.

    Members
    -------
    name : what tells it from others of a core.
    shape : of the number.
    reach : rows and columns around the pixel that it depends on.
    latency : clocks of the block.
    block : makes, from the bits of a luma, the component that computes it: with a port ``window`` of
        ``2 reach + 1`` rows and columns of lumas, top left first, and ``o``. None for the pixel itself.
    """

    name: str
    shape: Shape
    reach: int = 0
    latency: int = 0
    block: Callable[[int], wiring.Component] | None = None


CENSUS = Descriptor("census", unsigned(len(SQUARES)), CENSUS_REACH, Census.latency, Census)


def gradient(cap: int) -> Descriptor:
    """The horizontal gradient, held within +-``cap``."""
    shape = Shape.cast(range(-cap, cap + 1))
    return Descriptor(f"gradient_{cap}", shape, 1, Gradient.latency, partial(Gradient, cap=cap))


def colour(bits: int) -> Descriptor:
    """The pixel itself, of so many bits."""
    return Descriptor(COLOUR, unsigned(bits))
