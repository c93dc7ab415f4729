"""One pair through the gateware and the models: what `softdepth run` measures."""

import time
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

Engine = Literal["rtl", "fixed", "float", "sad", "board"]
"""``board`` and ``rtl`` are the gateware, in an FPGA and simulated. ``sad`` is the baseline: plain 3x3 SAD
with the same candidates and view, in fixed point."""

MEASURED: dict[str, tuple[Engine, ...]] = {
    "board": ("board", "fixed", "float", "sad"),
    "rtl": ("rtl", "fixed", "float", "sad"),
    "fixed": ("fixed", "float", "sad"),
    "float": ("float", "sad"),
}
"""What a run with each ``--engine`` measures: itself, and what it is worth comparing with."""

_TITLES: dict[Engine, str] = {
    "board": "gateware, on the board",
    "rtl": "gateware, simulated by Verilator",
    "fixed": "fixed-point model",
    "float": "float model",
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
    link : packets and what befell them on the way to a board, or None.
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


def check_fits(pair: "StereoPair", config: Config, *, built: bool = False) -> None:
    """Raise `InputError` unless a core of this configuration, perhaps a `built` one, can take the pair."""
    size = f"'{pair.name}' is {pair.width}x{pair.height}"
    for key, have, limit in (
        ("max_width", pair.width, config.max_width),
        ("max_height", pair.height, config.max_height),
    ):
        if have > limit:
            remedy = f"use --set {key}={have}"
            if built:
                remedy = f"give smaller images, or build and load a core with --set {key}={have}"
            raise InputError(f"{size}, but the core is built for {key} = {limit}", remedy)
    if pair.width < config.min_width or pair.height < config.min_height:
        raise InputError(
            f"{size}, and the smallest frame is {config.min_width}x{config.min_height}",
            "give larger images, or smaller windows with --set",
        )


def baseline(config: Config) -> Config:
    """Plain 3x3 SAD with the candidates, view and size limits of `config`."""
    shared = {"disparities", "lanes", "reference", "max_width", "max_height"}
    same = config.model_dump(mode="json", include=shared)
    return Config.preset("sad").override([f"{key}={value}" for key, value in same.items()])


def measure(
    pair: "StereoPair", config: Config, engine: Engine, device: "Device | None" = None
) -> Measurement:
    """Run `engine` and the engines it is compared with, showing progress.

    The gateware goes first: a missing simulator ends the run before the models take their time. `device` is
    what the engine ``board`` runs on.
    """
    measurement = Measurement(engine)
    for each in MEASURED[engine]:
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

    if engine == "sad":
        config = baseline(config)
    model = float_model if engine == "float" else fixed_model
    screen.note(f"{_TITLES[engine]} ...")
    start = time.perf_counter()
    measurement.maps[engine] = model.disparity(pair.left, pair.right, config)
    measurement.seconds[engine] = time.perf_counter() - start
