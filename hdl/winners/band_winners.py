"""Costs in, results out: only the left view's winner, and results without costs in between."""

from amaranth.hdl import Module, Mux, Shape, Signal
from amaranth.lib import data, stream, wiring
from amaranth.lib.wiring import Out

from softdepth.hdl.arithmetic.pipeline import Pipeline, travelling
from softdepth.hdl.costs.band_costs import band_tags
from softdepth.hdl.costs.bundle import winner_ports
from softdepth.hdl.front.sequencer import tags_layout
from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.memory.result_queue import QUEUE_LATENCY, ResultQueue
from softdepth.hdl.memory.window import MARKERS
from softdepth.hdl.winners.argmin import ArgminSequence, ArgminTree, candidate_layout
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity


def left_layout(config: Config) -> data.StructLayout:
    """A result: ``value``, its `Validity` ``code``, and the markers."""
    members = {"value": Shape(config.result_bits, signed=config.signed), "code": config.code_bits}
    return data.StructLayout({**members, **dict.fromkeys(MARKERS, 1)})


class BandWinners(wiring.Component):
    """Finds each pixel's candidate of least cost; back-pressure reaches `credit`.

    Parameters
    ----------
    cost : a candidate's, ``num / den``.
    ahead, tags_ahead : clocks from a result's beginning, and from its tags, to its first costs.

    Members
    -------
    The ports of `winner_ports` with `band_tags`; and
    o : a stream of `left_layout`, `latency` clocks after a result's beginning where it is not held back.
    """

    def __init__(self, config: Config, cost: data.StructLayout, *, ahead: int, tags_ahead: int) -> None:
        self._config = config
        num, den = (cost[name].shape for name in ("num", "den"))
        self._tree = ArgminTree(num, den, config.lanes)
        best = candidate_layout(num, den, config.disparities)
        self._sequence = ArgminSequence(best, config.steps)
        found = self._tree.latency + self._sequence.latency
        self._tags_latency = tags_ahead + found
        self.layout = left_layout(config)
        found += ahead + config.steps - 1
        self.latency = found + QUEUE_LATENCY
        # The sequencer begins a result in the clock after it saw credit.
        self._queue = ResultQueue(self.layout, -(-found // config.steps), unseen=1)
        self.queue_depth = self._queue.depth
        ports = winner_ports(lanes=config.lanes, steps=config.steps, cost=cost, tags=band_tags(config))
        super().__init__({**ports, "o": Out(stream.Signature(self.layout))})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        config, tree, sequence = self._config, self._tree, self._sequence
        m.submodules.tree, m.submodules.sequence = tree, sequence
        for k in range(config.lanes):
            m.d.comb += [
                tree.i[k].num.eq(self.costs[k].num),
                tree.i[k].den.eq(self.costs[k].den),
                tree.i[k].excluded.eq(self.excluded[k]),
            ]
        control = Pipeline(m, levels=1)
        step = control.at(control.input(self.step, config.steps - 1, "step"), tree.latency).value
        m.d.comb += [
            sequence.valid.eq(travelling(m, self.valid, tree.latency, "valid")[-1]),
            sequence.last.eq(step == config.steps - 1),
            sequence.i.num.eq(tree.o.num),
            sequence.i.den.eq(tree.o.den),
            sequence.i.index.eq(tree.o.index * config.steps + (config.steps - 1 - step)),
            sequence.i.excluded.eq(tree.o.excluded),
        ]
        m.submodules.tags = tags = Delay(tags_layout(), self._tags_latency)
        m.d.comb += [tags.en.eq(1), tags.i.eq(self.tags.result)]
        emits = travelling(m, self.tags.emits, self._tags_latency, "emits")[-1]
        self._results(m, emits, tags.o)
        return m

    def _results(self, m: Module, emits: Signal, tags: data.View) -> None:
        """The queue of results, which gives credit."""
        m.submodules.queue = queue = self._queue
        wiring.connect(m, queue.o, wiring.flipped(self.o))
        winner = self._sequence.o.index + self._config.min_disparity
        m.d.comb += [
            self.credit.eq(queue.credit),
            queue.promised.eq(self.begins),
            queue.put.eq(emits),
            queue.result.value.eq(Mux(tags.code == Validity.BORDER, 0, winner)),
            *[queue.result[name].eq(tags[name]) for name in ("code", *MARKERS)],
        ]
