"""One pair through the gateware and the models: what `softdepth run` measures."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from softdepth import screen
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.board.device import Device
    from softdepth.golden.data.pair import StereoPair
    from softdepth.golden.maps import DisparityMap
    from softdepth.sim.compare import Mismatch

Engine = Literal["rtl", "fixed", "float", "paper", "sad", "board"]
"""``board`` and ``rtl`` are the gateware, in an FPGA and simulated. ``paper`` and ``sad`` are those presets
with the same candidates and view, in fixed point: the paper's method, and plain 3x3 SAD as the baseline."""

LIMITS = ("max_width", "max_height")
"""The keys that say how large images a core can take."""
SMALLEST = 8
"""The least that a limit may be."""

NEEDED: dict[Engine, tuple[Engine, ...]] = {
    "board": ("board", "fixed"),
    "rtl": ("rtl", "fixed"),
    "fixed": ("fixed",),
    "float": ("float",),
    "paper": ("paper",),
    "sad": ("sad",),
}
"""What a run of each engine computes: itself, and for gateware the model it has to agree with."""

COMPARED: tuple[Engine, ...] = ("float", "sad")
"""What gateware is compared with unless told otherwise; a model is compared with what is asked for."""

_TITLES: dict[Engine, str] = {
    "board": "gateware, on the board",
    "rtl": "gateware, simulated by Verilator",
    "fixed": "fixed-point model",
    "float": "float model",
    "paper": "preset paper",
    "sad": "plain SAD",
}


@dataclass
class Measurement:
    """The maps of a pair, by engine, and what they took.

    Members
    -------
    engine : the engine whose map is the result.
    maps : a disparity map for each measured engine.
    seconds : wall time of each; for ``rtl`` the simulation alone, without building the simulator; for
        ``board`` the frame's way there and back.
    cycles_per_pixel, pixels_per_second : of the simulated gateware, or None.
    link : packets, and what happened to them on the way to a board, or None.
    """

    engine: Engine
    maps: "dict[Engine, DisparityMap]" = field(default_factory=dict)
    seconds: dict[Engine, float] = field(default_factory=dict)
    cycles_per_pixel: float | None = None
    pixels_per_second: float | None = None
    link: dict[str, int] | None = None

    @property
    def result(self) -> "DisparityMap":
        """The map of the chosen engine."""
        return self.maps[self.engine]

    @property
    def gateware(self) -> "DisparityMap | None":
        """The map of the board or of the simulation, if there is one."""
        return self.maps.get("board") or self.maps.get("rtl")

    def mismatches(self) -> "list[Mismatch] | None":
        """Pixels in which the gateware departs from the fixed model; None if it was not measured."""
        if self.gateware is None:
            return None
        from softdepth.sim.compare import mismatches

        return mismatches([self.maps["fixed"]], [self.gateware])


def as_large_as(pair: "StereoPair", config: Config, keys: Sequence[str] = LIMITS) -> Config:
    """`config` with the limits called `keys` as large as the images, so far as a core can be that small."""
    sizes = {
        "max_width": max(pair.width, config.min_width, SMALLEST),
        "max_height": max(pair.height, config.min_height, SMALLEST),
    }
    return config.override([f"{key}={sizes[key]}" for key in keys])


def check_fits(
    pair: "StereoPair", config: Config, *, again: Callable[..., str] | None = None, built: bool = False
) -> None:
    """Raise `InputError` unless a core of this configuration, perhaps a `built` one, can take the pair.

    All limits that are exceeded are named at once, with the options that raise them; `again` turns such
    options into a command that works.
    """
    size = f"'{pair.name}' is {pair.width}x{pair.height}"
    have = {"max_width": pair.width, "max_height": pair.height}
    exceeded = [key for key in LIMITS if have[key] > getattr(config, key)]
    if exceeded:
        limits = " and ".join(f"{key} = {getattr(config, key)}" for key in exceeded)
        changes = [part for key in exceeded for part in ("--set", f"{key}={have[key]}")]
        remedy = f"use {' '.join(changes)}" if again is None else f"run: {again(*changes)}"
        if built:
            remedy = f"give smaller images, or build and load a core with {' '.join(changes)}"
        raise InputError(f"{size}, but the core is built for {limits}", remedy)
    if pair.width < config.min_width or pair.height < config.min_height:
        raise InputError(
            f"{size}, and the smallest frame is {config.min_width}x{config.min_height}",
            "give larger images, or smaller windows with --set",
        )


def baseline(config: Config, preset: str = "sad") -> Config:
    """A preset, plain 3x3 SAD at first, with the candidates, pixels, view and size limits of `config`."""
    shared = {"disparities", "min_disparity", "lanes", "pixel", "reference", "max_width", "max_height"}
    same = config.model_dump(mode="json", include=shared)
    return Config.preset(preset).override([f"{key}={value}" for key, value in same.items()])


def measure(
    pair: "StereoPair",
    config: Config,
    engine: Engine,
    device: "Device | None" = None,
    also: Sequence[Engine] | None = None,
) -> Measurement:
    """Run `engine`, the model that it must agree with, and those that it is compared with, showing progress.

    The gateware goes first: a missing simulator ends the run before the models take their time.

    Parameters
    ----------
    device : what the engine ``board`` runs on.
    also : further models; for gateware by default `COMPARED`, for a model none.
    """
    measurement = Measurement(engine)
    if also is None:
        also = COMPARED if engine in ("board", "rtl") else ()
    for each in dict.fromkeys((*NEEDED[engine], *also)):
        if each == "board" and device is not None:
            _run_board(pair, device, measurement)
        elif each == "rtl":
            _simulate(pair, config, measurement)
        else:
            _model(pair, config, each, measurement)
    return measurement


def _simulate(pair: "StereoPair", config: Config, measurement: Measurement) -> None:
    from softdepth.sim.frames import run_frames
    from softdepth.sim.toolchain import find_toolchain

    find_toolchain()  # a missing tool shows now, not after the core's elaboration
    with screen.progress(_TITLES["rtl"], pair.width * pair.height) as advance:
        frames = run_frames(config, [(pair.left, pair.right)], progress=advance)
    measurement.maps["rtl"] = frames.maps[0]
    measurement.seconds["rtl"] = frames.stream.seconds_sim
    measurement.cycles_per_pixel = frames.cycles_per_pixel
    measurement.pixels_per_second = frames.pixels_per_second


def _run_board(pair: "StereoPair", device: "Device", measurement: Measurement) -> None:
    with screen.progress(_TITLES["board"], pair.width * pair.height) as advance:
        start = time.perf_counter()
        measurement.maps["board"] = device.disparity(pair.left, pair.right, progress=advance)
        measurement.seconds["board"] = time.perf_counter() - start
    measurement.link = device.link_counters()


def _model(pair: "StereoPair", config: Config, engine: Engine, measurement: Measurement) -> None:
    from softdepth.golden import fixed_model, float_model

    if engine in ("paper", "sad"):
        config = baseline(config, engine)
    model = float_model if engine == "float" else fixed_model
    screen.note(f"{_TITLES[engine]} ...")
    start = time.perf_counter()
    measurement.maps[engine] = model.disparity(pair.left, pair.right, config)
    measurement.seconds[engine] = time.perf_counter() - start
