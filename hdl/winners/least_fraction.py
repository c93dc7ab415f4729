"""The smallest of several fractions, any of which may be excluded."""

from amaranth.hdl import Module, Signal, Value
from amaranth.lib import data, wiring
from amaranth.lib.wiring import In, Out

from softdepth.hdl.arithmetic.pipeline import travelling
from softdepth.hdl.winners.argmin import ArgminSequence, candidate_layout
from softdepth.hdl.winners.tournament import tournament, tournament_latency


class LeastFraction(wiring.Component):
    """The least cost of all lanes and steps of a pixel.

    Any candidate may be excluded, so they meet in a `tournament`. In an `ArgminTree` the excluded ones are
    always the last, which spares each node a comparison of indices and the choice between exclusions.

    Members
    -------
    valid, last, costs, excluded : of a step; ``last`` marks its pixel's last step.
    o, found : the least cost, and whether there is any, `latency` clocks after the last step.
    """

    def __init__(self, cost: data.StructLayout, lanes: int, steps: int) -> None:
        self._lanes = lanes
        self._candidate = candidate_layout(cost.members["num"], cost.members["den"], 1)
        self._sequence = ArgminSequence(self._candidate, steps)
        self._time = tournament_latency(self._candidate, lanes)
        self.latency = self._time + self._sequence.latency
        super().__init__(
            {
                "valid": In(1),
                "last": In(1),
                "costs": In(data.ArrayLayout(cost, lanes)),
                "excluded": In(lanes),
                "o": Out(cost),
                "found": Out(1),
            }
        )

    def elaborate(self, platform: object) -> Module:
        m = Module()
        level: list[data.View] = []
        for k in range(self._lanes):
            candidate = Signal(self._candidate, name=f"candidate_{k}")
            m.d.comb += [
                candidate.num.eq(self.costs[k].num),
                candidate.den.eq(self.costs[k].den),
                candidate.excluded.eq(self.excluded[k]),
            ]
            level.append(candidate)
        least = tournament(m, level)
        time = self._time
        m.submodules.sequence = sequence = self._sequence
        m.d.comb += [
            sequence.valid.eq(travelling(m, self.valid, time, "valid")[-1]),
            sequence.last.eq(travelling(m, self.last, time, "last")[-1]),
            Value.cast(sequence.i).eq(Value.cast(least)),
            self.o.num.eq(sequence.o.num),
            self.o.den.eq(sequence.o.den),
            self.found.eq(~sequence.o.excluded),
        ]
        return m
