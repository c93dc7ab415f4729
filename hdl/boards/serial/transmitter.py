"""Serial transmitter: bytes to a line, 8N1."""

from amaranth.hdl import Cat, Const, Module, Signal
from amaranth.lib import stream, wiring
from amaranth.lib.wiring import In, Out

BYTE_BITS = 8


class UartTransmitter(wiring.Component):
    """Sends each byte as a start bit, eight data bits, lowest first, and a stop bit.

    Parameters
    ----------
    divisor : clocks per bit.

    Members
    -------
    i : stream of bytes; ready while the line is idle.
    tx : the line, high when idle.
    """

    def __init__(self, divisor: int) -> None:
        self._divisor = divisor
        super().__init__({"i": In(stream.Signature(BYTE_BITS)), "tx": Out(1, init=1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        shift = Signal(BYTE_BITS + 2, init=-1)
        left = Signal(range(BYTE_BITS + 3))  # bits to send, the present one included
        timer = Signal(range(self._divisor))
        m.d.comb += self.i.ready.eq(left == 0)
        m.d.sync += self.tx.eq(shift[0])
        with m.If(self.i.valid & self.i.ready):
            m.d.sync += [
                shift.eq(Cat(Const(0, 1), self.i.payload, Const(1, 1))),
                left.eq(BYTE_BITS + 2),
                timer.eq(self._divisor - 1),
            ]
        with m.Elif(timer != 0):
            m.d.sync += timer.eq(timer - 1)
        with m.Elif(left != 0):
            m.d.sync += [
                shift.eq(Cat(shift[1:], Const(1, 1))),
                left.eq(left - 1),
                timer.eq(self._divisor - 1),
            ]
        return m
