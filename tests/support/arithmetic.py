"""A component around an expression of the pipeline."""

from collections.abc import Callable, Sequence

from amaranth.hdl import Module, Shape, signed
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import LEVELS, Pipeline
from softdepth.hdl.arithmetic.word import Word

Range = tuple[int, int]
Build = Callable[[Pipeline, Sequence[Word]], Word]


class Arithmetic(wiring.Component):
    """One expression over inputs of given ranges; ``word`` is what the pipeline says of its result.

    Parameters
    ----------
    ranges : of the inputs ``a0``, ``a1``, ...
    operations : in a row from the inputs to the result.
    build : makes the expression of its inputs.
    levels : operations between two registers.
    """

    def __init__(
        self, ranges: Sequence[Range], operations: int, build: Build, *, levels: int = LEVELS
    ) -> None:
        self.ranges = ranges
        self.levels = levels
        self.latency = operations // levels
        self.build = build
        shapes = {f"a{k}": Shape.cast(range(low, high + 1)) for k, (low, high) in enumerate(ranges)}
        super().__init__({"i": In(data.StructLayout(shapes)), "o": Out(signed(48))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m, self.levels)
        inputs = [
            pipeline.input(self.i[f"a{k}"], high, f"a{k}", minimum=low)
            for k, (low, high) in enumerate(self.ranges)
        ]
        self.word = self.build(pipeline, inputs)
        assert pipeline.clock(self.word) == self.latency
        m.d.comb += self.o.eq(self.word.value)
        return m
