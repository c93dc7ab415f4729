"""Speed of the simulated gateware, of the models, of sequences in processes, and of OpenCV, in one run."""

import os
import platform
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from softdepth import screen
from softdepth.golden import fixed_model, float_model
from softdepth.golden.data.pair import StereoPair
from softdepth.processes import cores
from softdepth.run import measure
from softdepth.sequence.frame import Recipe
from softdepth.sequence.work import Work
from softdepth.sim.frames import run_frames
from softdepth.sim.toolchain import find_toolchain
from softdepth.spec.config import Config
from softdepth.templates import render

BM_WINDOW = 15
"""Window of OpenCV's block matcher; it needs an odd size of at least 5."""
BM_REPEATS = 5
SEQUENCE_PRESET = "paper"
"""Whose fixed model computes the frames of a sequence."""


def measured(
    pair: StereoPair, rows: int, frames: int, presets: Iterable[str], processes: Iterable[int] | None = None
) -> dict[str, Any]:
    """The figures of `page`, as they are written for programs.

    Parameters
    ----------
    pair : what is computed; its first `rows` by the simulated gateware.
    frames : of the sequence.
    presets : with gateware.
    processes : for the sequence; by default 1, 2 and as many as there are cores.
    """
    return {
        "pair": pair.name,
        "width": pair.width,
        "height": pair.height,
        "simulated_rows": min(rows, pair.height),
        "machine": machine(),
        "presets": {name: of_preset(Config.preset(name), pair, rows) for name in presets},
        "opencv_stereobm_seconds": block_matcher(pair),
        "sequence": of_sequence(Config.preset(SEQUENCE_PRESET), pair, frames, processes or {1, 2, cores()}),
    }


def page(figures: dict[str, Any]) -> str:
    """The figures as a Markdown page."""
    rows = [
        [
            name,
            found["disparities"],
            found["lanes"],
            f"{found['cycles_per_pixel']:.3f}",
            f"{found['sim_pixels_per_second']:,.0f}",
            f"{found['fixed_seconds']:.2f}",
            f"{found['float_seconds']:.2f}",
        ]
        for name, found in figures["presets"].items()
    ]
    frames, waited = figures["sequence"]["frames"], figures["sequence"]["seconds"]
    processes = [
        [count, f"{seconds:.1f}", f"{frames / seconds:.2f}", f"{waited['1'] / seconds:.2f}"]
        for count, seconds in waited.items()
    ]
    values = {**figures, "rows": rows, "processes": processes, "bm_window": BM_WINDOW}
    return render("softdepth.studies", "benchmarks.md", **values) + "\n"


def machine() -> dict[str, str | int]:
    """What the figures depend on: processor, system and tools."""
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


def of_preset(config: Config, pair: StereoPair, rows: int) -> dict[str, float]:
    """A configuration's simulated gateware on the first rows of a pair, and its models on the whole."""
    pair = pair.as_format(config.pixel)
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


def of_sequence(config: Config, pair: StereoPair, frames: int, processes: Iterable[int]) -> dict[str, Any]:
    """Seconds that a sequence takes in so many processes.

    They include everything that a user waits for: starting processes, models, files.
    """
    pair = pair.as_format(config.pixel)
    config = measure.as_large_as(pair, config)
    names = tuple(f"{number:04}" for number in range(frames))

    def pairs() -> Iterator[StereoPair]:
        for number, name in enumerate(names):
            left, right = (np.roll(image, number, axis=0) for image in (pair.left, pair.right))
            yield replace(pair, left=left, right=right, truth=None, name=name)

    seconds = {}
    for count in sorted(processes):
        screen.note(f"{frames} frames, processes: {count} ...")
        with tempfile.TemporaryDirectory(prefix="softdepth-") as name:
            work = Work(pairs, names, Recipe(config, "fixed"), Path(name), count)
            seconds[str(count)] = _seconds(work.run)
    return {"preset": config.name, "frames": frames, "seconds": seconds}


def block_matcher(pair: StereoPair) -> float:
    """Seconds per frame of OpenCV's StereoBM on one thread, the best of some runs."""
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
