"""Result store: lines of results wait until the host is certain to have them."""

from amaranth.hdl import Array, Cat, Module, Mux, Signal, Value
from amaranth.lib import stream, wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from softdepth.hdl.signatures import result_layout
from softdepth.spec.config import Config
from softdepth.spec.protocol import WINDOW, result_bytes

SLOTS = WINDOW + 2
"""One line for each reply that may have to be sent again, one that is ready, and one that the core fills.

With fewer, the core would stall in the middle of a line until the next line confirms a reply."""


class ResultStore(wiring.Component):
    """A ring of `SLOTS` lines in block RAM. The core fills it, and waits when it is full.

    Members
    -------
    i : stream of the core's results.
    width : of the frame, in pixels.
    ready : the oldest line not yet claimed is complete; it lies in ``slot``.
    slot : where that line lies, to be given as ``read_slot``.
    claim : that line goes into a reply. Claimed lines stay.
    release : the oldest claimed line is no longer needed.
    read_slot, index, data : byte ``index`` of the line in ``read_slot``, a clock later.
    fault : the core gave a frame that has not this width, or that is marked as damaged.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._depth = config.max_width
        super().__init__(
            {
                "i": In(stream.Signature(result_layout(config))),
                "width": In(range(config.max_width + 1)),
                "ready": Out(1),
                "slot": Out(range(SLOTS)),
                "claim": In(1),
                "release": In(1),
                "read_slot": In(range(SLOTS)),
                "index": In(16),
                "data": Out(8),
                "fault": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        layout = result_layout(self._config)
        kept = [name for name in ("disparity", "code", "confidence") if name in layout.members]
        word = sum(layout[name].width for name in kept)
        m.submodules.memory = memory = Memory(shape=word, depth=SLOTS * self._depth, init=[])
        write = memory.write_port()
        read = memory.read_port()
        filled = Signal(range(SLOTS))  # slot that is being filled
        complete = Signal(range(SLOTS + 1))
        free = Signal(range(SLOTS + 1), init=SLOTS)
        x = Signal(range(self._depth))

        result = self.i.payload
        taken = self.i.valid & self.i.ready
        last = x + 1 == self.width
        m.d.comb += [
            self.i.ready.eq(free != 0),
            write.en.eq(taken),
            write.addr.eq(self._base(filled) + x),
            write.data.eq(Cat(result[name] for name in kept)),
            self.ready.eq(complete != 0),
        ]
        line_done = taken & last
        with m.If(taken):
            m.d.sync += [
                x.eq(Mux(last, 0, x + 1)),
                self.fault.eq(self.fault | (result.eol != last) | (result.sof & (x != 0)) | result.damaged),
            ]
        with m.If(line_done):
            m.d.sync += filled.eq(self._after(filled))
        with m.If(self.claim):
            m.d.sync += self.slot.eq(self._after(self.slot))
        m.d.sync += [
            complete.eq(complete + line_done - self.claim),
            free.eq(free - line_done + self.release),
        ]

        bytes_ = result_bytes(self._config)
        within = (bytes_ - 1).bit_length()  # bits that name a byte of a result
        m.d.comb += [
            read.addr.eq(self._base(self.read_slot) + self.index[within:]),
            self.data.eq(read.data.word_select(self.index[:within], 8)),
        ]
        return m

    def _base(self, slot: Signal) -> Value:
        """Address of a slot's first result."""
        return Array(k * self._depth for k in range(SLOTS))[slot]

    @staticmethod
    def _after(slot: Signal) -> Value:
        return Mux(slot == SLOTS - 1, 0, slot + 1)
