"""Runs in the simulator: a board's serial pins joined to a pseudo-terminal, with faults on the way.

`tests.board.simulated` starts it, and tells it what to do through a JSON file.
"""

import json
import os
import random
import time
import tty
from pathlib import Path
from typing import Any

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, Timer

from softdepth.spec.protocol import FLAG

PLAN_VARIABLE = "SOFTDEPTH_BOARD_PLAN"
CLOCK_STEPS = 2
CHUNK = 4096
IDLE_SECONDS = 0.0005


class Wire:
    """One direction of the line, and what happens to its bytes.

    Faults are given as shares of the bytes: ``flip`` inverts a bit, ``drop`` loses the byte. Or of the
    packets: ``truncate`` loses its second half, ``double`` sends it twice. ``lead`` is garbage before the
    first byte.
    """

    def __init__(self, seed: int, faults: dict[str, Any]) -> None:
        self.random = random.Random(seed)
        self.faults = faults
        self.bytes = 0
        self.struck = 0
        self.packet = bytearray()

    def pass_on(self, data: bytes) -> bytes:
        """What arrives of bytes that were sent."""
        if not self.bytes and data:
            data = bytes(self.faults.get("lead", ())) + data
        self.bytes += len(data)
        out = bytearray()
        for byte in data:
            out += self._byte(byte)
        return bytes(out)

    def _byte(self, byte: int) -> bytes:
        if self._strikes("drop"):
            return b""
        if self._strikes("flip"):
            byte ^= 1 << self.random.randrange(8)
        if not (self.faults.get("truncate") or self.faults.get("double")):
            return bytes([byte])
        self.packet.append(byte)
        if byte != FLAG or len(self.packet) < 2:
            return b""
        packet, self.packet = bytes(self.packet), bytearray()
        if self._strikes("truncate"):
            return packet[: len(packet) // 2]
        return packet * 2 if self._strikes("double") else packet

    def _strikes(self, fault: str) -> bool:
        struck = self.random.random() < self.faults.get(fault, 0)
        self.struck += struck
        return struck


class Bridge:
    """The pins of one simulated board, and the pseudo-terminal that a host opens."""

    def __init__(self, dut: Any, plan: dict[str, Any]) -> None:
        self.dut = dut
        self.plan = plan
        self.bit = plan["divisor"] * CLOCK_STEPS
        self.to_board = Wire(1, plan["to_board"])
        self.to_host = Wire(2, plan["to_host"])
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        self.busy = False

    def read(self) -> bytes:
        try:
            return os.read(self.master, CHUNK)
        except BlockingIOError:
            return b""

    async def drive(self) -> None:
        """Host to board, until the plan's end."""
        rx, stop = self.dut.rx, Path(self.plan["stop"])
        unplug = self.plan.get("unplug")
        level = 1
        while True:
            data = self.to_board.pass_on(self.read())
            for byte in data:
                # start bit, data, stop bit: one wait for each run of equal bits
                bits, run = (byte << 1) | 0x200, 0
                for k in range(10):
                    value = (bits >> k) & 1
                    if value != level:
                        if run:
                            await Timer(run * self.bit, unit="step")
                        rx.value = level = value
                        run = 0
                    run += 1
                await Timer(run * self.bit, unit="step")
            if unplug is not None and self.to_board.bytes >= unplug:
                os.close(self.master)
                os.close(self.slave)
                return
            if not data:
                if stop.exists():
                    return
                await Timer(20 * self.bit, unit="step")
                if not self.busy:
                    time.sleep(IDLE_SECONDS)

    async def listen(self) -> None:
        """Board to host, for ever."""
        tx, fall = self.dut.tx, FallingEdge(self.dut.tx)
        while True:
            self.busy = False
            await fall
            self.busy = True
            await Timer(self.bit * 3 // 2, unit="step")
            byte = int(tx.value)
            for k in range(1, 8):
                await Timer(self.bit, unit="step")
                byte |= int(tx.value) << k
            await Timer(self.bit, unit="step")
            assert int(tx.value) == 1, "the board sent no stop bit"
            if out := self.to_host.pass_on(bytes([byte])):
                os.write(self.master, out)


@cocotb.test()
async def bridge(dut: Any) -> None:
    """Be a board until told to stop; then write what was seen."""
    plan = json.loads(Path(os.environ[PLAN_VARIABLE]).read_text())
    dut.rx.value = 1
    dut.button.value = 0
    Clock(dut.clk, CLOCK_STEPS, unit="step").start(start_high=False)
    ends = Bridge(dut, plan)
    await Timer(600 * CLOCK_STEPS, unit="step")  # the reset after power-up
    path = Path(plan["ready"])
    part = path.with_suffix(".part")
    part.write_text(os.ttyname(ends.slave))
    part.rename(path)
    listener = cocotb.start_soon(ends.listen())
    await ends.drive()
    listener.cancel()
    record = {
        "led": int(dut.led.value),
        "to_board": [ends.to_board.bytes, ends.to_board.struck],
        "to_host": [ends.to_host.bytes, ends.to_host.struck],
    }
    Path(plan["record"]).write_text(json.dumps(record))
