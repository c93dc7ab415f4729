"""A counter down to 0, with registers for the questions about it."""

from amaranth.hdl import Module, Signal


class Countdown:
    """Counts what is still to come. Whether there is any, and whether it is the last, are registers.

    So nothing is compared between the count and its users: each looks at one bit.

    Parameters
    ----------
    m : the module that this is part of.
    most : that it counts from.
    init : what is to come after a reset.

    Members
    -------
    left : still to come, the present one included.
    some, last : whether that is not 0, and whether it is 1.
    """

    def __init__(self, m: Module, most: int, name: str, *, init: int = 0) -> None:
        self._m, self._most = m, most
        self.left = Signal(range(most + 1), name=name, init=init)
        self.some = Signal(name=f"{name}_some", init=init != 0)
        self.last = Signal(name=f"{name}_last", init=init == 1)

    def start(self, count: int) -> None:
        """Where the conditions around hold, there are ``count`` to come."""
        if count > self._most:
            raise ValueError(f"a countdown from {count} was built for {self._most} at most")
        self._m.d.sync += [self.left.eq(count), self.some.eq(count != 0), self.last.eq(count == 1)]

    def step(self) -> None:
        """Where the conditions around hold, one fewer; never of none."""
        self._m.d.sync += [
            self.left.eq(self.left - 1),
            self.some.eq(~self.last),
            self.last.eq(self.left == 2),
        ]
