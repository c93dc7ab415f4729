"""Medians over a window of results, of all or of those whose colour is like the centre's."""

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.colour import alike
from softdepth.hdl.memory.window import Window
from softdepth.hdl.post.layout import is_measured, post_layout, without_markers
from softdepth.hdl.post.rank import LowerMedian
from softdepth.hdl.post.stage import delayed, window_stage


class Median(wiring.Component):
    """Replaces each value by the lower median of its window; code and confidence stay.

    Without ``like`` the frame's edge is repeated. With it, only those count that lie inside the frame and
    whose colour departs from the centre's by less than ``like`` in every channel; there is always one, the
    centre. With ``holes``, results that are no measurement are left out and stay as they are. A result a
    clock, but for twice ``columns`` a line and ``rows`` lines a frame.

    Parameters
    ----------
    value_bits, colour_bits, channels : of a result, and into how many equal parts its colour falls.
    rows, columns : reach of the window.

    Members
    -------
    i, o : results, `post_layout`.
    """

    def __init__(
        self,
        value_bits: int,
        colour_bits: int,
        channels: int,
        max_width: int,
        *,
        rows: int,
        columns: int,
        like: int | None = None,
        holes: bool = False,
    ) -> None:
        self._layout = post_layout(value_bits, colour_bits)
        self._value_bits, self._channels, self._max_width = value_bits, channels, max_width
        self._rows, self._columns, self._like, self._holes = rows, columns, like, holes
        super().__init__({"i": In(stream.Signature(self._layout)), "o": Out(stream.Signature(self._layout))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        rows, columns = self._rows, self._columns
        payload = self.i.payload
        within = ["value"]
        if self._like is not None:
            within.append("colour")
        if self._holes:
            within.append("code")
        members = self._layout.members
        element = data.StructLayout({name: members[name] for name in within})
        beside = without_markers(self._layout, *within)
        window = Window(element, beside, rows, columns, self._max_width)
        samples = [s for row in window.window for s in row]
        centre = window.window[rows][columns]

        # A clock says which samples are kept.
        values = [Signal(self._value_bits, name=f"value_{k}", reset_less=True) for k in range(len(samples))]
        m.d.sync += [v.eq(s.value) for v, s in zip(values, samples, strict=True)]
        everything = self._like is None and not self._holes
        m.submodules.median = median = LowerMedian(len(samples), self._value_bits, all_kept=everything)
        m.d.comb += [median.i[k].eq(value) for k, value in enumerate(values)]
        if not everything:
            keeps: list[Value] = []
            for k, sample in enumerate(samples):
                row, column = divmod(k, 2 * columns + 1)
                conditions: list[Value] = []
                if self._like is not None:
                    conditions = [window.row_inside[row], window.column_inside[column]]
                    if (row, column) != (rows, columns):
                        conditions.append(alike(sample.colour, centre.colour, self._channels, self._like))
                if self._holes:
                    conditions.append(is_measured(sample.code))
                keeps.append(Cat(*conditions).all())
            kept = Signal(len(samples), reset_less=True)
            m.d.sync += kept.eq(Cat(*keeps))
            m.d.comb += median.keep.eq(kept)

        latency = 1 + median.latency
        along = data.View(beside, delayed(m, Value.cast(window.companion), latency, "along"))
        of_centre = data.View(element, delayed(m, Value.cast(centre), latency, "centre"))
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
