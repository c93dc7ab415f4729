"""Where in its line a pixel is, and whether that is the line's last column."""

from amaranth.hdl import Module, Mux, Signal, Value


class LineColumn:
    """Counts columns; a register tells whether the next one is the last, as it was in the line before.

    Parameters
    ----------
    m : the module that this is part of.
    max_width : pixels of the longest line.

    Members
    -------
    x : the column that comes next.
    is_last : the line before ended with it.
    """

    def __init__(self, m: Module, max_width: int) -> None:
        self._m = m
        self.x = Signal(range(max_width))
        self.is_last = Signal(name="x_is_last")
        self._previous = Signal.like(self.x, name="previous_x")
        self._second_last = Signal.like(self.x, name="second_last_x")

    def step(self, last: Value) -> None:
        """Passes column ``x``, its line's ``last`` or not, where the conditions around this call hold."""
        x = self.x
        self._m.d.sync += [
            x.eq(Mux(last, 0, x + 1)),
            self._previous.eq(x),
            # A line of one column ends where it begins.
            self.is_last.eq(Mux(last, x == 0, x == self._second_last)),
        ]
        with self._m.If(last):
            self._m.d.sync += self._second_last.eq(self._previous)
