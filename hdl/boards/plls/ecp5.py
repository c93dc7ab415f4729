"""The PLL of ECP5 (EHXPLLL), with limits after Lattice FPGA-DS-02012."""

from amaranth.hdl import Const, Instance, Signal

from softdepth.hdl.boards.plls.divisors import MHZ, Divisors, first, ratios
from softdepth.spec.boards import Board


def ecp5_divisors(clock_hz: int, core_hz: int) -> Divisors:
    """EHXPLLL with the feedback from its output: ``VCO = out * output``; raises `ConfigError`."""
    found = (
        Divisors(reference, feedback, output)
        for reference, feedback in ratios(clock_hz, core_hz, 128, 80)
        if 10 * MHZ <= clock_hz / reference <= 400 * MHZ and core_hz <= 400 * MHZ
        for output in range(1, 129)
        if 400 * MHZ <= core_hz * output <= 800 * MHZ
    )
    return first("EHXPLLL", found, clock_hz, core_hz)


def ecp5_pll(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    """The instance that makes ``board.core_hz`` on `clock` from `oscillator`; good when `locked`."""
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
