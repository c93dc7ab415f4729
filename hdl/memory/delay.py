"""A delay counted in enabled clocks."""

from amaranth.hdl import Module, Mux, ShapeLike, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

REGISTER_LIMIT = 16
"""Delays up to this depth are registers; longer ones are a ring in memory."""

DEEP, FEW = 16, 4
"""Places of a distributed RAM, and how many more are made registers rather than memory twice as deep."""

SHORT = 2
"""The depth up to which registers take no more than what reads a distributed RAM."""

CHAINED = 4 * DEEP
"""Delays up to this depth are a chain of distributed RAMs where no registers are to be used; longer ones may
be block RAM."""


class Delay(wiring.Component):
    """Delay a value by ``depth`` enabled clocks.

    In a clock with ``en`` high, ``o`` shows what ``i`` was ``depth`` enabled clocks before. Short
    delays are shift registers, long ones a memory ring (one write and one read port), which keeps
    the cost flat when few lanes serve many disparities. The contents are not reset.

    Parameters
    ----------
    shape : shape of the value.
    depth : enabled clocks; 0 is a wire.
    registers : whether to use registers, whatever the depth: where flip-flops are plentiful and lookup tables
        are not, or the reverse.
    """

    def __init__(self, shape: ShapeLike, depth: int, *, registers: bool | None = None) -> None:
        if depth < 0:
            raise ValueError(f"depth is {depth}, but a delay cannot look ahead")
        self._shape = shape
        self._depth = depth
        self._in_ram = registers is False
        self._chained = registers is False and DEEP < depth <= CHAINED
        self._in_registers = depth <= REGISTER_LIMIT if registers is None else registers or depth < 2
        super().__init__({"en": In(1), "i": In(shape), "o": Out(shape)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        if self._in_registers:
            value = self.i
            for k in range(self._depth):
                register = Signal(self._shape, name=f"tap_{k + 1}", reset_less=True)
                with m.If(self.en):
                    m.d.sync += register.eq(value)
                value = register
            m.d.comb += self.o.eq(value)
            return m

        beyond = self._depth % DEEP
        if self._chained:
            # Memory twice as deep would take as many lookup tables, and multiplexers as well.
            first = Delay(self._shape, DEEP, registers=False)
            then = Delay(self._shape, self._depth - DEEP, registers=self._depth - DEEP <= SHORT)
        elif self._depth > DEEP and beyond and beyond <= FEW:
            first = Delay(self._shape, self._depth - beyond, registers=False)
            then = Delay(self._shape, beyond)
        else:
            first = then = None
        if first and then:
            m.submodules.ring, m.submodules.rest = ring, rest = first, then
            m.d.comb += [
                ring.en.eq(self.en),
                rest.en.eq(self.en),
                ring.i.eq(self.i),
                rest.i.eq(ring.o),
                self.o.eq(rest.o),
            ]
            return m

        m.submodules.ring = ring = Memory(shape=self._shape, depth=self._depth, init=[])
        write = ring.write_port()
        read = ring.read_port()
        # The word that the next enabled clock takes must be there when that clock comes.
        written = Signal(range(self._depth))
        shown = Signal(range(self._depth), init=1 if self._in_ram else 0)
        m.d.comb += [
            write.en.eq(self.en),
            write.addr.eq(written),
            write.data.eq(self.i),
            read.addr.eq(shown),
            self.o.eq(read.data),
        ]
        if self._in_ram:
            # Nothing stands before a distributed RAM, whose word goes to registers in the same clock. Places
            # are counted apart from the address that many read, and where the ring closes is known early.
            place = Signal(range(self._depth), init=2 % self._depth)
            closes = Signal(init=2 % self._depth == self._depth - 1)
            m.d.comb += read.en.eq(self.en)
            with m.If(self.en):
                m.d.sync += [
                    written.eq(shown),
                    shown.eq(place),
                    place.eq(Mux(closes, 0, place + 1)),
                    closes.eq(place == self._depth - 2),
                ]
        else:
            # Block RAM reads in every clock: pausing it takes registers and multiplexers that hold its word.
            following = Mux(written == self._depth - 1, 0, written + 1)
            m.d.comb += [read.en.eq(1), shown.eq(Mux(self.en, following, written))]
            m.d.sync += written.eq(shown)
        return m


def delayed(m: Module, value: Value, clocks: int, name: str) -> Value:
    """``value`` after so many clocks, in registers without a reset."""
    value = Value.cast(value)
    for clock in range(1, clocks + 1):
        register = Signal(value.shape(), name=f"{name}_{clock}", reset_less=True)
        m.d.sync += register.eq(value)
        value = register
    return value


def waiting(m: Module, value: Value, clocks: int, name: str) -> Value:
    """``value`` after so many clocks, in distributed RAM: for many bits that wait for a long time."""
    value = Value.cast(value)
    m.submodules[f"waiting_{name}"] = wait = Delay(value.shape(), clocks, registers=False)
    m.d.comb += [wait.en.eq(1), wait.i.eq(value)]
    return wait.o
