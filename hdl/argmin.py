"""Argmin over fractions, compared exactly (Bobyr et al. 2021, step 5, eq. 11)."""

from amaranth.hdl import Cat, Module, Mux, Shape, ShapeLike, Signal, Value, ValueLike, unsigned
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out


def candidate_layout(num: ShapeLike, den: ShapeLike, indices: int) -> data.StructLayout:
    """A candidate: its cost ``num / den``, its index, and whether it is out of the running.

    A ``den`` of no bits stands for costs that are plain numbers.
    """
    return data.StructLayout({"num": num, "den": den, "index": range(indices), "excluded": 1})


class FractionMin(wiring.Component):
    """The better of two candidates: the smaller fraction, and the smaller index on a tie.

    ``a.num / a.den < b.num / b.den`` is decided as ``a.num * b.den < b.num * a.den``: two
    multiplications, no division, nothing rounded. An excluded candidate loses against any other.
    One pair a clock. Nothing but registers stands before and behind the multipliers, so that an FPGA's own,
    far from the logic, can take them in.

    Parameters
    ----------
    layout : of the candidates.
    halves : ``a`` and ``b`` come from the lower and the upper half of a range whose excluded
        candidates are all at its upper end. Indices then count within each half, and the result's
        has one bit more. This takes less logic: a tie is ``a``'s, and so is the exclusion.

    Members
    -------
    a, b : the candidates.
    o : the better one, ``latency`` clocks later.
    """

    latency = 3

    def __init__(self, layout: data.StructLayout, *, halves: bool = False) -> None:
        self._layout = layout
        self._halves = halves
        best = layout
        if halves:
            members = dict(layout.members)
            members["index"] = unsigned(Shape.cast(members["index"]).width + 1)
            best = data.StructLayout(members)
        super().__init__({"a": In(layout), "b": In(layout), "o": Out(best)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        entering_a, entering_b, a, b = (
            Signal(self._layout, name=name, reset_less=True)
            for name in ("entering_a", "entering_b", "a", "b")
        )
        best = Signal(self.o.shape(), reset_less=True)
        left: ValueLike
        right: ValueLike
        if len(self.a.den):
            shape = (a.num * b.den).shape()
            left = Signal(shape, reset_less=True)
            right = Signal(shape, reset_less=True)
            m.d.sync += [
                left.eq(entering_a.num * entering_b.den),
                right.eq(entering_b.num * entering_a.den),
            ]
        else:
            left, right = a.num, b.num
        # The sign of a difference comes straight out of a carry chain, a comparison does not.
        difference = Value.cast(right) - Value.cast(left)
        right_smaller = difference[-1]
        b_wins = Signal()
        index: ValueLike
        if self._halves:
            m.d.comb += b_wins.eq(right_smaller & ~b.excluded)
            index = Cat(Mux(b_wins, b.index, a.index), b_wins)
        else:
            b_better = right_smaller | ((right == left) & (b.index < a.index))
            m.d.comb += b_wins.eq(~b.excluded & (a.excluded | b_better))
            index = Mux(b_wins, b.index, a.index)
        m.d.sync += [
            entering_a.eq(self.a),
            entering_b.eq(self.b),
            a.eq(entering_a),
            b.eq(entering_b),
            best.num.eq(Mux(b_wins, b.num, a.num)),
            best.den.eq(Mux(b_wins, b.den, a.den)),
            best.excluded.eq(a.excluded & b.excluded),
            best.index.eq(index),
        ]
        m.d.comb += self.o.eq(best)
        return m


class ArgminTree(wiring.Component):
    """The best of many candidates that arrive together, one set a clock.

    Members
    -------
    i : the candidates, by ascending index: `candidate_layout` of one index. The excluded ones are the
        last.
    o : the best, `latency` clocks later, and its place.
    """

    def __init__(self, num: ShapeLike, den: ShapeLike, count: int) -> None:
        self._leaf = candidate_layout(num, den, 1)
        self._count = count
        self.latency = FractionMin.latency * (count - 1).bit_length()
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
                for stage in range(FractionMin.latency):
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

    Each level of a chain joins neighbours and halves the rate, so that no comparison feeds back
    into itself and all are pipelined.

    Members
    -------
    valid, last : a candidate is there, and it is the last of its sequence.
    i : the candidate.
    o : the best, `latency` clocks after the last.
    """

    def __init__(self, layout: data.StructLayout, count: int) -> None:
        self._layout = layout
        self._levels = (count - 1).bit_length()
        self.latency = FractionMin.latency * self._levels
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
            # An odd one out at the end meets an earlier one of its own sequence again, which is no harm.
            with m.If(valid):
                m.d.sync += [second.eq(~second & ~last), held.eq(current)]
            valid, last, current = emits, last, node.o
            for stage in range(FractionMin.latency):
                for_valid = Signal(name=f"valid_{level}_{stage}")
                for_last = Signal(name=f"last_{level}_{stage}", reset_less=True)
                m.d.sync += [for_valid.eq(valid), for_last.eq(last)]
                valid, last = for_valid, for_last
        m.d.comb += self.o.eq(current)
        return m
