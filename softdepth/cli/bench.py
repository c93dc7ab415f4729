"""``softdepth bench``: speed of the simulated gateware, of the models and of OpenCV, in one run."""

import json
import os
import platform
import time
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from softdepth import screen
from softdepth.run import measure
from softdepth.spec.config import PRESETS, Config
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair

BM_WINDOW = 15
"""Window of OpenCV's block matcher; it needs an odd size of at least 5."""
BM_REPEATS = 5


def bench(
    dataset: Annotated[
        str, typer.Option("--dataset", metavar="NAME", help="The pair to run.")
    ] = "motorcycle",
    rows: Annotated[
        int, typer.Option("--rows", metavar="N", min=32, help="Rows of it that are simulated.")
    ] = 96,
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="DIR", help="Folder of benchmarks.md and benchmarks.json."),
    ] = Path("docs"),
) -> None:
    """Measure speed and write it down, with the machine it was measured on."""
    from softdepth.files import write_atomically
    from softdepth.golden.data import datasets
    from softdepth.hdl.built import missing

    if not output.is_dir():
        raise InputError(f"folder '{output}' does not exist", "create it first, or choose another with -o")
    pair = datasets.load(dataset)
    figures = {
        "pair": pair.name,
        "width": pair.width,
        "height": pair.height,
        "simulated_rows": min(rows, pair.height),
        "machine": machine(),
        "presets": {
            name: _preset(config, pair, rows)
            for name in PRESETS
            if not missing(config := Config.preset(name))
        },
        "opencv_stereobm_seconds": _block_matcher(pair),
    }
    write_atomically(output / "benchmarks.json", (json.dumps(figures, indent=2) + "\n").encode())
    write_atomically(output / "benchmarks.md", page(figures).encode())
    print(f"results: {output / 'benchmarks.md'}, {output / 'benchmarks.json'}")


def machine() -> dict[str, str | int]:
    """What the figures depend on: processor, system and tools."""
    from softdepth.sim.toolchain import find_toolchain

    tools = find_toolchain()
    return {
        "processor": _processor(),
        "cores": os.cpu_count() or 1,
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "opencv": version("opencv-python-headless"),
        "verilator": tools.verilator_version,
        "compiler": tools.compiler_version,
    }


def page(figures: dict[str, Any]) -> str:
    """The figures as a Markdown page."""
    from softdepth.templates import render

    rows = [
        [
            name,
            p["disparities"],
            p["lanes"],
            f"{p['cycles_per_pixel']:.3f}",
            f"{p['sim_pixels_per_second']:,.0f}",
            f"{p['fixed_seconds']:.2f}",
            f"{p['float_seconds']:.2f}",
        ]
        for name, p in figures["presets"].items()
    ]
    values = {**figures, "rows": rows, "bm_window": BM_WINDOW}
    return render("softdepth.studies", "benchmarks.md", **values) + "\n"


def _preset(config: Config, pair: "StereoPair", rows: int) -> dict[str, float]:
    from softdepth.golden import fixed_model, float_model
    from softdepth.sim.frames import run_frames

    crop = replace(pair, left=pair.left[:rows], right=pair.right[:rows], truth=None)
    config = measure.as_large_as(crop, config)
    measure.check_fits(crop, config)
    with screen.progress(f"preset {config.name}, gateware", crop.width * crop.height) as advance:
        frames = run_frames(config, [(crop.left, crop.right)], progress=advance)
    screen.note(f"preset {config.name}, models ...")
    return {
        "disparities": config.disparities,
        "lanes": config.lanes,
        "cycles_per_pixel": frames.cycles_per_pixel,
        "sim_pixels_per_second": frames.pixels_per_second,
        "fixed_seconds": _seconds(lambda: fixed_model.disparity(pair.left, pair.right, config)),
        "float_seconds": _seconds(lambda: float_model.disparity(pair.left, pair.right, config)),
    }


def _block_matcher(pair: "StereoPair") -> float:
    """Seconds per frame of OpenCV's StereoBM on one thread, the best of some runs."""
    import cv2

    gray = [cv2.cvtColor(image, cv2.COLOR_RGB2GRAY) for image in (pair.left, pair.right)]
    matcher = cv2.StereoBM.create(numDisparities=Config.preset("paper").disparities, blockSize=BM_WINDOW)
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        return min(_seconds(lambda: matcher.compute(*gray)) for _ in range(BM_REPEATS))
    finally:
        cv2.setNumThreads(threads)


def _seconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or "unknown"
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
