"""Column sums of several lanes, between the lanes' differences and their sums along the row."""

from collections.abc import Sequence

from amaranth.hdl import Cat, Module, Value

from softdepth.hdl.costs.comparison import Plan
from softdepth.hdl.costs.criteria.column_sum import ColumnSum
from softdepth.hdl.costs.criteria.running_sums import RunningSums
from softdepth.hdl.costs.whole_lane import LaneDifferences, LaneSums
from softdepth.hdl.memory.delay import Delay
from softdepth.spec.config import Config

GROUP = 16
"""Lanes whose running sums lie in one memory."""


def join_columns(
    m: Module,
    config: Config,
    plan: Plan,
    differences: Sequence[LaneDifferences],
    sums: Sequence[LaneSums],
    *,
    valid: Value,
    place: Value,
    begins: Value,
    outside: Value,
    summed: Value,
) -> None:
    """Sum the lanes' columns, running sums in block RAM; delay the sums that are to leave those of the row.

    Parameters
    ----------
    valid, place, begins, outside : as in `RunningSums`.
    summed : a step's column sums are there.
    """
    for base in range(0, len(sums), GROUP):
        lanes = range(base, min(base + GROUP, len(sums)))
        kept = [(k, j, c) for k in lanes for j, c in enumerate(plan.columns) if c.running]
        if kept:
            m.submodules[f"running_{base}"] = running = RunningSums(
                [c.column_maximum for _, _, c in kept], [c.pixel_maximum for _, _, c in kept], config.places
            )
            m.d.comb += [
                running.valid.eq(valid),
                running.place.eq(place),
                running.begins.eq(begins),
                running.outside.eq(outside),
            ]
            for n, (k, j, _) in enumerate(kept):
                new, old = differences[k].o[str(j)]
                m.d.comb += [
                    running.new[str(n)].eq(new),
                    running.old[str(n)].eq(old),
                    sums[k].columns[str(j)].eq(running.o[str(n)]),
                ]
        for j, c in enumerate(plan.columns):
            for k in lanes if not c.running else ():
                m.submodules[f"column_{j}_{k}"] = column = ColumnSum(c.pixel_maximum, c.rows)
                m.d.comb += [column.i.eq(differences[k].o[str(j)]), sums[k].columns[str(j)].eq(column.o)]
        for j, c in enumerate(plan.comparisons):
            if plan.row_runs(c):
                columns = Cat(sums[k].columns[plan.column_of(c)] for k in lanes)
                leaving = Cat(sums[k].leaving[str(j)] for k in lanes)
                wait = (2 * c.reach + 1) * config.steps
                m.submodules[f"leaving_{j}_{base}"] = delay = Delay(len(columns), wait, registers=False)
                m.d.comb += [delay.en.eq(summed), delay.i.eq(columns), leaving.eq(delay.o)]
