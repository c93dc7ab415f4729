"""Argmin over fractions, compared exactly (Bobyr et al. 2021, step 5, eq. 11)."""

from amaranth.hdl import Cat, Module, Mux, Shape, ShapeLike, Signal, Value, ValueLike, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out


def candidate_layout(num: ShapeLike, den: ShapeLike, indices: int) -> data.StructLayout:
    """A candidate: its cost ``num / den``, its index, and whether it is out of the running.

    A ``den`` without bits means that costs are plain numbers.
    """
    return data.StructLayout({"num": num, "den": den, "index": range(indices), "excluded": 1})


def latency(layout: data.StructLayout) -> int:
    """Clocks that `FractionMin` takes for candidates of this layout."""
    return 4 if Shape.cast(layout.members["den"]).width else 2


class FractionMin(wiring.Component):
    """The better of two candidates: the smaller fraction, and the smaller index on a tie.

    ``a.num / a.den < b.num / b.den`` is decided as ``a.num * b.den < b.num * a.den``: two
    multiplications, no division, nothing rounded. An excluded candidate loses against any other.
    One pair a clock. The multipliers are far from the logic and have registers of their own, so there are
    only registers directly before and after them: one clock each for the way there, the products, the
    comparison and the choice. Plain numbers need only the last two.

    Parameters
    ----------
    layout : of the candidates.
    halves : ``a`` and ``b`` come from the lower and the upper half of a range whose excluded
        candidates are all at its upper end. Indices then count within each half, and the result's index
        has one bit more. This takes less logic: ``a`` wins ties, and ``b`` is excluded wherever ``a`` is.

    Members
    -------
    a, b : the candidates.
    o : the better one, `latency` clocks later.
    early : the same a clock earlier, straight from the choice and not from a register.
    """

    def __init__(self, layout: data.StructLayout, *, halves: bool = False) -> None:
        self._layout = layout
        self._halves = halves
        best = layout
        if halves:
            members = dict(layout.members)
            members["index"] = unsigned(Shape.cast(members["index"]).width + 1)
            best = data.StructLayout(members)
        self.latency = latency(layout)
        super().__init__({"a": In(layout), "b": In(layout), "o": Out(best), "early": Out(best)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        # The candidates in each clock, until one of them is chosen.
        clocks: list[tuple[data.View, data.View]] = [(self.a, self.b)]
        for clock in range(1, self.latency):
            a, b = (Signal(self._layout, name=f"{name}_{clock}", reset_less=True) for name in "ab")
            m.d.sync += [a.eq(clocks[-1][0]), b.eq(clocks[-1][1])]
            clocks.append((a, b))
        compared, (a, b) = clocks[-2:]

        left, right = (Value.cast(candidate.num) for candidate in compared)
        if len(self.a.den):
            operand_a, operand_b = clocks[1]
            products = operand_a.num * operand_b.den, operand_b.num * operand_a.den
            left, right = (
                Signal(products[0].shape(), name=name, reset_less=True) for name in ("left", "right")
            )
            m.d.sync += [left.eq(products[0]), right.eq(products[1])]
        # The sign of a difference comes straight out of a carry chain, a comparison does not.
        right_smaller = (right - left)[-1]
        wins: ValueLike
        if self._halves:
            wins = right_smaller & ~compared[1].excluded
        else:
            b_better = right_smaller | ((right == left) & (compared[1].index < compared[0].index))
            wins = ~compared[1].excluded & (compared[0].excluded | b_better)
        b_wins = Signal(reset_less=True)
        best = Signal(self.o.shape(), reset_less=True)
        index = Mux(b_wins, b.index, a.index)
        m.d.sync += [b_wins.eq(wins), best.eq(self.early)]
        m.d.comb += [
            self.early.num.eq(Mux(b_wins, b.num, a.num)),
            self.early.den.eq(Mux(b_wins, b.den, a.den)),
            self.early.excluded.eq(a.excluded & b.excluded),
            self.early.index.eq(Cat(index, b_wins) if self._halves else index),
            self.o.eq(best),
        ]
        return m


class ArgminTree(wiring.Component):
    """The best of many candidates that arrive together, one set a clock.

    Members
    -------
    i : the candidates, by ascending index: `candidate_layout` of one index. The excluded ones come
        last.
    o : the best, `latency` clocks later, and its place.
    """

    def __init__(self, num: ShapeLike, den: ShapeLike, count: int) -> None:
        self._leaf = candidate_layout(num, den, 1)
        self._count = count
        self.latency = latency(self._leaf) * (count - 1).bit_length()
        super().__init__(
            {"i": In(data.ArrayLayout(self._leaf, count)), "o": Out(candidate_layout(num, den, count))}
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        level: list[data.View] = [self.i[k] for k in range(self._count)]
        while len(level) > 1:
            following: list[data.View] = []
            for k in range(0, len(level) - 1, 2):
                node = FractionMin(level[k].shape(), halves=True)
                m.submodules[f"node_{len(level)}_{k}"] = node
                m.d.comb += [node.a.eq(level[k]), node.b.eq(level[k + 1])]
                following.append(node.o)
            if len(level) % 2:
                # The last one has no rival on this level: it is the lower half of its range.
                waiting = level[-1]
                for stage in range(latency(self._leaf)):
                    register = Signal(
                        following[0].shape(), name=f"wait_{len(level)}_{stage}", reset_less=True
                    )
                    m.d.sync += [register[name].eq(waiting[name]) for name in self._leaf.members]
                    waiting = register
                following.append(waiting)
            level = following
        m.d.comb += [self.o[name].eq(level[0][name]) for name in self._leaf.members]
        return m


class ArgminSequence(wiring.Component):
    """The best of ``count`` candidates that arrive one after the other.

    Each level of a chain joins neighbours and halves the rate. So no comparison feeds back into
    itself, and all are pipelined.

    Members
    -------
    valid, last : a candidate is there, and it is the last of its sequence.
    i : the candidate.
    o : the best, `latency` clocks after the last.
    """

    def __init__(self, layout: data.StructLayout, count: int) -> None:
        self._layout = layout
        self._levels = (count - 1).bit_length()
        self.latency = latency(layout) * self._levels
        super().__init__({"valid": In(1), "last": In(1), "i": In(layout), "o": Out(layout)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        valid, last, current = self.valid, self.last, self.i
        for level in range(self._levels):
            m.submodules[f"node_{level}"] = node = FractionMin(self._layout)
            held = Signal(self._layout, name=f"held_{level}", reset_less=True)
            second = Signal(name=f"second_{level}")
            emits = Signal(name=f"emits_{level}")
            m.d.comb += [
                emits.eq(valid & (second | last)),
                node.a.eq(held),
                node.b.eq(current),
            ]
            # An odd last candidate meets an earlier one of its own sequence again, which is harmless.
            with m.If(valid):
                m.d.sync += [second.eq(~second & ~last), held.eq(current)]
            valid, last, current = emits, last, node.o
            for stage in range(latency(self._layout)):
                for_valid = Signal(name=f"valid_{level}_{stage}")
                for_last = Signal(name=f"last_{level}_{stage}", reset_less=True)
                m.d.sync += [for_valid.eq(valid), for_last.eq(last)]
                valid, last = for_valid, for_last
        m.d.comb += self.o.eq(current)
        return m
