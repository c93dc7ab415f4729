"""The PLL of Gowin's GW2A parts (rPLL), with limits after Gowin UG286 and DS226."""

from amaranth.hdl import Const, Instance, Signal

from softdepth.hdl.boards.plls.divisors import MHZ, Divisors, first, ratios
from softdepth.spec.boards import Board, gowin_die


def gowin_divisors(clock_hz: int, core_hz: int) -> Divisors:
    """rPLL with internal feedback: ``VCO = out * output``; raises `ConfigError`."""
    found = (
        Divisors(reference, feedback, output)
        for reference, feedback in ratios(clock_hz, core_hz, 64, 64)
        if 3 * MHZ <= clock_hz / reference <= 500 * MHZ
        for output in (2, 4, 8, 16, 32, 48, 64, 80, 96, 112, 128)
        if 500 * MHZ <= core_hz * output <= 1250 * MHZ
    )
    return first("rPLL", found, clock_hz, core_hz)


def gowin_pll(board: Board, oscillator: Signal, clock: Signal, locked: Signal) -> Instance:
    """The instance that makes ``board.core_hz`` on `clock` from `oscillator`; good when `locked`."""
    found = gowin_divisors(board.clock_hz, board.core_hz)
    unused = {f"i_{name}": Const(0, 6) for name in ("IDSEL", "FBDSEL", "ODSEL")}
    unused |= {f"i_{name}": Const(0, 4) for name in ("PSDA", "DUTYDA", "FDLY")}
    return Instance(
        "rPLL",
        p_FCLKIN=f"{board.clock_hz / MHZ:g}",
        p_DEVICE=gowin_die(board.device),
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
