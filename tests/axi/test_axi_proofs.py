"""Proofs of the AXI edge: answers and results stay on offer, registers give what was written."""

from pathlib import Path
from typing import Any

import pytest
from amaranth.hdl import (
    Array,
    Assert,
    Assume,
    Cat,
    ClockDomain,
    ClockSignal,
    Const,
    Module,
    Mux,
    Signal,
    Value,
)
from amaranth.lib import wiring
from amaranth.lib.wiring import Component, In

from softdepth.hdl.axi.axi_lite import AxiLite, axi_lite
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.axi.pair_sync import PairSync
from softdepth.hdl.axi.register_bank import RegisterBank, word_bits
from softdepth.spec.registers import WORD_BITS, Register, registers
from tests.axi.runs import SMALL
from tests.support.claims import Claim
from tests.support.mutations import mutated
from tests.support.proofs import every_run, proof, some_clocks
from tests.support.simulation import config, sad

pytestmark = pytest.mark.formal

REGISTERS = registers(SMALL)
EVERYTHING = (1 << WORD_BITS) - 1

ANSWERS = Claim(
    "an AXI4-Lite write and a read have one answer each, which stands unchanged until it is taken; a register"
    " gives what was written last, byte for byte, or its constant, and an address without one gives 0",
    sizes="the registers of a core without a border band, fields that the core gives left out",
    depth="every run",
)
JOINED = Claim(
    "a pair of pixels of two streams that is on offer stands unchanged until it is taken, whatever the marks",
    sizes="1 bit, a skew of 2 pixels",
    depth="every run",
)
STANDS = Claim(
    "a result of the core with AXI streams that is on offer stands unchanged until it is taken, whatever"
    " comes in and is written to registers",
    sizes="two candidates, any markers; the first results come within the depth",
    depth="22 clocks, at full depth 30 clocks",
)


def fixed(register: Register | None, *, written: bool) -> int:
    """The bits of a word that only software writes, or with those that never change."""
    if register is None:
        return 0 if written else EVERYTHING
    bits = 0 if written else EVERYTHING
    for field in register.fields:
        mask = (1 << field.width) - 1 << field.low
        plain = field.writable and not field.sticky and not field.pulses
        if plain:
            bits |= mask
        elif not written and (field.given or field.sticky):
            bits &= ~mask
    return bits


class Registers(Component):
    """`AxiLite` and `RegisterBank` beside one word, whichever, that is kept plainly."""

    def __init__(self, adapter: type = AxiLite, bank: type = RegisterBank) -> None:
        self._bits = word_bits(REGISTERS)
        self._bus, self._bank = adapter(self._bits), bank(REGISTERS)
        inputs = {name: member for name, member in axi_lite(self._bits).items() if member.flow is In}
        given = len(Value.cast(self._bank.given))
        super().__init__({**inputs, "given": In(given), "some_word": In(self._bits)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.bus, m.submodules.bank = bus, bank = self._bus, self._bank
        wiring.connect(m, bus.bus, bank.bus)
        m.d.comb += Value.cast(bank.given).eq(self.given)
        m.d.comb += [getattr(bus, name).eq(getattr(self, name)) for name in self._inputs()]

        known, kept = Signal(), Signal(self._bits)
        word = Mux(known, kept, self.some_word)
        m.d.sync += [known.eq(1), kept.eq(word)]
        words = {register.address * 8 // WORD_BITS: register for register in REGISTERS}

        def of_word(values: dict[int, int], default: int) -> Value:
            return Array(Const(values.get(k, default), WORD_BITS) for k in range(1 << self._bits))[word]

        mine = of_word({k: fixed(each, written=True) for k, each in words.items()}, 0)
        sure = of_word({k: fixed(each, written=False) for k, each in words.items()}, EVERYTHING)
        resets = {
            k: sum(0 if f.pulses or f.given else f.reset << f.low for f in each.fields)
            for k, each in words.items()
        }
        held, expected, asked = Signal(WORD_BITS), Signal(WORD_BITS), Signal()
        now = Signal(WORD_BITS)
        m.d.comb += now.eq(Mux(known, held, of_word(resets, 0)))
        write, read = Signal(), Signal()
        m.d.comb += [
            write.eq(self.awvalid & bus.awready),
            read.eq(self.arvalid & bus.arready),
            Assert(write == (self.wvalid & bus.wready)),
        ]
        chosen = Signal(WORD_BITS)
        m.d.comb += chosen.eq(Cat(bit.replicate(8) for bit in self.wstrb) & mine)
        m.d.sync += held.eq(now)
        with m.If(write & (self.awaddr[-self._bits :] == word)):
            m.d.sync += held.eq(now & ~chosen | self.wdata & chosen)
        with m.If(read):
            m.d.sync += [expected.eq(now), asked.eq(self.araddr[-self._bits :] == word)]
        with m.If(bus.rvalid & asked):
            m.d.comb += Assert(((bus.rdata ^ expected) & sure) == 0)

        for happens, valid, ready, offered in (
            (write, bus.bvalid, self.bready, bus.bresp),
            (read, bus.rvalid, self.rready, Cat(bus.rresp, bus.rdata)),
        ):
            due, waited, before = Signal(2), Signal(), Signal(len(offered))
            m.d.sync += [
                due.eq(due + happens - (valid & ready)),
                waited.eq(valid & ~ready),
                before.eq(offered),
            ]
            m.d.comb += Assert(due == valid)
            with m.If(waited):
                m.d.comb += Assert(valid & (offered == before))
        return m

    def _inputs(self) -> list[str]:
        return [name for name, member in axi_lite(self._bits).items() if member.flow is In]


@ANSWERS.proven
def test_registers_give_what_was_written(tmp_path: Path) -> None:
    assert every_run(Registers(), tmp_path) == "every run"


BROKEN: dict[str, tuple[type, str, str]] = {
    "a read does not wait for the answer before": (AxiLite, "self.arvalid & ~self.rvalid", "self.arvalid"),
    "a write needs no data": (AxiLite, "self.awvalid & self.wvalid", "self.awvalid"),
    "a write's answer is withdrawn": (AxiLite, "with m.Elif(self.bready):", "with m.Else():"),
    "all bytes are written": (RegisterBank, "bit.replicate(8) for", "Const(0xFF, 8) for"),
    "other addresses give what was read before": (RegisterBank, "m.d.sync += read.eq(0)", "pass"),
    "addresses are not told apart": (
        RegisterBank,
        "(bus.write_word == word)",
        "(bus.write_word[:-1] == word)",
    ),
}


@ANSWERS.refuted
@pytest.mark.parametrize("fault", BROKEN)
def test_broken_registers_are_refuted(fault: str, tmp_path: Path) -> None:
    block, *texts = BROKEN[fault]
    broken = {"adapter" if block is AxiLite else "bank": mutated(block, *texts)}
    assert some_clocks(Registers(**broken), tmp_path, 8) == "refuted"


class Pairs(Component):
    """`PairSync` between streams of any pixels, which stand until they are taken."""

    left_valid: In(1)
    right_valid: In(1)
    left_payload: In(3)
    right_payload: In(3)
    by_count: In(1)
    between: In(1)
    clear: In(1)
    ready: In(1)

    def __init__(self, block: type = PairSync) -> None:
        self._block = block(1, skew=2, most_pixels=4)
        super().__init__()

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.block = block = self._block
        for side in ("left", "right"):
            i, valid = getattr(block, side), getattr(self, f"{side}_valid")
            payload = getattr(self, f"{side}_payload")
            waits, kept = Signal(name=f"{side}_waits"), Signal(3, name=f"{side}_kept")
            m.d.comb += [i.valid.eq(valid | waits), Value.cast(i.payload).eq(Mux(waits, kept, payload))]
            m.d.sync += [waits.eq(i.valid & ~i.ready), kept.eq(Value.cast(i.payload))]
        m.d.comb += [
            block.by_count.eq(self.by_count),
            block.between.eq(self.between),
            block.clear.eq(self.clear),
            block.o.ready.eq(self.ready),
        ]
        offered = Value.cast(block.o.payload)
        waited, before, was_between = Signal(), Signal(len(offered)), Signal()
        m.d.sync += [
            waited.eq(block.o.valid & ~self.ready),
            before.eq(offered),
            was_between.eq(self.between),
        ]
        with m.If(waited):  # nothing was taken: the next pair is where it was
            m.d.comb += [Assume(self.between == was_between), Assert(block.o.valid & (offered == before))]
        return m


@JOINED.proven
def test_a_pair_on_offer_stands(tmp_path: Path) -> None:
    assert proof(Pairs(), tmp_path) == "every run"


@JOINED.refuted
def test_a_pair_that_does_not_wait_is_refuted(tmp_path: Path) -> None:
    broken = mutated(PairSync, "lost.eq(taken & ~agree)", "lost.eq(~agree)")
    assert proof(Pairs(broken), tmp_path) == "refuted"


class Results(Component):
    """The core with AXI streams, all of whose inputs are free, and what its results do."""

    def __init__(self, block: type = AxiCore, *, fault: bool = False) -> None:
        tiny = config(
            cost="sum", pixel="gray8", disparities=2, lanes=2, criteria=[sad(3)], max_width=8, max_height=8
        )
        self._core, self._fault = block(tiny), fault
        members: dict[str, Any] = self._core.signature.members.items()
        self._free = {n: m for n, m in members if m.flow is In and n not in ("aclk", "aresetn")}
        super().__init__({**self._free, "clk": In(1), "rst": In(1)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.domains.look = ClockDomain(reset_less=True)  # the core makes a domain of its own
        m.submodules.core = core = self._core
        m.d.comb += [ClockSignal("look").eq(self.clk), core.aclk.eq(self.clk), core.aresetn.eq(~self.rst)]
        m.d.comb += [getattr(core, name).eq(getattr(self, name)) for name in self._free]
        ready, valid = self.m_axis_tready, core.m_axis_tvalid
        offered = Cat(core.m_axis_tdata, core.m_axis_tlast, core.m_axis_tuser)
        if self._fault:
            offered ^= Cat(self.s_axis_tvalid)
        waited, before = Signal(), Signal(len(offered))
        m.d.look += [waited.eq(valid & ~ready), before.eq(offered)]
        with m.If(waited):
            m.d.comb += Assert(valid & (offered == before))
        return m


@STANDS.proven
@pytest.mark.parametrize("clocks", [22, pytest.param(30, marks=pytest.mark.full)])
def test_results_on_offer_stand(clocks: int, tmp_path: Path) -> None:
    assert some_clocks(Results(), tmp_path, clocks) == "runs of some clocks"


@STANDS.refuted
def test_registers_that_act_at_once_are_refuted(tmp_path: Path) -> None:
    broken = mutated(AxiCore, "m.Elif(pending & ~frames.busy)", "m.Elif(pending)")
    assert some_clocks(Results(broken), tmp_path, 22) == "refuted"


@STANDS.refuted
def test_results_that_change_are_refuted(tmp_path: Path) -> None:
    assert some_clocks(Results(fault=True), tmp_path, 22) == "refuted"
