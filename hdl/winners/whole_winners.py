"""Costs in, results out: both views' winners, the costs beside the left one, and whether the views agree."""

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.costs.bundle import winner_ports
from softdepth.hdl.costs.layout import is_fraction
from softdepth.hdl.costs.whole_costs import tags_layout
from softdepth.hdl.memory.delay import Delay, delayed
from softdepth.hdl.memory.result_queue import ResultQueue
from softdepth.hdl.memory.window import MARKERS
from softdepth.hdl.signatures import TOLERANCE_BITS
from softdepth.hdl.winners.argmin import ArgminSequence, ArgminTree, candidate_layout
from softdepth.hdl.winners.confidence import Confidence
from softdepth.hdl.winners.layout import post_layout
from softdepth.hdl.winners.left_right import LeftRight
from softdepth.hdl.winners.neighbours import Neighbours
from softdepth.hdl.winners.number import Number, number_latency
from softdepth.hdl.winners.right_winner import right_winner
from softdepth.hdl.winners.sixteenths import Sixteenths
from softdepth.spec.config import CONFIDENCE_BITS, Config
from softdepth.spec.validity import Validity

FAR = 2
"""Clocks that credit takes to reach the slots and word of a beginning takes to come back."""

KEPT_TOGETHER = 8
"""Lanes whose costs wait in a memory of their own, with a counter near them."""


class WholeWinners(wiring.Component):
    """Finds each pixel's result among costs that come step by step; back-pressure reaches `credit`.

    Fractions are compared as they are; they become numbers where fractions of a pixel and margins need them.

    Parameters
    ----------
    cost : a candidate's, ``num / den``.
    ahead : clocks from a slot's beginning to its first costs.

    Members
    -------
    The ports of `winner_ports` with the tags of `WholeCosts`; and
    tolerance : of the check, `Post.tolerance` unless it is driven. It may change between frames.
    o : a stream of results, `post_layout`.
    """

    def __init__(self, config: Config, cost: data.StructLayout, colour_bits: int, ahead: int) -> None:
        self._config, self._cost, self._ahead = config, cost, ahead
        self._tags = tags_layout(config)
        self.layout = post_layout(config.result_bits, colour_bits)
        super().__init__(
            {
                **winner_ports(lanes=config.lanes, steps=config.steps, cost=cost, tags=self._tags),
                "tolerance": In(TOLERANCE_BITS, init=config.post.tolerance),
                "o": Out(stream.Signature(self.layout)),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config, post = self._config, self._config.post
        lanes, steps = config.lanes, config.steps
        cost = self._cost
        num, den = cost.members["num"], cost.members["den"]

        # The left winner, `found_time` clocks after the last step.
        m.submodules.tree = tree = ArgminTree(num, den, lanes)
        best = candidate_layout(num, den, config.disparities)
        m.submodules.sequence = sequence = ArgminSequence(best, steps)
        found_time = tree.latency + sequence.latency
        again = found_time + steps  # from a step until it is looked at again
        m.submodules.neighbours = beside = Neighbours(lanes, steps, cost, runner_up=post.confidence)
        # Clocks that it takes to turn costs into numbers.
        numbers = number_latency(*config.number_range) if is_fraction(cost) else 0
        late = again + beside.latency + numbers
        judged = late + (Sixteenths.latency if post.fraction_bits else Confidence.latency)
        valid = travelling(m, self.valid, judged, "valid")
        first = travelling(m, self.first, again, "first")
        last = travelling(m, self.last, judged, "last")
        tree_step = delayed(m, self.step, tree.latency, "tree_step")
        for k in range(lanes):
            m.d.comb += [
                tree.i[k].num.eq(self.costs[k].num),
                tree.i[k].den.eq(self.costs[k].den),
                tree.i[k].excluded.eq(self.excluded[k]),
            ]
        m.d.comb += [
            sequence.valid.eq(valid[tree.latency]),
            sequence.last.eq(last[tree.latency]),
            sequence.i.num.eq(tree.o.num),
            sequence.i.den.eq(tree.o.den),
            sequence.i.index.eq(tree.o.index * steps + (steps - 1 - tree_step)),
            sequence.i.excluded.eq(tree.o.excluded),
        ]
        winner = Signal(range(config.disparities), reset_less=True)
        smallest = Signal(cost, reset_less=True)
        with m.If(last[found_time]):
            m.d.sync += [
                winner.eq(sequence.o.index),
                smallest.num.eq(sequence.o.num),
                smallest.den.eq(sequence.o.den),
            ]

        # All costs again, beside the winner.
        # In distributed RAM, however short: registers would be as many as in all the lanes' sums together.
        for base in range(0, lanes, KEPT_TOGETHER):
            part = range(base, min(base + KEPT_TOGETHER, lanes))
            everything = Cat(Cat(self.costs[k], self.excluded[k]) for k in part)
            again_here = Cat(Cat(beside.costs[k], beside.excluded[k]) for k in part)
            kept = Delay(len(everything), again + Neighbours.costs_late, registers=False)
            m.submodules[f"again_{base}"] = kept
            m.d.comb += [kept.en.eq(1), kept.i.eq(everything), again_here.eq(kept.o)]
        m.d.comb += [
            beside.valid.eq(valid[again]),
            beside.first.eq(first[again]),
            beside.last.eq(last[again]),
            beside.step.eq(self._late(m, self.step, again, "step")),
            beside.winner.eq(winner),
        ]
        winner_late = delayed(m, winner, beside.latency + numbers, "winner")
        smallest_late = delayed(m, Value.cast(smallest), beside.latency, "smallest")

        def number(of: Value, name: str) -> Value:
            """A cost as a number, at `late`."""
            if not numbers:
                return of
            m.submodules[f"number_{name}"] = block = Number(cost, *config.number_range)
            m.d.comb += Value.cast(block.i).eq(of)
            return block.o

        smallest_number = number(smallest_late, "smallest")
        has_below, has_above, has_runner_up = (
            delayed(m, getattr(beside, f"has_{name}"), numbers, f"has_{name}")
            for name in ("below", "above", "runner_up")
        )

        value: Value = delayed(m, winner_late, judged - late, "whole")
        if post.fraction_bits:
            m.submodules.sixteenths = sixteenths = Sixteenths(config.disparities, len(smallest_number))
            m.d.comb += [
                sixteenths.winner.eq(winner_late),
                sixteenths.cost.eq(smallest_number),
                sixteenths.below.eq(number(Value.cast(beside.below), "below")),
                sixteenths.above.eq(number(Value.cast(beside.above), "above")),
                sixteenths.usable.eq(has_below & has_above),
            ]
            value = sixteenths.o
        m.submodules.confidence = confidence = Confidence(len(smallest_number), config.confidence_shift)
        m.d.comb += [
            confidence.cost.eq(smallest_number),
            confidence.runner_up.eq(number(Value.cast(beside.runner_up), "runner_up")),
            confidence.has_runner_up.eq(has_runner_up),
        ]
        sure = delayed(m, confidence.o, judged - late - Confidence.latency, "sure")
        tags = data.View(self._tags, self._late(m, Value.cast(self.tags), judged, "tags"))

        found = data.StructLayout(
            {"value": config.result_bits, "confidence": CONFIDENCE_BITS, "tags": self._tags}
        )
        here = Signal(found)
        m.d.comb += [here.value.eq(value), here.tags.eq(tags)]
        if post.confidence:
            m.d.comb += here.confidence.eq(sure)
        done: Value = last[judged]
        emits: Value = last[judged] & tags.emits
        agrees: Value | None = None
        result: data.View = here
        latency = self._ahead + judged
        if post.check:
            m.submodules.right = right = right_winner(lanes, steps, cost)
            m.submodules.check = check = LeftRight(config.disparities, found, post.tolerance)
            compared = judged - LeftRight.lead
            assert compared >= again
            m.d.comb += [
                check.tolerance.eq(self.tolerance),
                right.valid.eq(self.valid),
                right.first.eq(self.first),
                right.last.eq(self.last),
                right.step.eq(self.step),
                right.costs.eq(self.costs),
                right.excluded.eq(self.excluded),
                check.valid.eq(last[compared]),
                check.winner.eq(delayed(m, winner, compared - again, "checked")),
                check.right.eq(self._late(m, right.winner, compared - right.latency, "right")),
                check.emits.eq(emits),
                check.result.eq(here),
            ]
            done, emits, agrees, result = check.done, check.o_emits, check.agrees, check.o
            latency += LeftRight.latency

        # The slots are far from here: credit and ``begins`` take a clock each on their way.
        credit = Signal()
        begun = Signal()
        unseen = -(-FAR // steps)
        m.submodules.queue = queue = ResultQueue(self.layout, -(-latency // steps) + 2, unseen=unseen)
        m.d.sync += [credit.eq(queue.credit), begun.eq(self.begins)]
        border = Value.cast(result.tags.border).any()
        kept_result: Value = (agrees if agrees is not None else Const(1, 1)) & ~border
        code = Mux(result.tags.full, Validity.FULL, Validity.PARTIAL)
        lost = Mux(border, Validity.BORDER, Validity.INCONSISTENT)
        m.d.comb += [
            self.credit.eq(credit),
            queue.promised.eq(begun),
            queue.put.eq(emits),
            queue.dropped.eq(done & ~emits),
            queue.result.value.eq(Mux(kept_result, result.value, 0)),
            queue.result.code.eq(Mux(kept_result, code, lost)),
            queue.result.confidence.eq(Mux(kept_result, result.confidence, 0)),
            queue.result.colour.eq(result.tags.colour),
            *(queue.result[name].eq(result.tags[name]) for name in MARKERS),
        ]
        wiring.connect(m, queue.o, wiring.flipped(self.o))
        return m

    def _late(self, m: Module, value: Value, clocks: int, name: str) -> Value:
        """``value`` after so many clocks, in memory if they are many."""
        m.submodules[f"late_{name}"] = late = Delay(len(value), clocks)
        m.d.comb += [late.en.eq(1), late.i.eq(value)]
        return late.o
