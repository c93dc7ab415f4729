"""The package's bench: registers and frames in, and what must come back, in plain SystemVerilog."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

from softdepth.export.bench_frames import FRAMES, bench_frames
from softdepth.export.streams import streams_of
from softdepth.hdl.axi.tdata import outcome_layout, pair_bits
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.registers import WORD_BITS, Register, registers
from softdepth.templates import render

SLACK = 2000
"""Clocks that any part of the core may take without a word, beyond those of a frame."""


@dataclass(frozen=True)
class Step:
    """An access: `task` is ``write``, or ``check`` for a read whose value is known."""

    task: str
    register: str
    address: int
    value: int
    meaning: str


def bench(config: Config, name: str, options: AxiOptions, ports: Sequence[dict[str, Any]]) -> dict[str, str]:
    """The bench and the words it sends and compares, by the names of the files.

    Parameters
    ----------
    ports : of the core, each with its name, direction (``in``, ``out``) and width.
    """
    frames = bench_frames(config, left=options.left)
    described = {register.name: register for register in registers(config, options)}
    size = frames.height << _low(described["GEOMETRY"], "geometry_height")
    seen = size | frames.width << _low(described["SEEN"], "seen_width")
    word = (1 << WORD_BITS) - 1

    def step(task: str, register: str, value: int, meaning: str) -> Step:
        return Step(task, register, described[register].address, value, meaning)

    constants = {
        each.name: sum(field.reset << field.low for field in each.fields) & word
        for each in described.values()
        if each.name in ("IDENTITY", "VERSION", "CONFIG_LOW", "CONFIG_HIGH")
    }
    before = [
        *(
            step("check", register, value, described[register].meaning)
            for register, value in constants.items()
        ),
        step("write", "GEOMETRY", size, "the frames' height, so that the first one's end is known"),
        step("write", "INTERRUPTS", 1, "irq tells that a frame has left"),
    ]
    after = [
        step("check", "FRAMES", FRAMES, "all have left"),
        step("check", "SEEN", seen, "of this size"),
        step("check", "FLAGS", 1, "and without a fault"),
        step("write", "FLAGS", 1, "cleared"),
        step("check", "FLAGS", 0, "none is left"),
    ]
    text = render(
        "softdepth.export",
        "bench.sv",
        name=name,
        config=config,
        version=version("softdepth"),
        ports=ports,
        bus=options.bus,
        streams=inputs(config, ports),
        frames=frames,
        count=FRAMES,
        patience=frames.height * (frames.width + config.disparities) * config.steps + SLACK,
        bits={
            "s_axis": pair_bits(config.pixel),
            "m_axis": outcome_layout(config, left=options.left).size,
            "address": max(each.address for each in described.values()).bit_length(),
        },
        before=before,
        after=after,
    )
    return {
        f"{name}_bench.sv": text,
        f"{name}_bench_in.hex": frames.sent,
        f"{name}_bench_out.hex": frames.expected,
    }


def inputs(config: Config, ports: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """The inputs: prefix and clock of each stream, and which bits of the words it takes."""
    coming = [each for each in streams_of(ports) if each.sink]
    if len(coming) == 1:
        bits = [(0, pair_bits(config.pixel))]
    else:
        size = config.pixel.size
        bits = [(number * size, size) for number in range(len(coming))]
    return [
        {"prefix": each.prefix, "clock": each.clock, "low": low, "width": width}
        for each, (low, width) in zip(coming, bits, strict=True)
    ]


def _low(register: Register, field: str) -> int:
    """A field's lowest bit."""
    return next(each.low for each in register.fields if each.name == field)
