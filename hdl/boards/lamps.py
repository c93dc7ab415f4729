"""LEDs that a person can read: a blink, and short events made longer."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

BLINKS_PER_SECOND = 1
FLASHES_PER_SECOND = 8


class Lamps(wiring.Component):
    """The five signals of `softdepth.hdl.boards.wiring.Lamp`.

    Parameters
    ----------
    clock_hz : frequency of the clock.

    Members
    -------
    receiving_now, troubled_now : events, a clock long; each lights its lamp for about an eighth of a second.
    active, fault : levels, shown as they are.
    alive, locked, receiving, busy, error : high is lit.
    """

    def __init__(self, clock_hz: int) -> None:
        self._clock_hz = clock_hz
        inputs = ("receiving_now", "troubled_now", "active", "fault")
        outputs = ("alive", "locked", "receiving", "busy", "error")
        super().__init__({**dict.fromkeys(inputs, In(1)), **dict.fromkeys(outputs, Out(1))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        flash = self._clock_hz // FLASHES_PER_SECOND
        timer = Signal(range(flash))
        parts = FLASHES_PER_SECOND // BLINKS_PER_SECOND
        part = Signal(range(parts))
        due = Signal()
        m.d.comb += [
            due.eq(timer == flash - 1),
            self.alive.eq(part < parts // 2),
            self.locked.eq(1),  # in reset nothing of this is lit: see the top
            self.busy.eq(self.active),
        ]
        m.d.sync += timer.eq(timer + 1)
        with m.If(due):
            m.d.sync += [timer.eq(0), part.eq(part + 1)]
        for event, lamp, level in (
            (self.receiving_now, self.receiving, 0),
            (self.troubled_now, self.error, self.fault),
        ):
            left = Signal(2)
            m.d.comb += lamp.eq((left != 0) | level)
            with m.If(event):
                m.d.sync += left.eq(2)  # one whole part at least
            with m.Elif(due & (left != 0)):
                m.d.sync += left.eq(left - 1)
        return m
