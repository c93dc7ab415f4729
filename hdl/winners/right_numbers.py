"""The right view's winner where costs are plain numbers, found along the diagonal of the left view's."""

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import data, wiring

from softdepth.hdl.winners.right_ports import right_winner_members


class RightNumbers(wiring.Component):
    """Finds each right pixel's candidate of least cost; of equal costs, the smallest candidate.

    Right pixel x is candidate d of left pixel x + d. So its best candidate so far moves on by one candidate
    with each left pixel, from 0 to the last, and leaves there. An excluded candidate changes nothing, so a
    line's last right pixels leave during the slots that follow the line, whatever these are. A lane holds
    the state of its segment, far end first; the near end takes over from the lane below.
    A candidate is compared within one clock: with one step, its best is needed in the very next. The
    comparison fills that clock, so costs first come to registers near it.

    Parameters
    ----------
    cost : of a candidate, ``num`` alone.

    Members
    -------
    valid, first : a step is taken; it is its slot's first. A ``first`` never comes without ``valid``.
    last : it is its slot's last.
    step : the step's number.
    costs, excluded : of each lane's candidate.
    winner : of the right pixel that lies ``disparities - 1`` slots back, `latency` clocks after the first
        step, held until the next.
    """

    latency = 2

    def __init__(self, lanes: int, steps: int, cost: data.StructLayout) -> None:
        self._lanes, self._steps, self._cost = lanes, steps, cost
        super().__init__(right_winner_members(lanes, steps, cost))

    def elaborate(self, platform: object) -> Module:
        m = Module()
        steps = self._steps
        valid = Signal()
        first = Signal()
        step = Signal.like(self.step, reset_less=True)
        costs = Signal.like(self.costs, reset_less=True)
        excluded = Signal.like(self.excluded, reset_less=True)
        m.d.sync += [valid.eq(self.valid), first.eq(self.first), step.eq(self.step)]
        m.d.sync += [costs.eq(self.costs), excluded.eq(self.excluded)]
        best = data.StructLayout({"cost": self._cost, "index": range(self._lanes * steps)})
        # Before the first candidate nothing was found, and any cost is less.
        none = (1 << self._cost.size) - 1
        entering: Value = Const(none, best.size)
        for lane in range(self._lanes):
            # The best before a step's candidate: a register, so nothing has to be chosen before comparing.
            before = Signal(best, name=f"before_{lane}", reset_less=True)
            now = Signal(best, name=f"now_{lane}")
            better = Signal(name=f"better_{lane}")
            m.d.comb += better.eq(~excluded[lane] & (costs[lane].num - before.cost.num)[-1])
            m.d.comb += [
                Value.cast(now.cost).eq(Mux(better, Value.cast(costs[lane]), Value.cast(before.cost))),
                now.index.eq(Mux(better, lane * steps + steps - 1 - step, before.index)),
            ]
            if steps == 1:
                m.d.comb += before.eq(entering)
                found = Signal(best, name=f"found_{lane}", reset_less=True)
                with m.If(valid):
                    m.d.sync += found.eq(now)
                entering = found
                continue
            # What each step found, kept until its place's turn comes again; and the far end of this slot and,
            # where that is wanted later than in the first step, of the slot before.
            waits = [Signal(best, name=f"waits_{lane}_{k}", reset_less=True) for k in range(steps - 2)]
            far = [Signal(best, name=f"far_{lane}_{k}", reset_less=True) for k in range(min(steps - 1, 2))]
            line = [now, *waits]
            with m.If(valid):
                m.d.sync += [
                    before.eq(Mux(step == steps - 2, entering, Value.cast(line[-1]))),
                    *(late.eq(early) for early, late in zip(line, waits, strict=False)),
                ]
            with m.If(first):
                m.d.sync += [late.eq(early) for early, late in zip([now, *far], far, strict=False)]
            entering = Value.cast(far[-1])
        winner = Signal.like(self.winner, reset_less=True)
        with m.If(first):
            m.d.sync += winner.eq(now.index)
        m.d.comb += self.winner.eq(winner)
        return m
