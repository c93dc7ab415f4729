"""Clock and reset of a board."""

from amaranth.hdl import ClockDomain, ClockSignal, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.cdc import ResetSynchronizer
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.plls import pll
from softdepth.spec.boards import Board

HOLD_CLOCKS = 256
"""Clocks of reset after the PLL has locked. iCE40 block RAM is not readable in the first microseconds."""


class Clocking(wiring.Component):
    """Makes a clock of ``board.core_hz``, and a reset that lasts until that clock is good.

    Parameters
    ----------
    board : gives the part and the oscillator.
    simulated : leave the PLL out: the oscillator's pin takes the core's clock itself.

    Members
    -------
    oscillator, button : the clock's pin; the reset button is pressed (asynchronous).
    clock, reset : for the domain ``sync``.
    """

    def __init__(self, board: Board, simulated: bool = False) -> None:
        self._board = board
        self._simulated = simulated
        super().__init__({"oscillator": In(1), "button": In(1), "clock": Out(1), "reset": Out(1, init=1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        board = self._board
        m.domains.waking = ClockDomain("waking")
        locked = Signal()
        if self._simulated or board.clock_hz == board.core_hz:
            m.d.comb += [self.clock.eq(self.oscillator), locked.eq(1)]
        else:
            m.submodules.pll = pll(board, self.oscillator, self.clock, locked)
        m.d.comb += ClockSignal("waking").eq(self.clock)
        m.submodules.release = ResetSynchronizer(~locked | self.button, domain="waking", stages=3)

        # The button bounces; each bounce restarts the wait.
        held = Signal(range(HOLD_CLOCKS))
        with m.If(held == HOLD_CLOCKS - 1):
            m.d.waking += self.reset.eq(0)
        with m.Else():
            m.d.waking += held.eq(held + 1)
        return m
