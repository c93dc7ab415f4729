"""Runs of the AXI core in Verilator, and what must come out."""

import json
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden import fixed_model
from softdepth.golden.front.pair import Image
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.text.rtlil import ports_of
from softdepth.hdl.verilog import to_verilog
from softdepth.sim.build import TOP, build
from softdepth.sim.stream import simulate
from softdepth.spec.config import Config
from softdepth.spec.registers import UNSURE, registers
from softdepth.spec.validity import Validity
from tests.axi.bench import JOB_VARIABLE

ORDER = (1, 2, 0)
"""UG934: green lowest, then blue, then red."""
HAS_DISPARITY = (Validity.FULL, Validity.PARTIAL, Validity.FILLED)

SMALL = Config.preset("robust-small").override(
    [
        *("max_width=40", "max_height=24", "disparities=6", "lanes=3"),
        *("criteria.0.rows=3", "criteria.0.columns=3", "post.island=6"),
        *("post.fill=false", "post.median=0", "post.masked_median=0"),
    ]
)
"""A core with everything that a register sets."""


@dataclass
class Steps:
    """What the bench does."""

    steps: list[dict[str, Any]] = field(default_factory=list)

    def line(self, left: Image, right: Image, *sof: bool) -> None:
        """A line of both views, W x 3; `sof` of its pixels, the rest of them none."""
        both = np.concatenate([left[:, ORDER], right[:, ORDER]], axis=1)
        self.steps.append(
            {"line": both.tobytes().hex(), "sof": [k for k, starts in enumerate(sof) if starts]}
        )

    def lines(self, left: Image, right: Image, rows: range) -> None:
        """Lines of a frame."""
        for y in rows:
            self.line(left[y], right[y], y == 0)

    def write(self, name: str, value: int) -> None:
        """A register of 32 bits."""
        self.steps.append({"write": [ADDRESSES[name], value]})


ADDRESSES = {register.name: register.address for register in registers(SMALL)}


@dataclass(frozen=True)
class Outcome:
    """What came out: frames of the words of ``m_axis_tdata``, registers, and ``irq``."""

    frames: list[NDArray[np.uint32]]
    registers: dict[str, int]
    irq: int


@cache
def program() -> Path:
    """The simulated core of `SMALL`."""
    core = AxiCore(SMALL)
    ports = ports_of(core)
    names = {way: [p.name for p in ports if p.flow.name == way] for way in ("In", "Out")}
    return build(to_verilog(core, TOP), inputs=names["In"], outputs=names["Out"]).folder


def run(steps: Steps, folder: Path, *, seed: int = 0, idle: float = 0.0, pressure: float = 0.0) -> Outcome:
    """Runs the bench; frames must be whole."""
    path = folder / "job.json"
    job = {"seed": seed, "idle": idle, "pressure": pressure, "steps": steps.steps, "registers": ADDRESSES}
    path.write_text(json.dumps(job))
    ended = simulate(program(), "tests.axi.bench", folder, {JOB_VARIABLE: str(path)})
    out = path.with_suffix(".out")
    assert ended, (folder / "log").read_text()[-2000:]
    came = json.loads(out.read_text())
    frames: list[list[NDArray[np.uint32]]] = []
    for line in came["lines"]:
        if line["sof"]:
            assert line["sof"] == [0, 1, 2, 3], "start of frame within a line"
            frames.append([])
        frames[-1].append(np.frombuffer(bytes.fromhex(line["data"]), "<u4"))
    return Outcome([np.stack(frame) for frame in frames], came["registers"], came["irq"])


def expected(
    left: Image, right: Image, config: Config = SMALL, *, floor: int = 0, invalid: int = 0
) -> NDArray[np.uint32]:
    """The words of a frame's results, of the fixed model and plain arithmetic."""
    result = fixed_model.disparity(left, right, config)
    assert result.confidence is not None
    code = result.code.astype(int)
    sure = result.confidence.astype(int)
    code[(code < Validity.BORDER) & (sure < floor)] = UNSURE
    value = np.where(np.isin(code, HAS_DISPARITY), result.disparity, invalid)
    words = value | code << 16 | sure << 24
    return words.astype(np.uint32)
