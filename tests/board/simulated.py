"""A simulated board at the end of a pseudo-terminal, for a host to talk to."""

import contextlib
import json
import threading
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from softdepth.hdl.boards import BoardTop
from softdepth.hdl.boards.serial.receiver import MIN_DIVISOR
from softdepth.hdl.verilog import to_verilog
from softdepth.sim.build import TOP, Build, build
from softdepth.sim.stream import simulate
from softdepth.spec.boards import BOARDS
from softdepth.spec.config import Config
from tests.board.bridge import PLAN_VARIABLE

DIVISOR = MIN_DIVISOR
"""Clocks per bit: as few as the gateware takes."""

BOARD = replace(BOARDS["ulx3s-85f"], baud=BOARDS["ulx3s-85f"].core_hz // DIVISOR)
START_SECONDS = 240


@dataclass
class Board:
    """A board in the simulator. `path` is its serial port; `record` is there when it has been stopped."""

    path: str = ""
    record: dict[str, Any] = field(default_factory=dict)


@contextlib.contextmanager
def plugged_in(
    config: Config,
    folder: Path,
    to_board: Mapping[str, Any] | None = None,
    to_host: Mapping[str, Any] | None = None,
    unplug: int | None = None,
) -> Iterator[Board]:
    """A board with a core of `config`; faults of each direction as in `tests.board.bridge.Wire`.

    With `unplug` the port goes away when so many bytes have come from the host.
    """
    program = _program(config)
    files = {name: str(folder / name) for name in ("ready", "stop", "record")}
    plan = {
        **files,
        "divisor": DIVISOR,
        "to_board": dict(to_board or {}),
        "to_host": dict(to_host or {}),
        "unplug": unplug,
    }
    (folder / "plan.json").write_text(json.dumps(plan))
    # Where it does not end well, the record is missing.
    arguments = (program.folder, "tests.board.bridge", folder, {PLAN_VARIABLE: str(folder / "plan.json")})
    simulator = threading.Thread(target=simulate, args=arguments, daemon=True)
    simulator.start()
    board = Board()
    try:
        board.path = _wait(Path(files["ready"]), simulator, folder)
        yield board
    finally:
        Path(files["stop"]).touch()
        simulator.join(START_SECONDS)
    assert Path(files["record"]).exists(), (folder / "log").read_text()
    board.record = json.loads(Path(files["record"]).read_text())


@cache
def _program(config: Config) -> Build:
    return build(
        to_verilog(BoardTop(BOARD, config, "simulated", simulated=True), name=TOP),
        inputs=("clk", "rx", "button"),
        outputs=("tx", "led"),
    )


def _wait(path: Path, simulator: threading.Thread, folder: Path) -> str:
    deadline = time.monotonic() + START_SECONDS
    while not path.exists():
        running = simulator.is_alive() and time.monotonic() < deadline
        assert running, (folder / "log").read_text()
        time.sleep(0.02)
    return path.read_text()
