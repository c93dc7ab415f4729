"""The right view's winner where costs are fractions, which take several clocks to compare."""

from amaranth.hdl import Module, Mux, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.memory import Memory

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.winners.argmin import FractionMin, candidate_layout, latency
from softdepth.hdl.winners.right_ports import right_winner_members
from softdepth.hdl.winners.tournament import tournament, tournament_latency
from softdepth.spec.ranges import COMPARISON_STEPS, right_parts


class RightFractions(wiring.Component):
    """Like `RightNumbers`, for fractions, each compared by a `FractionMin`, which takes several clocks.

    A right pixel's best candidate so far waits in distributed RAM for its next candidate. In the same lane,
    that comes ``steps - 1`` steps later. If this is time enough, all candidates follow each other as in
    `RightNumbers`. With fewer steps, a right pixel has several bests, each among a part of its candidates
    (`right_parts`). A part has the candidates of the same step in every lane, of which the next comes
    ``steps**2`` steps later, or only in every n-th lane, of which it comes n times later. At the end the best
    of the parts is found; of equal ones, that with the smallest index. A later candidate never replaces an
    equal one.

    Parameters and members are those of `RightNumbers`, except for
    latency : clocks from a slot's first step to its winner, which is held until the next.
    """

    def __init__(self, lanes: int, steps: int, cost: data.StructLayout) -> None:
        self._lanes, self._steps = lanes, steps
        self._parts = right_parts(lanes, steps)
        self._candidate = candidate_layout(cost.members["num"], cost.members["den"], lanes * steps)
        self._node_latency = latency(self._candidate)
        self.latency = self._node_latency + tournament_latency(self._candidate, self._parts) + 1
        super().__init__(right_winner_members(lanes, steps, cost))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        lanes, steps, found_time = self._lanes, self._steps, self._node_latency - 1
        valid = travelling(m, self.valid, found_time + 1, "valid")
        first = travelling(m, self.first, self.latency - 1, "first")
        one_after_the_other = steps > COMPARISON_STEPS
        apart = 1 if one_after_the_other else self._parts // steps  # lanes that have the same parts
        waits = steps - 1 if one_after_the_other else max(apart * steps**2, COMPARISON_STEPS)
        assert waits > found_time
        taken = _place(m, self.valid, waits, "taken")
        kept = _place(m, valid[found_time], waits, "kept")

        best = data.StructLayout({k: v for k, v in self._candidate.members.items() if k != "excluded"})
        # Before the first candidate nothing was found: that is 1 / 0, which no cost is equal to.
        entering: list[Value] = [best.const({"num": 1, "den": 0, "index": 0}).as_value()] * apart
        ends = []
        for lane in range(lanes):
            m.submodules[f"node_{lane}"] = node = FractionMin(self._candidate, halves=True)
            m.submodules[f"waits_{lane}"] = memory = Memory(shape=best, depth=waits, init=[])
            write, read = memory.write_port(), memory.read_port(domain="comb")
            before, now = Signal(best, name=f"before_{lane}"), Signal(best, name=f"now_{lane}")
            m.d.comb += [
                *(node.a[name].eq(before[name]) for name in best.members),
                node.b.num.eq(self.costs[lane].num),
                node.b.den.eq(self.costs[lane].den),
                node.b.index.eq(lane * steps + steps - 1 - self.step),
                node.b.excluded.eq(self.excluded[lane]),
                *(now[name].eq(node.early[name]) for name in best.members),
                write.en.eq(valid[found_time]),
                write.addr.eq(kept),
                write.data.eq(now),
                read.addr.eq(taken),
            ]
            came = entering[lane % apart]
            if one_after_the_other:
                # The first step's best goes on in the next lane, at the next slot's last step.
                m.d.comb += Value.cast(before).eq(Mux(self.last, came, Value.cast(read.data)))
                far = [Signal(best, name=f"far_{lane}_{k}", reset_less=True) for k in range(2)]
                with m.If(first[found_time]):
                    m.d.sync += far[0].eq(now)
                with m.If(self.first):
                    m.d.sync += far[1].eq(far[0])
                entering[0] = Value.cast(far[1])
            else:
                m.d.comb += Value.cast(before).eq(came)
                entering[lane % apart] = Value.cast(read.data)
            end = Signal(self._candidate, name=f"end_{lane}", reset_less=True)
            m.d.sync += [end[name].eq(now[name]) for name in best.members]
            ends.append(end)

        parts = [ends[-1]]
        if not one_after_the_other:
            parts = self._together(m, ends[lanes - apart :], valid[-1])
        least = tournament(m, parts)
        winner = Signal.like(self.winner, reset_less=True)
        with m.If(first[-1]):
            m.d.sync += winner.eq(least.index)
        m.d.comb += self.winner.eq(winner)
        return m

    def _together(self, m: Module, ends: list[data.View], valid: Value) -> list[data.View]:
        """The parts of a right pixel, at the first step of the slot that its last candidate belongs to.

        The last lanes find them: with each step one slot, less a step, before that with the step before.
        """
        steps, parts = self._steps, []
        for earlier, end in enumerate(reversed(ends)):
            waited, depth = end, earlier * steps**2
            for k in range(steps):
                m.submodules[f"part_{earlier}_{k}"] = wait = Delay(self._candidate, depth)
                m.d.comb += [wait.en.eq(valid), wait.i.eq(waited)]
                parts.append(waited := wait.o)
                depth = steps - 1
        return parts


def _place(m: Module, moves: Value, places: int, name: str) -> Signal:
    """Counts the places of a ring."""
    place = Signal(range(places), name=name)
    with m.If(moves):
        m.d.sync += place.eq(Mux(place == places - 1, 0, place + 1))
    return place
