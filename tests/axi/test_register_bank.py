"""RegisterBank and Wishbone: all that the description says, and that a broken one is found out."""

import pytest

from softdepth.hdl.axi.register_bank import RegisterBank, word_bits
from softdepth.hdl.axi.wishbone import Wishbone
from softdepth.spec.registers import registers
from tests.axi.bank_check import check_bank
from tests.axi.runs import SMALL
from tests.support.mutations import mutated

REGISTERS = registers(SMALL)
CLOCKS = 2000


def test_each_clock_is_as_described() -> None:
    check_bank(REGISTERS, RegisterBank(REGISTERS), Wishbone(word_bits(REGISTERS)), clocks=CLOCKS)


@pytest.mark.parametrize(
    ("block", "old", "new", "said"),
    [
        (RegisterBank, "bit.replicate(8) for", "Const(0xFF, 8) for", " is 0x"),
        (RegisterBank, "bit.replicate(8) for bit in", "bit.replicate(8) for bit in ~", " is 0x"),
        (RegisterBank, "bus.write & (bus.write_word == word)", "Const(0)", " is 0x"),
        (RegisterBank, "bus.write & (bus.write_word == word)", "bus.write_word == word", " is 0x"),
        (RegisterBank, "(bus.write_word == word)", "(bus.write_word[:-1] == word)", " is 0x"),
        (RegisterBank, "with m.Case(word):", "with m.Case(word ^ 1):", "was read"),
        (RegisterBank, "m.d.sync += read.eq(0)", "pass", "was read"),
        (RegisterBank, "Const(field.reset, field.width)", "Const(0, field.width)", "was read"),
        (RegisterBank, "init=reset", "init=0", " is 0x"),
        (
            RegisterBank,
            "value & ~cleared | self.given[field.name]",
            "(value | self.given[field.name]) & ~cleared",
            " is 0x",
        ),
        (RegisterBank, "elif field.pulses:", "elif False:", " is 0x"),
        (RegisterBank, "if register.takeover:", "if not register.takeover:", "takeover"),
        (Wishbone, "self.cyc & self.stb", "self.stb", "ack"),
        (Wishbone, "self.cyc & self.stb", "self.cyc", "ack"),
        (Wishbone, " & ~ack", "", "ack"),
        (Wishbone, "begins & self.we", "self.cyc & self.stb & self.we", " is 0x"),
        (Wishbone, "begins & self.we", "begins", " is 0x"),
        (Wishbone, "bus.write_bytes.eq(self.sel)", "bus.write_bytes.eq(-1)", " is 0x"),
        (Wishbone, "bus.read_word.eq(self.adr)", "bus.read_word.eq(self.adr >> 1)", "was read"),
    ],
)
def test_a_broken_one_is_found_out(block: type, old: str, new: str, said: str) -> None:
    broken = mutated(block, old, new)
    bank = broken if block is RegisterBank else RegisterBank
    adapter = broken if block is Wishbone else Wishbone
    with pytest.raises(AssertionError, match=f"clock .*{said}"):
        check_bank(REGISTERS, bank(REGISTERS), adapter(word_bits(REGISTERS)), clocks=CLOCKS)
