"""Sound frames of any small size through a block's streams, for proofs: what must be true of what leaves."""

from typing import Any, Literal

from amaranth.hdl import Assert, Assume, Module, Mux, Signal, Value
from amaranth.lib.wiring import Component, In

SIDE = 4
"""Bits of a frame's width and height."""
Fault = Literal["none", "withdraws", "changes", "drops", "doubles", "no eof"]


class Rasters(Component):
    """A block with streams ``i`` and ``o`` that have markers, fed with sound frames of one size.

    What is free: the size, within bounds; what else is in the pixels, but for what travels along or is left
    `blank`; when one is offered, and when a result is taken. An offer stands until it is taken. Asserted in
    every clock: a result that is on offer stands unchanged until it is taken; its markers are those of the
    next pixel; none comes before its pixel; and `quiet` clocks after the last pixel, with nothing in the way,
    all have come.
    """

    def __init__(
        self,
        block: Any,
        *,
        widths: range,
        heights: range,
        quiet: int,
        fault: Fault = "none",
        blank: tuple[str, ...] = (),
    ) -> None:
        self._block, self._widths, self._heights = block, widths, heights
        self._quiet, self._fault, self._blank = quiet, fault, blank
        bits = len(Value.cast(block.i.payload))
        sides = {"width": In(SIDE), "height": In(SIDE)}
        super().__init__({"valid": In(1), "payload": In(bits), "ready": In(1), **sides})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.block = block = self._block
        width, height = Signal(SIDE), Signal(SIDE)
        known = Signal()
        m.d.sync += known.eq(1)
        with m.If(~known):
            m.d.sync += [width.eq(self.width), height.eq(self.height)]
        now_width, now_height = Mux(known, width, self.width), Mux(known, height, self.height)
        m.d.comb += [
            Assume((now_width >= self._widths[0]) & (now_width <= self._widths[-1])),
            Assume((now_height >= self._heights[0]) & (now_height <= self._heights[-1])),
        ]

        def place(name: str, moves: Value) -> dict[str, Value]:
            """The markers of a place that goes through frames, on where it moves."""
            x, y = Signal(SIDE, name=f"{name}_x"), Signal(SIDE, name=f"{name}_y")
            found = {
                "sof": (x == 0) & (y == 0),
                "eol": x == now_width - 1,
                "eof": (x == now_width - 1) & (y == now_height - 1),
            }
            with m.If(moves):
                m.d.sync += x.eq(Mux(found["eol"], 0, x + 1))
                with m.If(found["eol"]):
                    m.d.sync += y.eq(Mux(found["eof"], 0, y + 1))
            return found

        offered, stands, taken, given = Signal(), Signal(), Signal(), Signal()
        o_valid, o_payload = Signal(), Signal(block.o.payload.shape())
        m.d.comb += [
            offered.eq(self.valid | stands),
            block.i.valid.eq(offered),
            taken.eq(offered & block.i.ready),
            block.o.ready.eq(self.ready),
            o_valid.eq(block.o.valid),
            o_payload.eq(block.o.payload),
            given.eq(o_valid & self.ready),
        ]
        m.d.sync += stands.eq(offered & ~block.i.ready)
        pixel = Signal(len(self.payload))
        kept = Signal.like(pixel)
        m.d.comb += pixel.eq(Mux(stands, kept, self.payload))
        m.d.sync += kept.eq(pixel)
        m.d.comb += Value.cast(block.i.payload).eq(pixel)
        # More of the same costs time and says nothing.
        for name in ("confidence", "colour", "right", *self._blank):
            if name in block.i.payload.shape().members:
                m.d.comb += block.i.payload[name].eq(0)
        enters = place("enters", taken)
        m.d.comb += [block.i.payload[name].eq(value) for name, value in enters.items()]
        if "damaged" in block.i.payload.shape().members:
            m.d.comb += block.i.payload.damaged.eq(0)
        self._break(m, o_valid, o_payload, given)

        leaves = place("leaves", given)
        inside = Signal(range(1 << 2 * SIDE))
        m.d.sync += inside.eq(inside + taken - given)
        quiet = Signal(range(self._quiet + 1))
        with m.If(offered | ~self.ready):
            m.d.sync += quiet.eq(0)
        with m.Elif(quiet != self._quiet):
            m.d.sync += quiet.eq(quiet + 1)
        with m.If(o_valid):
            m.d.comb += [Assert(o_payload[name] == value) for name, value in leaves.items()]
            m.d.comb += Assert((inside != 0) | taken)
        with m.If((quiet == self._quiet) & enters["sof"]):
            m.d.comb += Assert(inside == 0)
        waited, before = Signal(), Signal(len(Value.cast(o_payload)))
        m.d.sync += [waited.eq(o_valid & ~self.ready), before.eq(Value.cast(o_payload))]
        with m.If(waited):
            m.d.comb += Assert(o_valid & (Value.cast(o_payload) == before))
        return m

    def _break(self, m: Module, o_valid: Signal, o_payload: Any, given: Signal) -> None:
        """Put the fault between the block and what looks at it."""
        block = self._block
        match self._fault:
            case "withdraws":
                m.d.comb += o_valid.eq(block.o.valid & ~self.valid)
            case "changes":
                m.d.comb += o_payload.eof.eq(block.o.payload.eof ^ self.valid)
            case "drops":  # the third result is taken, and not shown
                count = Signal(2)
                with m.If(block.o.valid & self.ready & (count != 3)):
                    m.d.sync += count.eq(count + 1)
                m.d.comb += o_valid.eq(block.o.valid & (count != 2))
            case "doubles":  # the first result is shown, and not taken
                shown = Signal()
                with m.If(o_valid & self.ready):
                    m.d.sync += shown.eq(1)
                m.d.comb += block.o.ready.eq(self.ready & shown)
            case "no eof":
                m.d.comb += o_payload.eof.eq(0)
