"""From a board and a configuration to a bitstream, with a manifest of how it was made."""

import hashlib
import json
import shutil
import subprocess
import tempfile
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from softdepth.files import result_folder
from softdepth.flow.families import FAMILIES, part_of
from softdepth.flow.route import PLACED, place_and_route
from softdepth.flow.stages import Stages
from softdepth.flow.synthesis import synthesise
from softdepth.flow.tools import find_tool
from softdepth.sources import PROJECT, sources_hash
from softdepth.spec.boards import Board
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.spec.protocol import check_lines

MANIFEST = "manifest.json"
FILES = ("config.toml", "netlist.json", "nextpnr.log", "timing.json")
"""What lies beside bitstream and manifest."""


class Manifest(BaseModel):
    """``manifest.json``: everything that a bitstream was made from, and how it turned out.

    Members
    -------
    key : changes with all that the bitstream depends on: sources, board, configuration, tools and seed.
    revision : the git revision of the project, with ``-dirty`` where files differ from it; None outside git.
    usage : used and available cells, in nextpnr's own words.
    seconds : wall-clock time of each stage.
    """

    key: str
    board: str
    device: str
    bitstream: str
    made: str
    config: dict[str, Any]
    config_hash: str
    softdepth: str
    revision: str | None
    tools: dict[str, str]
    seed: int
    clock: str
    wanted_mhz: float
    fmax_mhz: float
    critical_path: str
    usage: dict[str, dict[str, int]]
    seconds: dict[str, float]


def build(board: Board, config: Config, output: Path, *, seed: int = 1) -> Manifest:
    """Build the board's top with a core of `config`; the files appear in `output` all together.

    If `output` already holds the result of the same sources, tools and arguments, it stays as it is.

    Raises `ConfigError` for a core that does not fit the part, `ToolError` for a missing or failed tool,
    `TimingError` (one of them) for a core that is slower than the board's clock, and `InputError` where
    `output` cannot be written. Nothing is written then.
    """
    from softdepth.hdl.boards.top import BoardTop

    check_lines(config)
    part = part_of(board)
    family = FAMILIES[board.family]
    tools = {name: find_tool(name) for name in ("yosys", family.placer, family.packer)}
    constraints = constraints_file(board)
    name = f"softdepth-{board.name}{family.suffix}"
    amaranth = f"amaranth {version('amaranth')}"
    made_with = [amaranth, *map(str, tools.values())]
    facts = [
        sources_hash("flow", further=(constraints,)),
        str(board),
        config.model_dump_json(),
        seed,
        *made_with,
    ]
    key = hashlib.sha256(json.dumps(facts).encode()).hexdigest()[:20]
    if (known := _up_to_date(output, key)) is not None:
        return known
    stages = Stages(f"{board.name}, {config.name}")
    revision = git_revision(PROJECT)
    described = " ".join(filter(None, (version("softdepth"), revision)))
    with (
        result_folder(output, stale=FILES, last=MANIFEST) as results,
        tempfile.TemporaryDirectory(prefix="softdepth-") as temporary,
    ):
        work = Path(temporary)
        with stages.stage("synthesis"):
            top = BoardTop(board, config, described)
            synthesise(top, part.family, work, options=family.synthesis_options(part))
        with stages.stage("place and route"):
            mhz = board.core_hz / 1e6
            routed = place_and_route(work, part, mhz=mhz, seed=seed, constraints=constraints)
            routed.check_clock(mhz)
            routed.check_timing()
        with stages.stage("packing"):
            tools[family.packer].run(family.pack(part, PLACED, name), work)
        slowest = routed.clocks[0]
        manifest = Manifest(
            key=key,
            board=board.name,
            device=part.device,
            bitstream=name,
            made=datetime.now(UTC).isoformat(timespec="seconds"),
            config=config.model_dump(mode="json"),
            config_hash=config.hash,
            softdepth=version("softdepth"),
            revision=revision,
            tools={"amaranth": amaranth, **{name: tool.version for name, tool in tools.items()}},
            seed=seed,
            clock=slowest.name,
            wanted_mhz=round(slowest.wanted_mhz, 2),
            fmax_mhz=round(slowest.fmax_mhz, 2),
            critical_path=str(slowest.path),
            usage={word: vars(count) for word, count in routed.usage.items() if count.used},
            seconds=stages.seconds,
        )
        (work / "report.json").rename(work / "timing.json")
        for file in (name, "netlist.json", "nextpnr.log", "timing.json"):
            shutil.move(work / file, results / file)
        config.save(results / "config.toml")
        (results / MANIFEST).write_text(manifest.model_dump_json(indent=2) + "\n")
    return manifest


def _up_to_date(output: Path, key: str) -> Manifest | None:
    """The manifest of an earlier build of the same, where its bitstream still lies beside it."""
    try:
        known = Manifest.model_validate_json((output / MANIFEST).read_text())
    except (OSError, ValueError):
        return None
    return known if known.key == key and (output / known.bitstream).is_file() else None


def constraints_file(board: Board) -> Path:
    """The board's pin file; raises `InputError` if the project's ``constraints/`` is not there."""
    path = PROJECT / "constraints" / board.constraints
    if not path.is_file():
        raise InputError(f"the pin file '{path}' is missing", "build in a clone of the project")
    return path


def git_revision(folder: Path) -> str | None:
    """The revision that git has checked out in `folder`, or None where there is no git or no repository."""
    command = ["git", "-C", str(folder), "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    return done.stdout.strip() or None if done.returncode == 0 else None
