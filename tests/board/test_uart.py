"""Serial transmitter and receiver, bit by bit."""

from collections.abc import Sequence

import pytest
from amaranth.hdl import Signal
from amaranth.sim import SimulatorContext

from softdepth.hdl.boards.serial.receiver import MIN_DIVISOR, UartReceiver
from softdepth.hdl.boards.serial.transmitter import UartTransmitter
from tests.support.simulation import simulate

BYTES = (0x00, 0xFF, 0x55, 0xAA, 0x01, 0x80, 0x7E, 0x7D)


def bits_of(byte: int) -> list[int]:
    """Start bit, data, stop bit."""
    return [0, *((byte >> k) & 1 for k in range(8)), 1]


def receive(divisor: int, levels: Sequence[int]) -> list[tuple[int, int]]:
    """Data and ``broken`` of each byte that a receiver finds on a line, given clock by clock."""
    dut = UartReceiver(divisor)
    found: list[tuple[int, int]] = []

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        for level in [1] * 10 + list(levels) + [1] * 20 * divisor:
            ctx.set(dut.rx, level)
            _, _, valid, data, broken = await ctx.tick().sample(dut.valid, dut.data, dut.broken)
            if valid:
                found.append((data, broken))

    simulate(dut, bench)
    return found


def line(values: Sequence[int], clocks: float) -> list[int]:
    """Bytes back to back on a line, with a number of clocks per bit that need not be whole."""
    bits = [bit for value in values for bit in bits_of(value)]
    return [bits[int(t / clocks)] for t in range(int(len(bits) * clocks))]


@pytest.mark.parametrize("divisor", [MIN_DIVISOR, 5, 25])
def test_transmitter_sends_whole_bits(divisor):
    dut = UartTransmitter(divisor)
    levels: list[int] = []

    async def bench(ctx: SimulatorContext, rst: Signal) -> None:
        ctx.set(dut.i.payload, 0xA6)
        ctx.set(dut.i.valid, 1)
        for _ in range(12 * divisor):
            *_, ready, tx = await ctx.tick().sample(dut.i.ready, dut.tx)
            levels.append(tx)
            if ready:
                ctx.set(dut.i.valid, 0)

    simulate(dut, bench)
    start = levels.index(0)
    sent = [bit for bit in bits_of(0xA6) for _ in range(divisor)]
    assert levels[start : start + 10 * divisor] == sent
    assert set(levels[:start]) | set(levels[start + 10 * divisor :]) == {1}


@pytest.mark.parametrize(("divisor", "off"), [(MIN_DIVISOR, 0.0), (25, 0.03), (25, -0.03), (12, 0.02)])
def test_receiver_bears_a_rate_that_is_off(divisor, off):
    assert receive(divisor, line(BYTES, divisor * (1 + off))) == [(byte, 0) for byte in BYTES]


def test_a_missing_stop_bit_is_told_and_survived():
    divisor = 8
    levels = line([0x42], divisor)
    broken = levels[: 9 * divisor] + [0] * 5 * divisor  # the line stays low
    found = receive(divisor, broken + [1] * divisor + line([0x99], divisor))
    assert found == [(0x42, 1), (0x99, 0)]


def test_a_glitch_is_no_byte():
    divisor = 16
    assert receive(divisor, [0] * 5 + [1] * 40 + line([0x3C], divisor)) == [(0x3C, 0)]


def test_too_few_clocks_are_refused():
    with pytest.raises(ValueError, match="divisor is 3"):
        UartReceiver(3)
