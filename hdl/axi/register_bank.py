"""The registers of a description, between a bus and the core."""

from collections.abc import Sequence

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.spec.registers import WORD_BITS, Register

LANES = WORD_BITS // 8
"""Bytes of a word; each can be written on its own."""


def access(address_bits: int) -> wiring.Signature:
    """Accesses to the bank's words: at most one write and one read a clock.

    Members
    -------
    write, write_word, write_bytes, write_data : the chosen bytes of a word are written.
    read, read_word : a word is read; ``read_data`` follows a clock later, and holds.
    """
    return wiring.Signature(
        {
            "write": Out(1),
            "write_word": Out(address_bits),
            "write_bytes": Out(LANES),
            "write_data": Out(WORD_BITS),
            "read": Out(1),
            "read_word": Out(address_bits),
            "read_data": In(WORD_BITS),
        }
    )


def word_bits(registers: Sequence[Register]) -> int:
    """Bits needed to number the registers' words."""
    return (max(r.address for r in registers) // LANES).bit_length()


class RegisterBank(wiring.Component):
    """Holds what software writes, and shows it what the core reports. One write and one read a clock.

    Members
    -------
    bus : `access` from the bus's side.
    held : the fields that software writes, including sticky ones, by name; those that pulse are 1 for one
        clock.
    given : the fields whose values, or events, come from the core.
    takeover : in the clock before, a register was written that takes effect with the next frame.
    """

    def __init__(self, registers: Sequence[Register]) -> None:
        self._registers = registers
        fields = [field for register in registers for field in register.fields]
        self._bits = word_bits(registers)
        super().__init__(
            {
                "bus": In(access(self._bits)),
                "held": Out(data.StructLayout({f.name: f.width for f in fields if f.writable})),
                "given": In(data.StructLayout({f.name: f.width for f in fields if f.given})),
                "takeover": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        bus = self.bus
        takeover = Signal()
        m.d.sync += takeover.eq(0)
        m.d.comb += self.takeover.eq(takeover)
        mask = Cat(bit.replicate(8) for bit in bus.write_bytes)
        words: dict[int, Value] = {}
        for register in self._registers:
            word = register.address // LANES
            written = bus.write & (bus.write_word == word)
            if register.takeover:
                with m.If(written):
                    m.d.sync += takeover.eq(1)
            parts: list[Value] = []
            for field in register.fields:
                parts.append(Const(0, field.low - sum(map(len, parts))))
                span = slice(field.low, field.low + field.width)
                new, chosen = bus.write_data[span], mask[span]
                value = self._field(m, field.name, field.reset, field.width) if field.writable else None
                if value is None:
                    shown = self.given[field.name] if field.given else Const(field.reset, field.width)
                elif field.sticky:
                    cleared = Mux(written, new & chosen, 0)
                    m.d.sync += value.eq(value & ~cleared | self.given[field.name])
                    shown = value
                elif field.pulses:
                    m.d.sync += value.eq(Mux(written, new & chosen, 0))
                    shown = Const(0, field.width)
                else:
                    with m.If(written):
                        m.d.sync += value.eq(new & chosen | value & ~chosen)
                    shown = value
                parts.append(Value.cast(shown))
            words[word] = Cat(parts)
        read = Signal(WORD_BITS, reset_less=True)
        with m.If(bus.read), m.Switch(bus.read_word):
            for word, value in words.items():
                with m.Case(word):
                    m.d.sync += read.eq(value)
            with m.Default():
                m.d.sync += read.eq(0)
        m.d.comb += bus.read_data.eq(read)
        return m

    def _field(self, m: Module, name: str, reset: int, width: int) -> Signal:
        register = Signal(width, name=name, init=reset)
        m.d.comb += self.held[name].eq(register)
        return register
