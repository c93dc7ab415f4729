"""A state machine with a register for each state, and for each question about several states."""

from collections.abc import Iterator
from contextlib import contextmanager

from amaranth.hdl import Cat, Module, Signal


class States:
    """States by name, in registers of which one is set: what a state decides listens to one bit.

    A group is a register too: it tells whether the state is one of several. Conditions that decide where to
    go are written so that no two of them hold in one clock; where none does, the state stays.

    Parameters
    ----------
    m : the module whose state this is.
    names : of the states; it begins in the first.
    """

    def __init__(self, m: Module, *names: str) -> None:
        self._m = m
        self.at = {name: Signal(name=f"at_{name}", init=name == names[0]) for name in names}
        self._to = {name: Signal(name=f"to_{name}") for name in names}
        self._moves = Signal(name="moves")
        m.d.comb += self._moves.eq(Cat(*self._to.values()).any())
        with m.If(self._moves):
            m.d.sync += [self.at[name].eq(self._to[name]) for name in names]

    def group(self, *names: str) -> Signal:
        """A register that is set in these states."""
        signal = Signal(name="at_" + "_or_".join(names), init=any(self.at[name].init for name in names))
        with self._m.If(self._moves):
            self._m.d.sync += signal.eq(Cat(*(self._to[name] for name in names)).any())
        return signal

    @contextmanager
    def state(self, name: str) -> Iterator[None]:
        """What is done in this state."""
        with self._m.If(self.at[name]):
            yield

    def go(self, name: str) -> None:
        """The state of the next clock, where the conditions around hold."""
        self._m.d.comb += self._to[name].eq(1)
