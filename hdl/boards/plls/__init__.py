"""PLLs of the families: the settings that make one clock from another, or why there are none."""

from collections.abc import Callable

from amaranth.hdl import Instance, Signal

from softdepth.hdl.boards.plls.ecp5 import ecp5_pll
from softdepth.hdl.boards.plls.gowin import gowin_pll
from softdepth.hdl.boards.plls.ice40 import ice40_pll
from softdepth.spec.boards import Board

PLLS: dict[str, Callable[[Board, Signal, Signal, Signal], Instance]] = {
    "ecp5": ecp5_pll,
    "ice40": ice40_pll,
    "gowin": gowin_pll,
}


def pll(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    """The PLL of the board's part makes `clock`, of ``board.core_hz``, from `oscillator`; good when `locked`.

    Raises `ConfigError` if the part cannot make that clock.
    """
    return PLLS[board.family](board, oscillator, clock, locked)
