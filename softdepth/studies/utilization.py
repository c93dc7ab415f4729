"""Area and speed of a core, measured: placed and routed on an ECP5 by nextpnr, without a board around it."""

import contextlib
import hashlib
import json
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Self

from pydantic import BaseModel, model_validator

from softdepth.files import cache_folder, write_atomically
from softdepth.flow.blocks import Block, blocks
from softdepth.flow.families import FAMILIES, Part
from softdepth.flow.measuring_top import MeasuringTop
from softdepth.flow.route import Routed, place_and_route
from softdepth.flow.stages import Stages
from softdepth.flow.synthesis import synthesise
from softdepth.flow.tools import find_tool
from softdepth.spec.config import Config, Operator
from softdepth.spec.errors import InputError
from softdepth.spec.presets import PRESETS

PART = Part("ecp5", "LFE5U-85F", "CABGA381", "6")
AIM_MHZ = 150.0
"""The clock that nextpnr is told to aim at: more than most cores reach, so that it never stops early."""

DISPARITIES, WIDTH = 64, 1280
SUM = "sum"
"""What stands for the operator of a core whose cost is a sum of its criteria."""


class Row(BaseModel):
    """A configuration, its area and its speed.

    Members
    -------
    operator : of the fuzzy stage; `SUM` where the cost is a sum of criteria and there is none.
    width : the longest line, in pixels.
    lut4 : nextpnr's ``Total LUT4s``: a carry cell counts as two, distributed RAM as the LUTs it takes.
    ff, ebr, dsp : flip-flops, block RAMs of 18 kbit, multipliers of 18x18 bits.
    mpixel_s : million pixels a second, `fmax_mhz` over `cycles_per_pixel`.
    mde_s : million disparity evaluations a second, `mpixel_s` times `disparities`.
    mde_s_per_klut : the same for each thousand `lut4`.
    lut4_per_lane : everything included, divided by the lanes.
    """

    device: str
    preset: str
    operator: str
    disparities: int
    lanes: int
    width: int
    lut4: int
    ff: int
    ebr: int
    dsp: int
    fmax_mhz: float
    cycles_per_pixel: int
    mpixel_s: float
    mde_s: float
    mde_s_per_klut: float
    lut4_per_lane: float

    @model_validator(mode="after")
    def _say_sum(self) -> Self:
        """Rows written when the operator's default stood for none."""
        if self.preset in PRESETS:
            self.operator = operator_of(self.preset, self.operator)
        return self


class Measurement(BaseModel):
    """A row, and what is known of the run that gave it.

    Members
    -------
    key : changes with all that nextpnr was given: netlist, options, part, aim, seed and its own version.
    but_for_seed : changes with all of these but the seed; empty in earlier measurements.
    wrapper_lut4, wrapper_ff : what of the row's figures is not the core but the shift registers around it.
    critical_path : what limits `Row.fmax_mhz`.
    blocks : cells by block of the core.
    seconds : wall-clock time of each stage.
    """

    row: Row
    key: str
    but_for_seed: str = ""
    config_hash: str
    seed: int
    wrapper_lut4: int
    wrapper_ff: int
    critical_path: str
    blocks: list[Block]
    seconds: dict[str, float]


class Selection(BaseModel, frozen=True):
    """What names a row, written ``PRESET/OPERATOR/LANES``, optionally followed by ``/DEVICE``.

    Members
    -------
    operator : of the fuzzy stage; anything, best `SUM`, for a preset without one.
    device : an ECP5, placed in the package and speed grade of `PART`.
    width : the longest line, where it is another than what is asked for.
    """

    preset: str
    operator: Operator
    lanes: int
    device: str = PART.device
    width: int | None = None

    def __str__(self) -> str:
        return row_name(self.preset, operator_of(self.preset, self.operator), self.lanes, self.device)

    @property
    def part(self) -> Part:
        """What is measured on."""
        return replace(PART, device=self.device)

    def config(self, disparities: int = DISPARITIES, width: int = WIDTH) -> Config:
        """The configuration that is measured."""
        values = [
            f"lanes={self.lanes}",
            f"disparities={disparities}",
            f"max_width={self.width if self.width is not None else width}",
        ]
        if operator_of(self.preset, self.operator) != SUM:
            values.append(f"operator={self.operator}")
        return Config.preset(self.preset).override(values)


def row_name(preset: str, operator: str, lanes: int, device: str) -> str:
    """What a row is called: with its device unless that is the usual one."""
    usual = device.startswith(PART.device)
    return "/".join((preset, operator, str(lanes), *(() if usual else (device,))))


def operator_of(preset: str, operator: str) -> str:
    """The operator of a preset's fuzzy stage; `SUM` where it has none."""
    return SUM if Config.preset(preset).cost == "sum" else operator


def measure(
    config: Config, preset: str, *, part: Part = PART, seed: int = 1, known: Iterable[Measurement] = ()
) -> Measurement:
    """Synthesise, place and route a core and take its figures.

    If a netlist was placed and routed before, with the same seed and options and by the same nextpnr, the
    figures are taken from `known` or from the cache, because this is what takes hours.

    Parameters
    ----------
    config : the core.
    preset : what the row calls it.
    known : earlier measurements.

    Raises `ConfigError` for a core that does not fit, and `ToolError` for a missing or failed tool.
    """
    top = MeasuringTop(config)
    name = row_name(preset, operator_of(preset, config.operator), config.lanes, part.device)
    stages = Stages(f"{name}, {config.disparities} disparities")
    with tempfile.TemporaryDirectory(prefix="softdepth-") as temporary:
        work = Path(temporary)
        with stages.stage("synthesis"):
            options = FAMILIES[part.family].synthesis_options(part)
            netlist = synthesise(top, part.family, work, options=options)
        given = [preset, str(part), AIM_MHZ, *_nextpnr(part)]
        but_for_seed = _key((work / "netlist.json").read_bytes(), given)
        key = _key(but_for_seed.encode(), [seed])
        kept = cache_folder() / "flow" / "rows" / f"{key}.json"
        for earlier in known:
            if earlier.key == key:
                return earlier
        if kept.is_file():
            return Measurement.model_validate_json(kept.read_text())
        with stages.stage("place and route"):
            routed = place_and_route(work, part, mhz=AIM_MHZ, seed=seed)
    found = Measurement(
        row=row_of(config, preset, part, routed),
        key=key,
        but_for_seed=but_for_seed,
        config_hash=config.hash,
        seed=seed,
        wrapper_lut4=top.lut4,
        wrapper_ff=top.flip_flops,
        critical_path=str(routed.clocks[0].path),
        blocks=blocks(netlist),
        seconds=stages.seconds,
    )
    with contextlib.suppress(OSError, InputError):  # without a cache the next run takes longer, no more
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(kept, found.model_dump_json(indent=1).encode())
    return found


def row_of(config: Config, preset: str, part: Part, routed: Routed) -> Row:
    """The row of a routed core: nextpnr's counts and what follows from them."""
    fmax = routed.clocks[0].fmax_mhz
    lut4 = routed.used("Total LUT4s")
    rate = fmax / config.steps
    evaluations = rate * config.disparities
    return Row(
        device=f"{part.device}-{part.speed}",
        preset=preset,
        operator=operator_of(preset, config.operator),
        disparities=config.disparities,
        lanes=config.lanes,
        width=config.max_width,
        lut4=lut4,
        ff=routed.used("Total DFFs"),
        ebr=routed.used("DP16KD"),
        dsp=routed.used("MULT18X18D"),
        fmax_mhz=round(fmax, 2),
        cycles_per_pixel=config.steps,
        mpixel_s=round(rate, 2),
        mde_s=round(evaluations, 1),
        mde_s_per_klut=round(1000 * evaluations / lut4, 1),
        lut4_per_lane=round(lut4 / config.lanes, 1),
    )


def _nextpnr(part: Part) -> list[str]:
    """What the part's nextpnr is called with, and its version."""
    family = FAMILIES[part.family]
    return [*family.place(part, "netlist", "placed", None), find_tool(family.placer).version]


def _key(content: bytes, facts: Sequence[object]) -> str:
    digest = hashlib.sha256(content)
    digest.update(json.dumps(facts).encode())
    return digest.hexdigest()[:20]
