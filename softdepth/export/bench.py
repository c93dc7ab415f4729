"""The package's bench: registers and frames in, and what must come back, in plain SystemVerilog."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

from softdepth.export.bench_frames import FRAMES, bench_frames
from softdepth.hdl.axi.inputs import VIEWS
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
    frames = bench_frames(config)
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
        streams=streams(config, options),
        frames=frames,
        count=FRAMES,
        patience=frames.height * (frames.width + config.disparities) * config.steps + SLACK,
        bits={
            "s_axis": pair_bits(config.pixel),
            "m_axis": outcome_layout(config).size,
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


def streams(config: Config, options: AxiOptions) -> list[dict[str, Any]]:
    """The inputs: prefix and clock of each stream, and which bits of the words it takes."""
    if not options.two:
        return [{"prefix": "s_axis", "clock": "aclk", "low": 0, "width": pair_bits(config.pixel)}]
    size = config.pixel.size
    views = [{"prefix": f"s_axis_{view}", "low": k * size, "width": size} for k, view in enumerate(VIEWS)]
    return [
        {**view, "clock": f"{view['prefix']}_aclk" if options.clocks == "own" else "aclk"} for view in views
    ]


def _low(register: Register, field: str) -> int:
    """A field's lowest bit."""
    return next(each.low for each in register.fields if each.name == field)
