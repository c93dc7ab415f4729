"""Many short runs of one block, each from reset, in one simulation."""

from collections.abc import Callable, Iterable, Mapping
from random import Random
from typing import Any, NamedTuple

from amaranth.hdl import Signal, Value
from amaranth.sim import SimulatorContext

from softdepth.hdl.signatures import Status
from tests.support.simulation import simulate


class Trial(NamedTuple):
    """Packed inputs of one run, and the probabilities of offering and of taking in a clock.

    ``pauses``: clocks before the payload of a number is offered.
    """

    payloads: list[int]
    i_rate: float = 1.0
    o_rate: float = 1.0
    pauses: Mapping[int, int] = {}


class Outcome(NamedTuple):
    """What left in a run, and the counters above zero."""

    payloads: list[Any]
    status: dict[str, int]


def run_trials(
    dut: Any, trials: Iterable[Trial], judge: Callable[[int, Outcome], bool], *, patience: int
) -> None:
    """Run the trials; ``judge`` gets the number and outcome of each, and says whether to go on.

    A run ends ``patience`` clocks after the last transfer. Fails where an offer is withdrawn or altered,
    or where input is left over.
    """
    layout = dut.o.payload.shape()
    i_payload, o_payload = Value.cast(dut.i.payload), Value.cast(dut.o.payload)

    async def run(ctx: SimulatorContext, trial: Trial, random: Random) -> list[Any]:
        pending = iter(trial.payloads)
        offered = next(pending, None)
        shown = False
        waiting: int | None = None
        given = []
        quiet = number = 0
        pause = trial.pauses.get(number, 0)
        while quiet < patience:
            if pause:
                pause, quiet = pause - 1, 0
            shown = not pause and offered is not None and (shown or random.random() < trial.i_rate)
            ready = random.random() < trial.o_rate
            # A source may show anything while it offers nothing.
            ctx.set(i_payload, offered if shown else random.getrandbits(len(i_payload)))
            ctx.set(dut.i.valid, shown)
            ctx.set(dut.o.ready, ready)
            _, _, i_ready, o_valid, o_bits = await ctx.tick().sample(dut.i.ready, dut.o.valid, o_payload)
            assert waiting is None or (o_valid and o_bits == waiting), "an offer was withdrawn or altered"
            waiting = o_bits if o_valid and not ready else None
            quiet += 1
            if shown and i_ready:
                offered, shown, quiet = next(pending, None), False, 0
                number += 1
                pause = trial.pauses.get(number, 0)
            if o_valid and ready:
                given.append(layout.from_bits(o_bits))
                quiet = 0
        assert offered is None, "input was left over"
        return given

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        for number, trial in enumerate(trials):
            ctx.set(dut.i.valid, 0)
            ctx.set(dut.o.ready, 0)
            ctx.set(rst, 1)
            await ctx.tick()
            ctx.set(rst, 0)
            given = await run(ctx, trial, Random(number))
            counters = ctx.get(dut.status)
            status = {name: counters[name] for name, _ in Status if counters[name]}
            if not judge(number, Outcome(given, status)):
                return

    simulate(dut, bench)
