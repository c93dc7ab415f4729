"""Serial receiver: a line to bytes, 8N1."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.cdc import FFSynchronizer
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.serial.transmitter import BYTE_BITS

MIN_DIVISOR = 4
"""Clocks per bit below which the middle of a bit cannot be found safely."""


class UartReceiver(wiring.Component):
    """Samples each bit of a byte in its middle, counted from the start bit's edge.

    A byte whose start bit is gone by its middle was a glitch, and is ignored.

    Parameters
    ----------
    divisor : clocks per bit, at least `MIN_DIVISOR`.

    Members
    -------
    rx : the line, asynchronous to the clock.
    valid, data, broken : a byte has come, in this clock only; ``broken``: its stop bit was missing.
    """

    def __init__(self, divisor: int) -> None:
        if divisor < MIN_DIVISOR:
            raise ValueError(f"divisor is {divisor}, but a receiver needs {MIN_DIVISOR} clocks per bit")
        self._divisor = divisor
        super().__init__({"rx": In(1, init=1), "valid": Out(1), "data": Out(BYTE_BITS), "broken": Out(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        line = Signal(init=1)
        m.submodules.synchronizer = FFSynchronizer(self.rx, line, init=1)
        timer = Signal(range(self._divisor))
        bits = Signal(range(BYTE_BITS))
        m.d.sync += [self.valid.eq(0), timer.eq(timer - 1)]
        middle = timer == 0
        with m.If(middle):
            m.d.sync += timer.eq(self._divisor - 1)

        with m.FSM():
            with m.State("IDLE"):
                # The line was found low in this clock: the start bit's middle is half a bit from here.
                m.d.sync += timer.eq(self._divisor // 2 - 1)
                with m.If(~line):
                    m.next = "START"
            with m.State("START"), m.If(middle):
                m.d.sync += bits.eq(0)
                with m.If(line):
                    m.next = "IDLE"
                with m.Else():
                    m.next = "DATA"
            with m.State("DATA"), m.If(middle):
                m.d.sync += [self.data.eq(Cat(self.data[1:], line)), bits.eq(bits + 1)]
                with m.If(bits == BYTE_BITS - 1):
                    m.next = "STOP"
            with m.State("STOP"), m.If(middle):
                m.d.sync += [self.valid.eq(1), self.broken.eq(~line)]
                with m.If(line):
                    m.next = "IDLE"
                with m.Else():
                    m.next = "BREAK"
            with m.State("BREAK"), m.If(line):  # a new byte begins with an edge, not with a low line
                m.next = "IDLE"
        return m
