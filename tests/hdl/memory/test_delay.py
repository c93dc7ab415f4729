"""Delay: depths on both sides of the step from registers to memory."""

import gc
from random import Random

import pytest
from amaranth.back import rtlil
from amaranth.lib import data
from amaranth.lib.memory import Memory
from amaranth.sim import Simulator

from softdepth.hdl.memory.delay import CHAINED, DEEP, REGISTER_LIMIT, SHORT, Delay
from softdepth.hdl.text.collisions import waive_collisions
from tests.support.simulation import observe


@pytest.mark.parametrize(
    "depth", [0, 1, 2, REGISTER_LIMIT - 1, REGISTER_LIMIT, REGISTER_LIMIT + 1, REGISTER_LIMIT + 2, 31, 32, 33]
)
@pytest.mark.parametrize("rate", [1.0, 0.6])
def test_shows_the_value_of_so_many_enabled_clocks_ago(depth: int, rate: float) -> None:
    assert_late(Delay(9, depth), depth, rate)


def assert_late(dut: Delay, depth: int, rate: float) -> None:
    random = Random(depth)
    clocks = [{"i": random.getrandbits(9), "en": random.random() < rate} for _ in range(5 * depth + 60)]
    seen = observe(dut, clocks, "o")
    entered: list[int] = []
    compared = 0
    for ports, o in zip(clocks, seen, strict=True):
        if not ports["en"]:
            continue
        entered.append(ports["i"])
        if len(entered) > depth:
            assert o == entered[-1 - depth]
            compared += 1
    assert compared > depth + 10


@pytest.mark.parametrize("depth", [1, 2, 9, DEEP, DEEP + 1, DEEP + SHORT + 1, 2 * DEEP, CHAINED, CHAINED + 1])
@pytest.mark.parametrize("rate", [1.0, 0.6])
def test_in_memory_whatever_the_depth(depth: int, rate: float) -> None:
    assert_late(Delay(9, depth, registers=False), depth, rate)


def test_a_depth_of_zero_is_a_wire_without_its_enable() -> None:
    assert observe(Delay(4, 0), [{"i": 5, "en": 0}, {"i": 9}], "o") == [5, 9]


@pytest.mark.parametrize("depth", [3, REGISTER_LIMIT + 3])
def test_structures_keep_their_shape(depth: int) -> None:
    layout = data.StructLayout({"a": 3, "b": 7})
    clocks = [{"i": {"a": k % 8, "b": 127 - k}, "en": 1} for k in range(40)]
    seen = [layout.from_bits(bits) for bits in observe(Delay(layout, depth), clocks, "o")]
    assert [(o.a, o.b) for o in seen[depth:]] == [(k % 8, 127 - k) for k in range(40 - depth)]


@pytest.mark.filterwarnings("ignore:.*Delay object.*never used")
def test_refuses_to_look_ahead() -> None:
    with pytest.raises(ValueError, match="depth is -1"):
        Delay(1, -1)
    gc.collect()  # Amaranth complains of the half-made object when it goes, which is to be now


@pytest.mark.parametrize("depth", [2, DEEP, CHAINED + 3])
@pytest.mark.parametrize("registers", [None, False])
@pytest.mark.parametrize("rate", [1.0, 0.6])
def test_a_ring_is_never_read_where_it_is_written(
    depth: int, registers: bool | None, rate: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Synthesis is told so, and builds nothing that gives the old word."""
    pairs: list[list] = []

    class Watched(Memory):
        def write_port(self, **kwargs):
            pairs.append([port := super().write_port(**kwargs)])
            return port

        def read_port(self, **kwargs):
            pairs[-1].append(port := super().read_port(**kwargs))
            return port

    monkeypatch.setattr("softdepth.hdl.memory.delay.Memory", Watched)
    dut = Delay(4, depth, registers=registers)
    simulator = Simulator(dut)
    simulator.add_clock(1e-6)
    random, met = Random(depth), []

    async def bench(ctx) -> None:
        for _ in range(3 * depth + 20):
            ctx.set(dut.en, random.random() < rate)
            met.extend(
                ctx.get(write.addr)
                for write, read in pairs
                if ctx.get(write.en & read.en & (write.addr == read.addr))
            )
            await ctx.tick()

    simulator.add_testbench(bench)
    simulator.run()
    assert pairs or (registers is None and depth <= REGISTER_LIMIT)
    assert met == []
    assert "COLLISION_X_MASK 1'0" not in waive_collisions(rtlil.convert(dut, emit_src=False))
