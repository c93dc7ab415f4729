"""PLLs of the parts: the settings that make one clock from another, or why they cannot.

Limits are the vendors': Lattice FPGA-DS-02012 (ECP5) and FPGA-TN-02052 (iCE40), Gowin UG286 and DS226
(GW2AR). Where several settings make the wanted clock, the one with the fastest phase detector is taken,
which has the least jitter.
"""

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

from amaranth.hdl import Const, Instance, Signal

from softdepth.spec.boards import Board
from softdepth.spec.errors import ConfigError

MHZ = 1_000_000

ICE40_FILTERS = ((17, 1), (26, 2), (44, 3), (66, 4), (101, 5), (134, 6))
"""The loop filter by the phase detector's rate: below so many MHz."""


class Divisors(NamedTuple):
    """``out = in / reference * feedback``, and what divides the oscillator at ``in / reference * vco``."""

    reference: int
    feedback: int
    output: int


def ecp5_divisors(clock_hz: int, core_hz: int) -> Divisors:
    """EHXPLLL with the feedback from its output: ``VCO = out * output``; raises `ConfigError`."""
    found = (
        Divisors(reference, feedback, output)
        for reference, feedback in _ratios(clock_hz, core_hz, 128, 80)
        if 10 * MHZ <= clock_hz / reference <= 400 * MHZ and core_hz <= 400 * MHZ
        for output in range(1, 129)
        if 400 * MHZ <= core_hz * output <= 800 * MHZ
    )
    return _first("EHXPLLL", found, clock_hz, core_hz)


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
    return _first("SB_PLL40", found, clock_hz, core_hz)


def gowin_divisors(clock_hz: int, core_hz: int) -> Divisors:
    """rPLL with internal feedback: ``VCO = out * output``; raises `ConfigError`."""
    found = (
        Divisors(reference, feedback, output)
        for reference, feedback in _ratios(clock_hz, core_hz, 64, 64)
        if 3 * MHZ <= clock_hz / reference <= 500 * MHZ
        for output in (2, 4, 8, 16, 32, 48, 64, 80, 96, 112, 128)
        if 500 * MHZ <= core_hz * output <= 1250 * MHZ
    )
    return _first("rPLL", found, clock_hz, core_hz)


def pll(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    """The PLL of the board's part: `oscillator` becomes `clock`, of ``board.core_hz``, good when `locked`.

    Raises `ConfigError` where the part cannot make that clock.
    """
    return {"ecp5": _ecp5, "ice40": _ice40, "gowin": _gowin}[board.family](board, oscillator, clock, locked)


def _ecp5(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    found = ecp5_divisors(board.clock_hz, board.core_hz)
    return Instance(
        "EHXPLLL",
        a_FREQUENCY_PIN_CLKI=f"{board.clock_hz / MHZ:g}",
        a_FREQUENCY_PIN_CLKOP=f"{board.core_hz / MHZ:g}",
        a_ICP_CURRENT="12",
        a_LPF_RESISTOR="8",
        a_MFG_ENABLE_FILTEROPAMP="1",
        a_MFG_GMCREF_SEL="2",
        p_FEEDBK_PATH="CLKOP",
        p_CLKI_DIV=found.reference,
        p_CLKFB_DIV=found.feedback,
        p_CLKOP_DIV=found.output,
        p_CLKOP_ENABLE="ENABLED",
        p_CLKOP_CPHASE=found.output - 1,  # an edge of the output lies on an edge of the input
        p_CLKOP_FPHASE=0,
        p_OUTDIVIDER_MUXA="DIVA",
        i_CLKI=oscillator,
        i_CLKFB=clock,
        i_RST=Const(0),
        i_STDBY=Const(0),
        i_PHASESEL0=Const(0),
        i_PHASESEL1=Const(0),
        i_PHASEDIR=Const(1),
        i_PHASESTEP=Const(1),
        i_PHASELOADREG=Const(1),
        i_PLLWAKESYNC=Const(0),
        i_ENCLKOP=Const(0),
        o_CLKOP=clock,
        o_LOCK=locked,
    )


def _ice40(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    found = ice40_divisors(board.clock_hz, board.core_hz)
    phase_mhz = board.clock_hz / found.reference / MHZ
    return Instance(
        "SB_PLL40_PAD",  # the oscillator is on the PLL's own pad
        p_FEEDBACK_PATH="SIMPLE",
        p_DIVR=Const(found.reference - 1, 4),
        p_DIVF=Const(found.feedback - 1, 7),
        p_DIVQ=Const(found.output.bit_length() - 1, 3),
        p_FILTER_RANGE=Const(next(value for limit, value in ICE40_FILTERS if phase_mhz < limit), 3),
        i_PACKAGEPIN=oscillator,
        i_RESETB=Const(1),
        i_BYPASS=Const(0),
        o_PLLOUTGLOBAL=clock,
        o_LOCK=locked,
    )


def _gowin(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    found = gowin_divisors(board.clock_hz, board.core_hz)
    unused = {f"i_{name}": Const(0, 6) for name in ("IDSEL", "FBDSEL", "ODSEL")}
    unused |= {f"i_{name}": Const(0, 4) for name in ("PSDA", "DUTYDA", "FDLY")}
    return Instance(
        "rPLL",
        p_FCLKIN=f"{board.clock_hz / MHZ:g}",
        p_DEVICE="GW2A-18C",
        p_IDIV_SEL=found.reference - 1,
        p_FBDIV_SEL=found.feedback - 1,
        p_ODIV_SEL=found.output,
        p_DYN_IDIV_SEL="false",
        p_DYN_FBDIV_SEL="false",
        p_DYN_ODIV_SEL="false",
        p_DYN_DA_EN="false",
        p_PSDA_SEL="0000",
        p_DUTYDA_SEL="1000",
        p_CLKFB_SEL="internal",
        p_CLKOUT_BYPASS="false",
        p_CLKOUTP_BYPASS="false",
        p_CLKOUTD_BYPASS="false",
        p_DYN_SDIV_SEL=2,
        p_CLKOUTD_SRC="CLKOUT",
        p_CLKOUTD3_SRC="CLKOUT",
        i_CLKIN=oscillator,
        i_CLKFB=Const(0),
        i_RESET=Const(0),
        i_RESET_P=Const(0),
        **unused,
        o_CLKOUT=clock,
        o_LOCK=locked,
    )


def _ratios(clock_hz: int, core_hz: int, references: int, feedbacks: int) -> Iterator[tuple[int, int]]:
    """Exact pairs, the fastest phase detector first."""
    for reference in range(1, references + 1):
        feedback, rest = divmod(core_hz * reference, clock_hz)
        if not rest and 1 <= feedback <= feedbacks:
            yield reference, feedback


def _first(name: str, found: Iterator[Divisors], clock_hz: int, core_hz: int) -> Divisors:
    for divisors in found:
        return divisors
    raise ConfigError(
        f"the PLL {name} cannot make {core_hz / MHZ:g} MHz from the oscillator's {clock_hz / MHZ:g} MHz",
        "choose another clock for the core, for example the oscillator's",
    )
