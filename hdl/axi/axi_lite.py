"""Turns AXI4-Lite transfers into accesses to a register bank."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.axi.register_bank import LANES, access
from softdepth.spec.registers import WORD_BITS

OKAY = 0
BYTE_BITS = (LANES - 1).bit_length()


def axi_lite(word_bits: int) -> dict[str, wiring.Member]:
    """The ports of a subordinate, as the AXI specification names them."""
    address = word_bits + BYTE_BITS
    return {
        "awaddr": In(address),
        "awprot": In(3),
        "awvalid": In(1),
        "awready": Out(1),
        "wdata": In(WORD_BITS),
        "wstrb": In(LANES),
        "wvalid": In(1),
        "wready": Out(1),
        "bresp": Out(2),
        "bvalid": Out(1),
        "bready": In(1),
        "araddr": In(address),
        "arprot": In(3),
        "arvalid": In(1),
        "arready": Out(1),
        "rdata": Out(WORD_BITS),
        "rresp": Out(2),
        "rvalid": Out(1),
        "rready": In(1),
    }


class AxiLite(wiring.Component):
    """Handles one write and one read at a time; a write starts once its address and data are both valid.

    The response comes a clock later and is always OKAY. One write and one read every two clocks. ``prot``
    is ignored. Nothing is accepted during reset.

    Members
    -------
    awaddr ... rready : AXI4-Lite.
    bus : accesses to the bank.
    """

    def __init__(self, word_bits: int) -> None:
        super().__init__({**axi_lite(word_bits), "bus": Out(access(word_bits))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus = self.bus
        # Set by the first clock after reset; `ready` is low until then.
        awake = Signal()
        m.d.sync += awake.eq(1)
        write = Signal()
        read = Signal()
        m.d.comb += [
            write.eq(awake & self.awvalid & self.wvalid & ~self.bvalid),
            read.eq(awake & self.arvalid & ~self.rvalid),
            self.awready.eq(write),
            self.wready.eq(write),
            self.arready.eq(read),
            self.bresp.eq(OKAY),
            self.rresp.eq(OKAY),
            bus.write.eq(write),
            bus.write_word.eq(self.awaddr[BYTE_BITS:]),
            bus.write_bytes.eq(self.wstrb),
            bus.write_data.eq(self.wdata),
            bus.read.eq(read),
            bus.read_word.eq(self.araddr[BYTE_BITS:]),
            self.rdata.eq(bus.read_data),
        ]
        answered = Signal()
        known = Signal()
        m.d.comb += [self.bvalid.eq(answered), self.rvalid.eq(known)]
        with m.If(write):
            m.d.sync += answered.eq(1)
        with m.Elif(self.bready):
            m.d.sync += answered.eq(0)
        with m.If(read):
            m.d.sync += known.eq(1)
        with m.Elif(self.rready):
            m.d.sync += known.eq(0)
        return m
