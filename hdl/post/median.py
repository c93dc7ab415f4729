"""Medians over a window of results."""

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data, stream
from amaranth.lib.wiring import In, Out

from softdepth.hdl.memory.delay import waiting
from softdepth.hdl.memory.window import Window
from softdepth.hdl.memory.window_stage import window_stage
from softdepth.hdl.post.rank import LowerMedian
from softdepth.hdl.post.stage import PostStage, StageTime
from softdepth.hdl.winners.layout import is_measured, post_layout, without_markers


class Median(PostStage):
    """Replaces each value by the lower median of its window; code and confidence stay.

    The frame's edge is repeated. With ``holes``, results without a measurement are left out and stay as they
    are. One result every ``clocks`` clocks, except for twice ``columns`` a line and ``rows`` lines a frame.

    Parameters
    ----------
    value_bits, colour_bits : of a result.
    rows, columns : reach of the window.

    Members
    -------
    i, o : results, `post_layout`.
    """

    def __init__(
        self,
        value_bits: int,
        colour_bits: int,
        max_width: int,
        *,
        rows: int,
        columns: int,
        holes: bool = False,
        clocks: int = 1,
    ) -> None:
        self._layout = post_layout(value_bits, colour_bits)
        self._value_bits, self._max_width = value_bits, max_width
        self._rows, self._columns, self._holes, self.clocks = rows, columns, holes, clocks
        samples = (2 * rows + 1) * (2 * columns + 1)
        self._median = LowerMedian(samples, value_bits, all_kept=not holes)
        self.latency = 1 + self._median.latency
        """From the window to its result in `window_stage`."""
        super().__init__({"i": In(stream.Signature(self._layout)), "o": Out(stream.Signature(self._layout))})

    @property
    def time(self) -> StageTime:
        return StageTime.of_window(self._rows, self._columns, self.clocks, self.latency)

    def elaborate(self, platform: object) -> Module:
        m = Module()
        rows, columns = self._rows, self._columns
        payload = self.i.payload
        within = ["value", "code"] if self._holes else ["value"]
        members = self._layout.members
        element = data.StructLayout({name: members[name] for name in within})
        beside = without_markers(self._layout, *within)
        window = Window(element, beside, rows, columns, self._max_width, clocks=self.clocks)
        samples = [s for row in window.window for s in row]
        centre = window.window[rows][columns]

        # This clock finds out which samples are kept.
        values = [Signal(self._value_bits, name=f"value_{k}", reset_less=True) for k in range(len(samples))]
        m.d.sync += [v.eq(s.value) for v, s in zip(values, samples, strict=True)]
        m.submodules.median = median = self._median
        m.d.comb += [median.i[k].eq(value) for k, value in enumerate(values)]
        if self._holes:
            kept = Signal(len(samples), reset_less=True)
            m.d.sync += kept.eq(Cat(is_measured(sample.code) for sample in samples))
            m.d.comb += median.keep.eq(kept)

        latency = self.latency
        along = data.View(beside, waiting(m, Value.cast(window.companion), latency, "along"))
        of_centre = data.View(element, waiting(m, Value.cast(centre), latency, "centre"))
        results: dict[str, Value] = {name: along[name] for name in beside.members}
        results |= {name: of_centre[name] for name in within if name != "value"}
        results["value"] = median.o
        if self._holes:
            results["value"] = Mux(is_measured(of_centre.code), median.o, of_centre.value)
        window_stage(
            m,
            self.i,
            self.o,
            window,
            latency,
            element=Cat(*(payload[name] for name in within)),
            companion=Cat(*(payload[name] for name in beside.members)),
            results=results,
        )
        return m
