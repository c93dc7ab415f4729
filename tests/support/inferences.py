"""Inferences of all kinds on sets of criteria, beside the fixed model's fractions."""

from collections.abc import Callable, Sequence
from random import Random
from typing import Any

import numpy as np
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.golden import fixed_model
from softdepth.hdl.costs.cost import fraction_layout
from softdepth.spec.config import Config, PixelFormat
from tests.support.simulation import config, piped, sad

Values = tuple[int, ...]
Fractions = list[tuple[int, int]]
Kind = Callable[[Config, list[int]], Any]
"""An inference's class."""


class Inference(wiring.Component):
    """An inference, with one output for both terms."""

    def __init__(self, kind: Kind, c: Config, maxima: list[int]) -> None:
        self.inner = kind(c, maxima)
        self.latency = self.inner.latency
        super().__init__({"i": In(self.inner.i.shape()), "o": Out(fraction_layout(c))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.inner = self.inner
        m.d.comb += [
            self.inner.i.eq(self.i),
            self.o.num.eq(self.inner.num),
            self.o.den.eq(self.inner.den),
        ]
        return m


def settings(bits: int, *label_bits: int, windows: Sequence[int] = (3, 3, 3), **keys: Any) -> Config:
    """A configuration with this width of memberships and these criteria."""
    criteria = [sad(w, 0, label) for w, label in zip(windows, label_bits, strict=True)]
    return config(disparities=2, lanes=1, membership_bits=bits, criteria=criteria, **keys)


def small(settings: Callable[..., Config]) -> dict[str, Config]:
    """By name, what `settings` makes of sizes at which every position of the criteria can be tried."""
    found = (
        settings(2, 4, 4, 4),
        settings(2, 12, 5, 9),
        settings(3, 4, 4, 4),
        # Criteria that never reach 2T, nor T, nor half of it.
        settings(3, 11, 9, 7, windows=(3, 1, 1)),
        settings(3, 9, 10, 12, windows=(1, 3, 1)),
        settings(2, 14, 14, 15, windows=(1, 3, 1)),
    )
    return {f"{c.membership_bits} bits, {[s.label_bits for s in c.criteria]}": c for c in found}


def positions(c: Config, i: int, maximum: int | None = None) -> list[int]:
    """Every membership position of a criterion, once or from both ends of its range, and beyond 2T."""
    criterion = c.criteria[i]
    maximum = criterion.maximum_of(PixelFormat.RGB8) if maximum is None else maximum
    unit = 1 << (criterion.label_bits - c.membership_bits)
    top = 2 << criterion.label_bits
    found = {u * unit + (unit - 1) * (u % 2) for u in range(2 * c.one + 1)}
    found |= {top // 2 - 1, top // 2, top - 1, top, top + 1, top + top // 2 + unit, 2 * top, maximum}
    return sorted(v for v in found if v <= maximum)


def around_the_labels(c: Config, i: int, random: Random) -> int:
    """A value of any size, or near 0, T / 2, T, 3T / 2 or 2T, where the cases of a form meet."""
    criterion = c.criteria[i]
    half = 1 << criterion.label_bits >> 1
    unit = 1 << (criterion.label_bits - c.membership_bits)
    value = random.choice(
        (
            random.randint(0, criterion.maximum_of(PixelFormat.RGB8)),
            random.randrange(4 * half),
            random.randrange(5) * half + random.randint(-2, 2) * unit + random.randint(-1, 1),
            random.randrange(5) * half + random.randint(-12, 12) * unit,
        )
    )
    return min(max(value, 0), criterion.maximum_of(PixelFormat.RGB8))


def stimulus(sets: Sequence[Values]) -> list[dict[str, Any]]:
    """The inputs that give an inference one set of criteria a clock."""
    return [{"i": {f"s{i}": v for i, v in enumerate(values)}} for values in sets]


def gateware(kind: Kind, c: Config, sets: Sequence[Values], maxima: list[int] | None = None) -> Fractions:
    """What the inference makes of each set; ``maxima`` are the criteria's own, if not given."""
    dut = Inference(kind, c, maxima or [criterion.maximum_of(PixelFormat.RGB8) for criterion in c.criteria])
    return [(o.num, o.den) for o in piped(dut, stimulus(sets))]


def model(c: Config, sets: Sequence[Values]) -> Fractions:
    """What the fixed model makes of each set."""
    columns = [np.array(column, np.int32) for column in zip(*sets, strict=True)]
    num, den = fixed_model.fraction(c, 0, columns)
    return list(zip(num.tolist(), den.tolist(), strict=True))
