"""``softdepth info``: what a configuration amounts to, before anything is built."""

from typing import TYPE_CHECKING, Annotated

import typer
from rich.table import Table

from softdepth import screen
from softdepth.cli import metres, options
from softdepth.cli.bundle import bundled
from softdepth.spec.config import MULTIPLIER_BITS, Config
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.rig.geometry import Geometry

DEPTHS = (1, 2, 5, 10)
"""Depths in metres at which the depth step is printed."""


@bundled
def info(
    choice: options.Choice,
    cameras: metres.Cameras,
    clock: Annotated[
        float, typer.Option("--clock", metavar="MHZ", help="Clock frequency that your device reaches.")
    ] = 100.0,
    width: Annotated[int, typer.Option("--width", metavar="N", help="Columns of a frame.")] = 640,
    height: Annotated[int, typer.Option("--height", metavar="N", help="Rows of a frame.")] = 480,
) -> None:
    """Show widths, latency, memory and speed of a configuration; with cameras, its range in metres."""
    chosen = choice.configuration()
    _check(chosen, clock, width, height)
    table = Table("", "", box=None, show_header=False, title=f"{chosen.name} ({chosen.hash})")
    table.title_justify = "left"
    depth = metric_facts(chosen, cameras.geometry(None)) if cameras.given else {}
    for row in (facts(chosen, clock, width, height) | depth).items():
        table.add_row(*row)
    screen.console().print(table)


def facts(config: Config, clock: float, width: int, height: int) -> dict[str, str]:
    """What follows from a configuration, as label and text; `clock` in MHz, the frame in pixels."""
    from softdepth.hdl.band_latency import BandLatency
    from softdepth.hdl.built import missing
    from softdepth.hdl.costs.comparison import by_windows
    from softdepth.hdl.signatures import pair_layout, result_layout

    if gaps := missing(config):
        return _facts_of_any(config) | {"gateware": f"none of {', '.join(gaps)}: models alone"}
    if not by_windows(config):
        return _facts_of_whole(config, clock, width, height)
    band = BandLatency.of(config)
    line_bits, row_bits = memory_bits(config)
    cycles = width * height * config.steps
    return {
        "candidates": f"{config.min_disparity} to {config.max_disparity}, {config.lanes} per clock",
        "clocks per pixel": str(config.steps),
        "smallest frame": f"{config.min_width} x {config.min_height} pixels",
        "disparity": f"{config.result_bits} bits{', signed' if config.signed else ''}",
        "input payload": f"{pair_layout(config.pixel).size} bits",
        "output payload": f"{result_layout(config).size} bits",
        "latency": f"{band.idle} clocks after the last pixel of its window",
        "latency at full rate": f"{band.full_rate} clocks where pixels are always on offer",
        "line buffer": f"{line_bits} bits, {config.column_rows - 1} lines of {config.max_width} pixel pairs",
        "row memories": f"{row_bits} bits, {config.stored_rows} rows of {config.places} costs in each lane",
        "multipliers": f"{config.multipliers} of {MULTIPLIER_BITS} x {MULTIPLIER_BITS} bits",
        "clocks per frame": f"{cycles} at {width}x{height}",
        "frames per second": f"{clock * 1e6 / cycles:.1f} at {clock:g} MHz",
    }


def metric_facts(config: Config, geometry: "Geometry") -> dict[str, str]:
    """From where to where a configuration measures behind these cameras, and how finely."""
    from softdepth.metric.reach import Reach

    reach = Reach.of(geometry, config)
    if reach.disparities is None:
        return {"depth": f"none: no candidate is above -doffs = {-geometry.doffs:g} px"}
    low, high = reach.disparities
    steps = {at: reach.step(at) for at in DEPTHS}
    return {
        "depth": f"{reach.nearest:.3f} m ({high:g} px) to {reach.farthest:.3f} m ({low:g} px)",
        "depth step": ", ".join(
            f"{at} m: " + ("none" if step is None else f"{1000 * step:.1f} mm") for at, step in steps.items()
        ),
    }


def _facts_of_any(config: Config) -> dict[str, str]:
    """What is known about a configuration without asking its gateware."""
    below = max(c.below for c in config.criteria) + config.post.below
    return {
        "candidates": f"{config.min_disparity} to {config.max_disparity}, {config.lanes} per clock",
        "smallest frame": f"{config.min_width} x {config.min_height} pixels",
        "disparity": f"{config.result_bits} bits, {config.post.fraction_bits} of them below a pixel",
        "latency": f"{below} rows below a result's own are seen first",
    }


def _facts_of_whole(config: Config, clock: float, width: int, height: int) -> dict[str, str]:
    """The same of a core with descriptors, whose stages hold their input back beyond a frame's edges."""
    from softdepth.hdl.signatures import pair_layout, result_layout
    from softdepth.hdl.whole_latency import WholeLatency

    whole = WholeLatency.of(config)
    cycles = whole.frame_clocks(width, height, config.steps)
    return {
        **_facts_of_any(config),
        "clocks per pixel": str(config.steps),
        "input payload": f"{pair_layout(config.pixel).size} bits",
        "output payload": f"{result_layout(config).size} bits",
        "latency": f"{whole.clocks} clocks after column {whole.column} of the line {whole.rows} below,"
        f" of lines from {whole.narrowest} pixels on",
        "multipliers": f"{config.multipliers} of {MULTIPLIER_BITS} x {MULTIPLIER_BITS} bits",
        "clocks per frame": f"{cycles} at {width}x{height}",
        "frames per second": f"{clock * 1e6 / cycles:.1f} at {clock:g} MHz",
    }


def memory_bits(config: Config) -> tuple[int, int]:
    """Bits of the core's line buffer, and of the row memories of all its lanes."""
    from softdepth.hdl.asked import asked
    from softdepth.hdl.costs.criteria.column_sad import column_maximum
    from softdepth.hdl.costs.criteria.row_memory import RowMemory
    from softdepth.hdl.front.line_buffer import LineBuffer

    with asked():
        lines = LineBuffer(2 * config.pixel.size, config.column_rows, config.max_width).bits
        rows = RowMemory(range(column_maximum(1, config.pixel) + 1), config.stored_rows, config.places).bits
    return lines, config.lanes * rows


def _check(config: Config, clock: float, width: int, height: int) -> None:
    if not 0 < clock < float("inf"):
        raise InputError(f"--clock {clock:g} is not a frequency", "give MHz, for example --clock 100")
    if width < config.min_width or height < config.min_height:
        raise InputError(
            f"--width {width} --height {height} is too small a frame",
            f"the smallest is --width {config.min_width} --height {config.min_height}",
        )
    frame = {"max_width": ("--width", width), "max_height": ("--height", height)}
    exceeded = {key: given for key, given in frame.items() if given[1] > getattr(config, key)}
    if exceeded:
        raised = [part for key, (_, value) in exceeded.items() for part in ("--set", f"{key}={value}")]
        limits = " and ".join(f"{key} = {getattr(config, key)}" for key in exceeded)
        given = " ".join(f"{option} {value}" for option, value in exceeded.values())
        raise InputError(f"{given} is more than {limits}", f"run: {options.command(*raised)}")
