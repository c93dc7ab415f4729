"""Turns Wishbone transfers into accesses to a register bank."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.axi.register_bank import LANES, access
from softdepth.spec.registers import WORD_BITS


def wishbone(word_bits: int) -> dict[str, wiring.Member]:
    """The ports of a classic Wishbone B4 target; ``adr`` counts words."""
    return {
        "cyc": In(1),
        "stb": In(1),
        "we": In(1),
        "adr": In(word_bits),
        "sel": In(LANES),
        "dat_w": In(WORD_BITS),
        "dat_r": Out(WORD_BITS),
        "ack": Out(1),
    }


class Wishbone(wiring.Component):
    """Answers each access a clock after it arrives: one every two clocks.

    Members
    -------
    cyc ... ack : Wishbone.
    bus : accesses to the bank.
    """

    def __init__(self, word_bits: int) -> None:
        super().__init__({**wishbone(word_bits), "bus": Out(access(word_bits))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus = self.bus
        begins = Signal()
        ack = Signal()
        m.d.sync += ack.eq(begins)
        m.d.comb += [
            begins.eq(self.cyc & self.stb & ~ack),
            self.ack.eq(ack),
            self.dat_r.eq(bus.read_data),
            bus.write.eq(begins & self.we),
            bus.write_word.eq(self.adr),
            bus.write_bytes.eq(self.sel),
            bus.write_data.eq(self.dat_w),
            bus.read.eq(begins & ~self.we),
            bus.read_word.eq(self.adr),
        ]
        return m
