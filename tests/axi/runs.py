"""Runs of the AXI core in Verilator, and what must come out."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from softdepth.golden import fixed_model
from softdepth.golden.front.pair import Image
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.axi.tdata import outcome_layout
from softdepth.hdl.text.rtlil import ports_of
from softdepth.hdl.verilog import to_verilog
from softdepth.sim.build import TOP, build
from softdepth.sim.stream import simulate
from softdepth.spec.axi_options import DEFAULT, AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.registers import UNSURE, registers
from softdepth.spec.validity import Validity
from tests.axi.bench import JOB_VARIABLE

BYTE = np.uint64(8)
ORDER = (1, 2, 0)
"""UG934: green lowest, then blue, then red."""
HAS_DISPARITY = (Validity.FULL, Validity.PARTIAL, Validity.FILLED)

SMALL = Config.preset("robust-small").override(
    [
        *("max_width=40", "max_height=24", "disparities=6", "lanes=3"),
        *("criteria.0.rows=3", "criteria.0.columns=3", "post.island=6"),
        *("post.fill=false", "post.median=0", "post.masked_median=2", "post.colour_bits=8"),
    ]
)
"""A core with everything that a register sets."""


@dataclass(frozen=True)
class Design:
    """A core that is simulated."""

    config: Config
    options: AxiOptions = DEFAULT

    @property
    def views(self) -> tuple[str, ...]:
        """What its input streams are called; one has no name."""
        return ("left", "right") if self.options.two else ("",)

    @property
    def addresses(self) -> dict[str, int]:
        """Of its registers."""
        return {r.name: r.address for r in registers(self.config, self.options)}

    @property
    def result_bytes(self) -> int:
        """Of a result."""
        return outcome_layout(self.config, left=self.options.left).size // 8


ROBUST = Design(SMALL, AxiOptions(left=True))
PAPER = Design(
    Config.preset("paper").override(
        [
            *("max_width=32", "max_height=12", "disparities=6", "lanes=2", "criteria.2.window=5"),
            *("compensation.reading=top", "compensation.threshold=600", "compensation.from_disparity=2"),
        ]
    ),
    AxiOptions(inputs="two", skew=2, clocks="own", left=True),
)
"""A core of the other kind, with a stream a view, each of its own clock."""
ADDRESSES = ROBUST.addresses


@dataclass
class Steps:
    """What the bench does, on each input stream of `design` for itself."""

    design: Design = ROBUST
    views: dict[str, list[dict[str, Any]]] = field(default_factory=dict)

    def line(self, left: Image, right: Image, *sof: bool) -> None:
        """A line of both views, W x 3; `sof` of its pixels, the rest of them none."""
        if self.design.options.two:
            self.view("left", left, *sof)
            self.view("right", right, *sof)
        else:
            self._line("", np.concatenate([left[:, ORDER], right[:, ORDER]], axis=1), sof)

    def view(self, name: str, pixels: Image, *sof: bool) -> None:
        """A line of one view."""
        self._line(name, pixels[:, ORDER], sof)

    def lines(self, left: Image, right: Image, rows: range) -> None:
        """Lines of a frame."""
        for y in rows:
            self.line(left[y], right[y], y == 0)

    def write(self, name: str, value: int) -> None:
        """A register of 32 bits; of two streams, the left one waits for it."""
        self._of(self.design.views[0]).append({"write": [self.design.addresses[name], value]})

    def _line(self, name: str, pixels: Image, sof: tuple[bool, ...]) -> None:
        starts = [k for k, begins in enumerate(sof) if begins]
        self._of(name).append({"line": pixels.tobytes().hex(), "sof": starts})

    def _of(self, name: str) -> list[dict[str, Any]]:
        return self.views.setdefault(name, [])


@dataclass(frozen=True)
class Outcome:
    """What came out: frames of the words of ``m_axis_tdata``, registers, ``irq``, registers after resets."""

    frames: list[NDArray[np.uint64]]
    registers: dict[str, int]
    irq: int
    after_resets: list[dict[str, int]]


@cache
def program(design: Design) -> Path:
    """The simulated core."""
    return built(design, to_verilog(AxiCore(design.config, design.options), TOP))


def built(design: Design, verilog: str) -> Path:
    """What has the ports of a design's core, simulated."""
    ports = ports_of(AxiCore(design.config, design.options))
    names = {way: [p.name for p in ports if p.flow.name == way] for way in ("In", "Out")}
    return build(verilog, inputs=names["In"], outputs=names["Out"]).folder


def run(
    steps: Steps,
    folder: Path,
    *,
    seed: int = 0,
    idle: float = 0.0,
    pressure: float = 0.0,
    resets: Sequence[int] = (),
    cut: Steps | None = None,
    core: Path | None = None,
) -> Outcome:
    """Runs the bench; frames must be whole.

    Parameters
    ----------
    resets, cut : before anything else, steps that are ended by a reset after so many clocks, once for each.
    core : the program, if not that of the design's own Verilog.
    """
    path = folder / "job.json"
    design, size = steps.design, steps.design.result_bytes
    job = {
        "seed": seed,
        "idle": idle,
        "pressure": pressure,
        "views": steps.views,
        "resets": list(resets),
        "cut": cut.views if cut else {},
        "registers": design.addresses,
    }
    path.write_text(json.dumps(job))
    ended = simulate(core or program(design), "tests.axi.bench", folder, {JOB_VARIABLE: str(path)})
    out = path.with_suffix(".out")
    assert ended, (folder / "log").read_text()[-2000:]
    came = json.loads(out.read_text())
    frames: list[list[NDArray[np.uint64]]] = []
    for line in came["lines"]:
        if line["sof"]:
            assert line["sof"] == list(range(size)), "start of frame within a line"
            frames.append([])
        found = np.frombuffer(bytes.fromhex(line["data"]), np.uint8).reshape(-1, size).astype(np.uint64)
        frames[-1].append(np.bitwise_or.reduce(found << BYTE * np.arange(size, dtype=np.uint64), axis=1))
    whole = [np.stack(frame) for frame in frames]
    return Outcome(whole, came["registers"], came["irq"], came["after_resets"])


def expected(
    left: Image,
    right: Image,
    config: Config = SMALL,
    *,
    floor: int = 0,
    invalid: int = 0,
    pixels: bool = True,
) -> NDArray[np.uint64]:
    """The words of a frame's results, of the fixed model and plain arithmetic, with the left `pixels`."""
    result = fixed_model.disparity(left, right, config)
    code = result.code.astype(np.uint64)
    sure = np.zeros_like(code)
    if result.confidence is not None:
        sure = result.confidence.astype(np.uint64)
        code[(code < Validity.BORDER) & (sure < floor)] = UNSURE
    value = np.where(np.isin(code, HAS_DISPARITY), result.disparity, invalid).astype(np.uint64)
    words = value | code << np.uint64(16) | sure << np.uint64(24)
    if pixels:
        above = np.uint64(24 if result.confidence is None else 32)
        for place, channel in enumerate(ORDER):
            words |= left[..., channel].astype(np.uint64) << above + BYTE * np.uint64(place)
    return words
