"""Support by colour likeness: which columns count for a pixel, and their mean."""

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.colour import alike
from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, tree_operations
from softdepth.hdl.arithmetic.popcount import popcount
from softdepth.hdl.memory.delay import Delay
from softdepth.spec.criteria import RECIPROCAL_BITS, SUPPORT_SHIFT

MULTIPLY_CLOCKS = 2
"""Clocks that `Pipeline.multiply` takes."""


def reciprocals(taps: int) -> tuple[int, ...]:
    """The factors of sums of 1, 2, ... columns."""
    return tuple(((2 << RECIPROCAL_BITS) // n + 1) // 2 for n in range(1, taps + 1))


def support_layout(taps: int) -> data.StructLayout:
    """A bit for each column that counts, leftmost first, and the reciprocal of their number."""
    return data.StructLayout({"weights": taps, "reciprocal": range(max(reciprocals(taps)) + 1)})


class SupportWeights(wiring.Component):
    """Once per pixel: the support's columns whose colour is like the centre's, and one reciprocal.

    Parameters
    ----------
    colour_bits, channels : of a pixel.
    taps, spacing : columns, and how far apart; the pixel's own is in the middle.
    like : a column counts if every channel differs by less than this.

    Members
    -------
    enters : a slot begins: the colour of its column is there.
    colour, inside : that colour, and whether the column lies in the frame.
    weights : a bit per column, leftmost first, for the pixel `reach` columns to the left, `latency` clocks
        later.
    reciprocal : of the number of columns that count, in the same clock.
    centre : the pixel's own colour, one clock after ``enters``.
    """

    latency = 4

    def __init__(self, colour_bits: int, channels: int, taps: int, spacing: int, like: int) -> None:
        self._channels, self._taps, self._spacing, self._like = channels, taps, spacing, like
        self.reach = taps // 2 * spacing
        self.table = reciprocals(taps)
        super().__init__(
            {
                "enters": In(1),
                "colour": In(colour_bits),
                "inside": In(1),
                "weights": Out(taps),
                "reciprocal": Out(range(max(self.table) + 1)),
                "centre": Out(colour_bits),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        layout = data.StructLayout({"colour": self.colour.shape(), "inside": 1})
        history: list[data.View] = []  # the newest first
        entering: data.View = Signal(layout)
        m.d.comb += [entering.colour.eq(self.colour), entering.inside.eq(self.inside)]
        for k in range(2 * self.reach + 1):
            column = Signal(layout, name=f"column_{k}", reset_less=True)
            with m.If(self.enters):
                m.d.sync += column.eq(entering)
            history.append(column)
            entering = column
        centre = history[self.reach]
        likes = []
        for k in range(self._taps):
            column = history[2 * self.reach - k * self._spacing]
            near = Const(1, 1)
            if k != self._taps // 2:
                near = alike(column.colour, centre.colour, self._channels, self._like)
            likes.append(column.inside & near)
        like = Signal(self._taps, reset_less=True)
        like_late = Signal.like(like)
        count = Signal(range(self._taps + 1), reset_less=True)
        weights = Signal.like(like)
        reciprocal = Signal.like(self.reciprocal, reset_less=True)
        entries = Array(Const(entry, self.reciprocal.shape()) for entry in (self.table[0], *self.table))
        m.d.sync += [
            like.eq(Cat(*likes)),
            count.eq(popcount(m, like)),
            like_late.eq(like),
            weights.eq(like_late),
            reciprocal.eq(entries[count]),
        ]
        m.d.comb += [
            self.weights.eq(weights),
            self.reciprocal.eq(reciprocal),
            self.centre.eq(centre.colour),
        ]
        return m


class SupportMean(wiring.Component):
    """The mean of those column sums of a candidate that count, with a few bits below one.

    Column sums come step by step; those of the same candidate lie ``steps`` apart.

    Parameters
    ----------
    maximum : of a column sum.

    Members
    -------
    valid, column : a step's column sum.
    weights, reciprocal : of the pixel `SupportWeights.reach` columns to the left, in the same clock.
    o : ``(sum * reciprocal) >> SUPPORT_SHIFT`` of that pixel, `latency` clocks later.
    """

    def __init__(self, maximum: int, taps: int, spacing: int, steps: int) -> None:
        self._maximum, self._taps, self._gap = maximum, taps, spacing * steps
        self.table = reciprocals(taps)
        self.maximum = max(n * maximum * r >> SUPPORT_SHIFT for n, r in enumerate(self.table, start=1))
        self.latency = 1 + clocks(tree_operations(taps), levels=1) + MULTIPLY_CLOCKS
        super().__init__(
            {
                "valid": In(1),
                "column": In(range(maximum + 1)),
                "weights": In(taps),
                "reciprocal": In(range(max(self.table) + 1)),
                "o": Out(range(self.maximum + 1)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        value: Value = self.column
        columns = [value]
        for k in range(1, self._taps):
            m.submodules[f"gap_{k}"] = gap = Delay(self.column.shape(), self._gap)
            m.d.comb += [gap.en.eq(self.valid), gap.i.eq(value)]
            value = gap.o
            columns.insert(0, value)
        pipeline = Pipeline(m, levels=1)
        kept = [
            pipeline.result(Mux(self.weights[k], column, 0), 0, self._maximum, 0, "counted")
            for k, column in enumerate(columns)
        ]
        product = pipeline.multiply(
            pipeline.sum(kept), pipeline.input(self.reciprocal, max(self.table), "reciprocal")
        )
        m.d.comb += self.o.eq(product.value >> SUPPORT_SHIFT)
        return m
