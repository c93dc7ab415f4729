"""Running blocks in Amaranth's simulator."""

from collections.abc import Callable, Coroutine, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from random import Random
from typing import Any

from amaranth.hdl import ClockDomain, Module, Signal, Value
from amaranth.lib import data, wiring
from amaranth.sim import Simulator, SimulatorContext

from softdepth.hdl.costs.criteria.row_memory import LOOKUP_AHEAD
from softdepth.hdl.signatures import Status, pair_layout
from softdepth.spec.config import Config, PixelFormat

Ports = Mapping[str, Any]
"""Values of input ports in one clock; ports left out keep theirs."""


def config(**keys: Any) -> Config:
    """A configuration with these keys, small enough to simulate."""
    return Config.from_dict({"max_width": 32, "max_height": 32, **keys})


def sad(window: int, dx: int = 0, label_bits: int = 12) -> dict[str, int]:
    """A SAD criterion as plain data."""
    return {"window": window, "dx": dx, "label_bits": label_bits}


Bench = Callable[[SimulatorContext, Signal], Coroutine[Any, Any, None]]
"""A test bench; it is given the simulator and the block's reset."""


def simulate(dut: wiring.Component, bench: Bench) -> None:
    """Run ``bench`` on ``dut`` from reset to the bench's end."""
    top = Module()
    domain = ClockDomain("sync")  # made here, so that blocks of wires only have a clock too
    top.domains.sync = domain
    top.submodules.dut = dut

    async def process(ctx: SimulatorContext) -> None:
        await bench(ctx, domain.rst)

    simulator = Simulator(top)
    simulator.add_clock(1e-6)
    simulator.add_testbench(process)
    simulator.run()


def observe(dut: wiring.Component, clocks: Iterable[Ports], output: str) -> list[int]:
    """Drive ports clock by clock; the bits of one output in each of these clocks, before its edge."""
    seen: list[int] = []
    port = Value.cast(getattr(dut, output))

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        for ports in clocks:
            for name, value in ports.items():
                ctx.set(getattr(dut, name), value)
            _, _, bits = await ctx.tick().sample(port)
            seen.append(bits)

    simulate(dut, bench)
    return seen


def piped(dut: Any, inputs: Sequence[Ports], output: str = "o") -> list[Any]:
    """Feed a block of fixed latency one set of inputs a clock; the output that belongs to each set."""
    idle: list[Ports] = [{}] * dut.latency
    bits = observe(dut, [*inputs, *idle], output)[dut.latency :]
    port = getattr(dut, output)
    return [port.shape().from_bits(word) for word in bits] if isinstance(port, data.View) else bits


@dataclass
class Transfers:
    """What passed a component's stream ports ``i`` and ``o``.

    Members
    -------
    taken : clock of each input transfer.
    payloads, given : the output's payloads, and the clock of each.
    status : the counters at the end, those above zero.
    before_reset : payloads given before the reset, if there was one.
    """

    taken: list[int] = field(default_factory=list)
    payloads: list[Any] = field(default_factory=list)
    given: list[int] = field(default_factory=list)
    status: dict[str, int] = field(default_factory=dict)
    before_reset: int = 0


def stream_through(
    dut: Any,
    payloads: Sequence[int],
    *,
    i_rate: float = 1.0,
    o_rate: float = 1.0,
    o_every: int = 1,
    seed: int = 0,
    reset_at: int | None = None,
    patience: int = 300,
) -> Transfers:
    """Send packed payloads through ``i``, take what leaves ``o`` until nothing moves for ``patience`` clocks.

    ``i_rate`` and ``o_rate`` are the probabilities of offering and of taking in a clock; ``o`` is taken in
    every ``o_every``-th at most. The block is reset for one clock after ``reset_at`` input transfers. Fails
    where ``o`` withdraws or alters what it has offered, or where input is left over.
    """
    random = Random(seed)
    result = Transfers()
    layout = dut.o.payload.shape()
    i_payload, o_payload = Value.cast(dut.i.payload), Value.cast(dut.o.payload)

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        clock = quiet = 0
        offered = False
        waiting: int | None = None
        resets = [reset_at]
        while quiet < patience:
            sent = len(result.taken)
            if sent in resets:
                ctx.set(dut.i.valid, 0)
                ctx.set(dut.o.ready, 0)
                ctx.set(rst, 1)
                await ctx.tick()
                ctx.set(rst, 0)
                resets, offered, waiting = [], False, None
                result.before_reset = len(result.payloads)
            if not offered and sent < len(payloads) and random.random() < i_rate:
                offered = True
                ctx.set(i_payload, payloads[sent])
            ready = random.random() < o_rate and clock % o_every == 0
            ctx.set(dut.i.valid, offered)
            ctx.set(dut.o.ready, ready)
            _, _, i_ready, o_valid, o_bits = await ctx.tick().sample(dut.i.ready, dut.o.valid, o_payload)
            if waiting is not None:
                assert o_valid, f"clock {clock}: the offer was withdrawn"
                assert o_bits == waiting, (
                    f"clock {clock}: the offer was altered from {layout.from_bits(waiting)}"
                    f" to {layout.from_bits(o_bits)}"
                )
            waiting = o_bits if o_valid and not ready else None
            quiet += 1
            if offered and i_ready:
                result.taken.append(clock)
                offered, quiet = False, 0
            if o_valid and ready:
                result.payloads.append(layout.from_bits(o_bits))
                result.given.append(clock)
                quiet = 0
            clock += 1
        if hasattr(dut, "status"):
            counters = ctx.get(dut.status)
            result.status = {name: counters[name] for name, _ in Status if counters[name]}

    simulate(dut, bench)
    assert len(result.taken) == len(payloads), (
        f"only {len(result.taken)} of {len(payloads)} inputs were taken"
    )
    return result


def pair(
    left: int,
    right: int,
    *,
    pixel: PixelFormat = PixelFormat.RGB8,
    sof: bool = False,
    eol: bool = False,
    eof: bool = False,
) -> int:
    """The bits of a `pair_layout`."""
    return (
        pair_layout(pixel)
        .const({"left": left, "right": right, "sof": sof, "eol": eol, "eof": eof})
        .as_value()
        .value
    )


def looked_up(clocks: list[Ports], valid: str = "valid", coming: str = "coming") -> list[Ports]:
    """`clocks` after `LOOKUP_AHEAD` more, with their places, and ``valid`` as ``coming``, so much earlier."""
    early = [
        {name: now[key] for name, key in ((coming, valid), ("place", "place")) if key in now}
        for now in clocks
    ]
    kept = ({name: value for name, value in now.items() if name not in (coming, "place")} for now in clocks)
    late: list[Ports] = [{}] * LOOKUP_AHEAD
    return [a | b for a, b in zip_longest([*late, *kept], early, fillvalue={})]
