"""The PLL of iCE40 (SB_PLL40), with limits after Lattice FPGA-TN-02052."""

from itertools import product

from amaranth.hdl import Const, Instance, Signal

from softdepth.hdl.boards.plls.divisors import MHZ, Divisors, first
from softdepth.spec.boards import Board

FILTERS = ((17, 1), (26, 2), (44, 3), (66, 4), (101, 5), (134, 6))
"""The loop filter for each rate of the phase detector: a rate in MHz, and the filter for rates below it."""


def ice40_divisors(clock_hz: int, core_hz: int) -> Divisors:
    """SB_PLL40 with simple feedback: ``VCO = in / reference * feedback``, ``out = VCO / output``."""
    found = (
        Divisors(reference, feedback, 2**q)
        for reference in range(1, 17)
        if 10 * MHZ <= clock_hz / reference <= 133 * MHZ
        for feedback, q in product(range(1, 129), range(1, 7))
        if 533 * MHZ <= clock_hz / reference * feedback <= 1066 * MHZ
        and clock_hz * feedback == core_hz * reference * 2**q
        and 16 * MHZ <= core_hz <= 275 * MHZ
    )
    return first("SB_PLL40", found, clock_hz, core_hz)


def ice40_pll(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    """The instance that makes ``board.core_hz`` on `clock` from `oscillator`; good when `locked`."""
    found = ice40_divisors(board.clock_hz, board.core_hz)
    phase_mhz = board.clock_hz / found.reference / MHZ
    return Instance(
        "SB_PLL40_PAD",  # the oscillator is on the PLL's own pad
        p_FEEDBACK_PATH="SIMPLE",
        p_DIVR=Const(found.reference - 1, 4),
        p_DIVF=Const(found.feedback - 1, 7),
        p_DIVQ=Const(found.output.bit_length() - 1, 3),
        p_FILTER_RANGE=Const(next(value for limit, value in FILTERS if phase_mhz < limit), 3),
        i_PACKAGEPIN=oscillator,
        i_RESETB=Const(1),
        i_BYPASS=Const(0),
        o_PLLOUTGLOBAL=clock,
        o_LOCK=locked,
    )
