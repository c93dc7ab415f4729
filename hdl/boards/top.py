"""The top of every board: clock, core behind the serial port, LEDs."""

from amaranth.hdl import Cat, ClockDomain, ClockSignal, Module, ResetSignal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.boards.clocking import Clocking
from softdepth.hdl.boards.lamps import Lamps
from softdepth.hdl.boards.link import SerialCore
from softdepth.hdl.boards.plls.divisors import MHZ
from softdepth.hdl.boards.serial.receiver import MIN_DIVISOR
from softdepth.hdl.boards.wiring import WIRING
from softdepth.spec.boards import Board
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError
from softdepth.spec.protocol import describe

MAX_RATE_ERROR = 0.015
"""How far the line's rate may be off: half a bit in ten, shared between both ends, with some to spare."""


def line_divisor(board: Board) -> int:
    """Clocks per bit of the serial line; raises `ConfigError` if the clock cannot make its rate."""
    divisor = round(board.core_hz / board.baud)
    if divisor < MIN_DIVISOR or abs(board.core_hz / divisor / board.baud - 1) > MAX_RATE_ERROR:
        raise ConfigError(
            f"{board.name}: a clock of {board.core_hz / MHZ:g} MHz cannot make {board.baud} baud",
            f"use a rate that divides the clock by {MIN_DIVISOR} or more",
        )
    return divisor


class BoardTop(wiring.Component):
    """What goes into the FPGA of a board. Ports are named as in its file in ``constraints/``.

    Parameters
    ----------
    board : the board.
    config : the core's configuration.
    revision : what the board says it was built from, for example a version and a git revision.
    simulated : leave the PLL out: ``clk`` is then the core's clock. Everything else is as on the board.

    Members
    -------
    clk : the oscillator.
    rx, tx : serial line, into the FPGA and out of it.
    button : resets the core, on boards that have one.
    led : see `softdepth.hdl.boards.wiring`.

    Further pins are held high where the board needs it. Raises `ConfigError` if the part cannot make the
    core's clock, or if that clock cannot make the serial line's rate.
    """

    def __init__(self, board: Board, config: Config, revision: str = "", *, simulated: bool = False) -> None:
        self._board = board
        self._wiring = WIRING[board.constraints]
        self._clocking = Clocking(board, simulated)
        self._core = SerialCore(config, line_divisor(board), describe(config, board.name, revision))
        button = {} if self._wiring.button_pressed is None else {"button": In(1)}
        super().__init__(
            {
                "clk": In(1),
                "rx": In(1, init=1),
                "tx": Out(1, init=1),
                "led": Out(len(self._wiring.lamps)),
                **button,
                **{name: Out(1) for name in self._wiring.high},
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.domains.sync = ClockDomain("sync")
        m.submodules.clocking = clocking = self._clocking
        m.submodules.core = core = self._core
        m.submodules.lamps = lamps = Lamps(self._board.core_hz)
        if self._wiring.button_pressed is not None:
            m.d.comb += clocking.button.eq(self.button == self._wiring.button_pressed)
        lit = Cat(getattr(lamps, name) & ~ResetSignal("sync") for name in self._wiring.lamps)
        m.d.comb += [
            clocking.oscillator.eq(self.clk),
            ClockSignal("sync").eq(clocking.clock),
            ResetSignal("sync").eq(clocking.reset),
            core.rx.eq(self.rx),
            self.tx.eq(core.tx),
            lamps.receiving_now.eq(core.receiving),
            lamps.troubled_now.eq(core.troubled),
            lamps.active.eq(core.active),
            lamps.fault.eq(core.fault),
            self.led.eq(lit if self._wiring.lamp_on else ~lit),
            *[getattr(self, name).eq(1) for name in self._wiring.high],
        ]
        return m
