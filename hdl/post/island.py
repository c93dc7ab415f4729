"""Takes back results that stand alone."""

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import data, stream
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.popcount import popcount
from softdepth.hdl.memory.delay import delayed
from softdepth.hdl.memory.window import Window
from softdepth.hdl.memory.window_stage import window_stage
from softdepth.hdl.post.stage import PostStage, StageTime
from softdepth.hdl.winners.layout import is_measured, post_layout, without_markers
from softdepth.spec.post import ISLAND_BITS
from softdepth.spec.validity import Validity


class Island(PostStage):
    """Turns a measurement into an island if the pixels around it, with itself, hold fewer than ``least``.

    The frame's edge is repeated. An island has value 0 and confidence 0; other results pass unchanged. One
    result every ``clocks`` clocks, except for twice ``columns`` a line and ``rows`` lines a frame.

    Parameters
    ----------
    value_bits, colour_bits : of a result.
    rows, columns : reach of the window on either side.

    Members
    -------
    i, o : results, `post_layout`.
    least : the parameter's value unless it is driven. It may change between frames.
    """

    latency = 2
    """From the window to its result in `window_stage`."""

    def __init__(
        self,
        value_bits: int,
        colour_bits: int,
        max_width: int,
        least: int,
        *,
        rows: int,
        columns: int,
        clocks: int = 1,
    ) -> None:
        self._rows, self._columns = rows, columns
        self._layout = post_layout(value_bits, colour_bits)
        self._max_width, self.clocks = max_width, clocks
        super().__init__(
            {
                "i": In(stream.Signature(self._layout)),
                "o": Out(stream.Signature(self._layout)),
                "least": In(ISLAND_BITS, init=least),
            }
        )

    @property
    def time(self) -> StageTime:
        return StageTime.of_window(self._rows, self._columns, self.clocks, self.latency)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        layout = without_markers(self._layout)
        window = Window(1, layout, self._rows, self._columns, self._max_width, clocks=self.clocks)
        found = [element for row in window.window for element in row]
        # In two halves: counted together, they would take most of a clock.
        half = len(found) // 2
        counts = []
        for name, part in (("first", found[:half]), ("second", found[half:])):
            counts.append(Signal(range(len(part) + 1), name=name, reset_less=True))
            m.d.sync += counts[-1].eq(popcount(m, part))
        island = Signal(reset_less=True)
        m.d.sync += island.eq(counts[0] + counts[1] < self.least)
        result = data.View(layout, delayed(m, Value.cast(window.companion), self.latency, "result"))
        falls = is_measured(result.code) & island
        payload = self.i.payload
        window_stage(
            m,
            self.i,
            self.o,
            window,
            self.latency,
            element=is_measured(payload.code),
            companion=Value.cast(payload)[: layout.size],
            results={
                "value": Mux(falls, 0, result.value),
                "code": Mux(falls, Validity.ISLAND, result.code),
                "confidence": Mux(falls, 0, result.confidence),
                "colour": result.colour,
            },
        )
        return m
