"""How many words a memory holds, with a register for each thing that its two sides ask."""

from amaranth.hdl import Module, Signal, Value


class Level:
    """Counts words that come and go; whether there are any, and room for more, have registers of their own.

    ``comes`` and ``goes`` may be known late in a clock: they only choose, and pass through no sum.

    Parameters
    ----------
    m : the module that this is part of.
    most : words that there is room for.
    comes, goes : a word comes, or goes; ``comes`` never without ``room``, ``goes`` never without ``some``.

    Members
    -------
    some, room : there is a word, and there are fewer than ``most``.
    """

    def __init__(self, m: Module, most: int, comes: Value, goes: Value) -> None:
        held = Signal(range(most + 1), name="held")
        self.some, self.room = Signal(name="some"), Signal(name="room", init=1)
        with m.If(comes & ~goes):
            m.d.sync += [held.eq(held + 1), self.some.eq(1), self.room.eq(held != most - 1)]
        with m.If(goes & ~comes):
            m.d.sync += [held.eq(held - 1), self.some.eq(held != 1), self.room.eq(1)]
