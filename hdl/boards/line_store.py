"""Line store: a line of pixel pairs waits for its checksum, then enters the core."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.memory import Memory, WritePort
from amaranth.lib.wiring import In, Out

from softdepth.hdl.signatures import pair_layout
from softdepth.spec.config import Config
from softdepth.spec.protocol import pair_bytes


class LineStore(wiring.Component):
    """Holds one line of bytes from the link in block RAM; adds markers and feeds it to the core when told.

    The next line may arrive while this one is read, as long as it does not overtake the reader.

    Members
    -------
    width, height : of the frame, in pixels; steady while there is one.
    begin : a frame begins: the next line is its first.
    valid, data : a byte of a line: `pair_bytes` a pair, red, green, blue (or gray), left first.
    close : the line has ended, and the next begins.
    overrun : the line has overtaken the reader and is spoilt; lasts until ``close``.
    feed : the line in store is sound: give it to the core.
    busy : the line is on its way to the core.
    complete : the frame's last line has been fed.
    o : stream of `pair_layout(config.pixel)`.
    """

    def __init__(self, config: Config) -> None:
        self._depth = config.max_width
        self._pixel = config.pixel
        super().__init__(
            {
                "width": In(range(config.max_width + 1)),
                "height": In(range(config.max_height + 1)),
                "begin": In(1),
                "close": In(1),
                "valid": In(1),
                "data": In(8),
                "overrun": Out(1),
                "feed": In(1),
                "busy": Out(1),
                "complete": Out(1),
                "o": Out(stream.Signature(pair_layout(config.pixel))),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.memory = memory = Memory(shape=2 * self._pixel.size, depth=self._depth, init=[])
        write = memory.write_port()
        read = memory.read_port()
        x = Signal(range(self._depth + 1))
        y = Signal.like(self.height)
        self._write(m, write, x)

        # Comparisons have registers of their own: x and y hold still for at least two clocks.
        last_column = Signal()
        last_row = Signal()
        m.d.sync += [
            last_column.eq(x + 1 == self.width),
            last_row.eq(y + 1 == self.height),
            self.complete.eq(y == self.height),
        ]
        m.d.comb += read.addr.eq(x)
        # Three clocks a pair: the serial port is far slower.
        with m.FSM():
            with m.State("IDLE"), m.If(self.feed):
                m.next = "READ"
            with m.State("READ"):
                m.d.comb += self.busy.eq(1)
                m.next = "MARK"
            with m.State("MARK"):
                m.d.comb += self.busy.eq(1)
                m.d.sync += [
                    Cat(self.o.payload.left, self.o.payload.right).eq(read.data),
                    self.o.payload.sof.eq((x == 0) & (y == 0)),
                    self.o.payload.eol.eq(last_column),
                    self.o.payload.eof.eq(last_column & last_row),
                ]
                m.next = "OFFER"
            with m.State("OFFER"):
                m.d.comb += [self.busy.eq(1), self.o.valid.eq(1)]
                with m.If(self.o.ready):
                    m.d.sync += x.eq(Mux(last_column, 0, x + 1))
                    m.next = "READ"
                    with m.If(last_column):
                        m.d.sync += y.eq(y + 1)
                        m.next = "IDLE"
        with m.If(self.begin):
            m.d.sync += y.eq(0)
        return m

    def _write(self, m: Module, write: WritePort, x: Signal) -> None:
        """Gathers bytes into a pair, which is written when its last byte arrives."""
        pixel = self._pixel
        count = pair_bytes(pixel)
        place = Signal(range(count))
        address = Signal(range(self._depth + 1))
        gathered = Signal(8 * (count - 1))
        whole = place == count - 1
        size, channels = 8 * pixel.channel_bytes, range(2 * pixel.channels)
        overtakes = self.busy & (address >= x)
        m.d.comb += [
            write.addr.eq(address),
            # Bits above a channel's own are 0, and dropped.
            write.data.eq(Cat(Cat(gathered, self.data).word_select(c, size)[: pixel.bits] for c in channels)),
            write.en.eq(self.valid & whole & ~overtakes & (address != self._depth)),
        ]
        with m.If(self.valid):
            m.d.sync += [
                gathered.eq(Cat(gathered[8:], self.data)),
                place.eq(Mux(whole, 0, place + 1)),
            ]
            with m.If(whole):
                m.d.sync += self.overrun.eq(self.overrun | overtakes)
                with m.If(address != self._depth):
                    m.d.sync += address.eq(address + 1)
        with m.If(self.close):
            m.d.sync += [place.eq(0), address.eq(0), self.overrun.eq(0)]
