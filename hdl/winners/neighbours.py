"""The costs beside a winner, and the best of those that are not beside it."""

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, travelling
from softdepth.hdl.arithmetic.word import Word
from softdepth.hdl.costs.layout import is_fraction
from softdepth.hdl.memory.delay import delayed
from softdepth.hdl.winners.least_fraction import LeastFraction

JOINED = 4
"""Lanes that are joined between two registers; at most one of them is not 0."""


class Neighbours(wiring.Component):
    """Looks at all costs of a pixel again when its winner is known.

    One step a clock. Each lane takes three comparisons for equality, one per candidate, a mask, and a node
    of the minimum, which is `FractionMin` where costs are fractions.

    Parameters
    ----------
    cost : of a candidate, ``num / den``.
    runner_up : whether the runner-up is wanted; else there is none.

    Members
    -------
    valid, first, last, step : a step is taken again.
    winner : the slot's, held through all steps.
    costs, excluded : of each lane's candidate, `costs_late` clocks after the step.
    below, above : costs of the candidates before and after the winner, `latency` clocks after the last
        step; 0 where there is none.
    has_below, has_above : there is one, and it is not excluded.
    runner_up : the smallest cost of those that are neither the winner nor beside it nor excluded.
    has_runner_up : there is one.
    """

    costs_late = 2

    def __init__(self, lanes: int, steps: int, cost: data.StructLayout, *, runner_up: bool = True) -> None:
        self._lanes, self._steps, self._cost, self._runner_up = lanes, steps, cost, runner_up
        self._tree = (lanes - 1).bit_length()
        self._joins = 0
        count = -(-lanes // 2)
        while count > 1:
            count = -(-count // JOINED)
            self._joins += 1
        if is_fraction(cost):
            self._least = LeastFraction(cost, lanes, steps) if runner_up else None
            least = self._least.latency if self._least else 0
            self.latency = self.costs_late + max(least, 1 + self._joins + 1)
        else:
            self.latency = self.costs_late + 1 + max(self._tree, self._joins) + 1
        super().__init__(
            {
                "valid": In(1),
                "first": In(1),
                "last": In(1),
                "step": In(range(steps)),
                "winner": In(range(lanes * steps)),
                "costs": In(data.ArrayLayout(cost, lanes)),
                "excluded": In(lanes),
                "below": Out(cost),
                "above": Out(cost),
                "has_below": Out(1),
                "has_above": Out(1),
                "runner_up": Out(cost),
                "has_runner_up": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        lanes, steps, bits = self._lanes, self._steps, self._cost.size
        # Lane k's candidate is `k * steps + steps - 1 - step`; without the step's part, `k * steps` is left.
        left = Signal(range(-steps, lanes * steps), reset_less=True)
        m.d.sync += left.eq(self.winner + self.step - (steps - 1))
        chosen = {}
        for name, offset in (("below", -1), ("winner", 0), ("above", 1)):
            chosen[name] = Signal(lanes, name=f"is_{name}", reset_less=True)
            m.d.sync += chosen[name].eq(Cat(left + offset == k * steps for k in range(lanes)))

        ready = self.costs_late + 1
        first = travelling(m, self.first, self.latency, "first")
        valid = travelling(m, self.valid, self.latency, "valid")
        joined = self.latency - 1

        # A step's cost below the winner, or above it: at most one lane has it.
        for name in ("below", "above"):
            # Two lanes share a lookup table: each brings an offer, and whether it is chosen.
            level: list[Value] = []
            for k in range(0, lanes, 2):
                part = Signal(bits + 1, name=f"{name}_{k}", reset_less=True)
                offers = [
                    Cat(Value.cast(self.costs[lane]), ~self.excluded[lane])
                    & chosen[name][lane].replicate(bits + 1)
                    for lane in range(k, min(k + 2, lanes))
                ]
                m.d.sync += part.eq(offers[0] | offers[-1])
                level.append(part)
            for depth in range(self._joins):
                following: list[Value] = []
                for k in range(0, len(level), JOINED):
                    some = Signal(bits + 1, name=f"{name}_{depth}_{k}", reset_less=True)
                    total = level[k]
                    for other in level[k + 1 : k + JOINED]:
                        total |= other
                    m.d.sync += some.eq(total)
                    following.append(some)
                level = following
            one = delayed(m, level[0], joined - ready - self._joins, f"late_{name}")
            held = Signal(bits + 1, name=f"held_{name}", reset_less=True)
            with m.If(valid[joined]):
                m.d.sync += held.eq(Mux(first[joined], 0, held) | one)
            m.d.comb += [
                Value.cast(getattr(self, name)).eq(held[:bits]),
                getattr(self, f"has_{name}").eq(held[bits]),
            ]

        nears = [
            self.excluded[k] | chosen["below"][k] | chosen["winner"][k] | chosen["above"][k]
            for k in range(lanes)
        ]
        if not self._runner_up:
            return m
        if is_fraction(self._cost):
            assert self._least
            m.submodules.least = least = self._least
            last = travelling(m, self.last, self.costs_late, "last")[-1]
            m.d.comb += [
                least.valid.eq(valid[self.costs_late]),
                least.last.eq(last),
                least.costs.eq(self.costs),
                least.excluded.eq(Cat(*nears)),
            ]
            late = self.latency - self.costs_late - least.latency
            found = delayed(m, Cat(Value.cast(least.o), least.found), late, "least")
            m.d.comb += [Value.cast(self.runner_up).eq(found[:bits]), self.has_runner_up.eq(found[bits])]
        else:
            self._smallest(m, nears, joined, valid[joined], first[joined])
        return m

    def _smallest(self, m: Module, nears: list[Value], joined: int, valid: Value, first: Value) -> None:
        """Finds the smallest number that is not near; a step's is there `joined` clocks after the step."""
        lanes, bits = self._lanes, self._cost.size
        none = (1 << bits) - 1
        # A number that is near or excluded loses its comparison; if both are, none is left. That takes
        # a lookup table for the choice, and not one for every operand.
        pipeline = Pipeline(m, levels=1)
        far: list[Word] = []
        for k in range(0, lanes, 2):
            a, b = self.costs[k].num, self.costs[min(k + 1, lanes - 1)].num
            near, other = nears[k], nears[min(k + 1, lanes - 1)]
            takes_b = Signal(name=f"takes_{k}")
            neither = Signal(name=f"neither_{k}")
            m.d.comb += [
                takes_b.eq(near | (~other & (b - a)[-1])),
                neither.eq(near & other),
            ]
            best = Mux(takes_b, b, a) | neither.replicate(bits)
            far.append(pipeline.result(best, 0, none, 0, "far"))

        def less(a: Word, b: Word) -> Word:
            a, b = pipeline.aligned(a, b)
            smaller = Mux((b.value - a.value)[-1], b.value, a.value)
            return pipeline.result(smaller, 0, none, a.time, "smaller")

        smallest = pipeline.at(pipeline.tree(less, far), joined - self.costs_late).value
        runner_up = Signal(bits, reset_less=True)
        with m.If(valid & (first | (smallest - runner_up)[-1])):
            m.d.sync += runner_up.eq(smallest)
        m.d.comb += [self.runner_up.num.eq(runner_up), self.has_runner_up.eq(runner_up != none)]
