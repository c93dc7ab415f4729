"""The best of several candidates that arrive together, in any order."""

from collections.abc import Sequence

from amaranth.hdl import Module
from amaranth.lib import data

from softdepth.hdl.memory.delay import Delay
from softdepth.hdl.winners.argmin import FractionMin, latency


def tournament(m: Module, candidates: Sequence[data.View]) -> data.View:
    """The best of ``candidates``, `tournament_latency` clocks later; on a tie, the one with the smallest
    index.

    Unlike in `ArgminTree`, the indices come with the candidates, and excluded ones need not come last.
    """
    level = list(candidates)
    layout = level[0].shape()
    while len(level) > 1:
        following: list[data.View] = []
        for k in range(0, len(level) - 1, 2):
            m.submodules[f"node_{len(level)}_{k}"] = node = FractionMin(layout)
            m.d.comb += [node.a.eq(level[k]), node.b.eq(level[k + 1])]
            following.append(node.o)
        if len(level) % 2:
            m.submodules[f"wait_{len(level)}"] = wait = Delay(layout, latency(layout))
            m.d.comb += [wait.en.eq(1), wait.i.eq(level[-1])]
            following.append(wait.o)
        level = following
    return level[0]


def tournament_latency(layout: data.StructLayout, candidates: int) -> int:
    """Clocks that `tournament` takes."""
    return latency(layout) * (candidates - 1).bit_length()
