"""Horizontal box sum of a candidate's column costs."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, clocks, start, travelling
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.memory.delay import Delay


class BoxSum(wiring.Component):
    """Sums the column costs of the last ``window`` pixels, for ``steps`` interleaved candidates.

    Windows are built from narrower ones (7 = 4 + 3, 4 = 2 + 2, ...), so w columns take about
    ``log2(w)`` adders and no running state: nothing has to be cleared between lines or frames.

    Parameters
    ----------
    maximum : largest column cost.
    window : columns to sum.
    steps : candidates that take turns at the input; a pixel ago is ``steps`` valid clocks ago.

    Members
    -------
    valid : the input is a step of a pixel.
    i : column cost.
    o : window sum, `latency` clocks later.
    """

    def __init__(self, maximum: int, window: int, steps: int) -> None:
        self._maximum = maximum
        self._window = window
        self._steps = steps
        self.maximum = maximum * window
        self._operations = _operations(window)
        self.latency = clocks(self._operations)
        super().__init__({"valid": In(1), "i": In(range(maximum + 1)), "o": Out(range(self.maximum + 1))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        pipeline = Pipeline(m)
        valid = travelling(m, self.valid, self.latency, "valid")

        sums: dict[int, Word] = {
            1: pipeline.input(self.i, self._maximum, "column", time=start(self._operations))
        }

        def pixels_ago(word: Word, pixels: int) -> Word:
            delay = Delay(word.value.shape(), pixels * self._steps)
            m.submodules[f"ago_{pixels}_of_{word.maximum // self._maximum}"] = delay
            m.d.comb += [delay.en.eq(valid[pipeline.clock(word)]), delay.i.eq(word.value)]
            return pipeline.input(delay.o, word.maximum, word.name, time=word.time)

        def box(width: int) -> Word:
            if width not in sums:
                near = width // 2
                sums[width] = box(near) + pixels_ago(box(width - near), near)
            return sums[width]

        total = box(self._window)
        assert pipeline.clock(total) == self.latency
        m.d.comb += self.o.eq(total.value)
        return m


def _operations(window: int) -> int:
    """Operations in a row that a box of ``window`` columns takes."""
    return 0 if window == 1 else 1 + _operations((window + 1) // 2)
