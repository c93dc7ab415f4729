"""``python -m softdepth.studies.reading``: exported cores read by yosys, as a table in docs/flow.md."""

import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from softdepth.ending import ended
from softdepth.export.core_file import export_core
from softdepth.files import write_atomically
from softdepth.flow.tools import Tool, find_tool
from softdepth.hdl.built import missing
from softdepth.hdl.verilog import TOP
from softdepth.spec.config import PRESETS, Config
from softdepth.spec.errors import InputError, ToolError
from softdepth.studies import markers
from softdepth.templates import render

DOCUMENT = Path("docs/flow.md")
PART = "reading"
MIB = 1024
"""KiB, in which the system tells a process' memory."""


@dataclass(frozen=True)
class Reading:
    """What one run of yosys took, in seconds and MiB, and the cells of its design by type."""

    seconds: float
    megabytes: float
    cells: dict[str, int]


def built_presets() -> list[str]:
    """Presets that have gateware and can be exported."""
    return [name for name in PRESETS if not missing(Config.preset(name))]


def read(verilog: str, commands: str) -> Reading:
    """Let yosys read an exported core and run `commands`; raises `ToolError` if it fails."""
    tool = find_tool("yosys")
    with tempfile.TemporaryDirectory(prefix="softdepth-") as name:
        folder = Path(name)
        (folder / "core.v").write_text(verilog)
        script = (
            f"read_verilog core.v; hierarchy -check -top {TOP}; {commands}; tee -q -o cells.json stat -json"
        )
        start = time.monotonic()
        code, kibibytes = _run(tool, script, folder)
        seconds = time.monotonic() - start
        if code:
            said = (folder / "log").read_text(errors="replace") if (folder / "log").exists() else ""
            lines = [line for line in said.splitlines() if line.strip()] or ["it left no message"]
            raise ToolError(f"yosys cannot read the exported core: {lines[-1]}", "please report this")
        design = json.loads((folder / "cells.json").read_text())["design"]
    return Reading(seconds, kibibytes / MIB, design["num_cells_by_type"])


def _run(tool: Tool, script: str, folder: Path) -> tuple[int, int]:
    """How a run ended, and the most memory that it had."""
    process = subprocess.Popen(
        [*tool.command, "-q", "-l", "log", "-p", script],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, usage.ru_maxrss


def page() -> str:
    """The table: each preset as it is by default."""
    rows = []
    for name in built_presets():
        config = Config.preset(name)
        verilog = export_core(config).verilog
        rows.append((config, read(verilog, "proc"), read(verilog, f"synth_ecp5 -top {TOP}")))
    return render("softdepth.studies", "reading.md", rows=rows, version=find_tool("yosys").version)


def main(project: Path) -> None:
    """Renew the table in `project`."""
    path = project / DOCUMENT
    if not path.is_file():
        raise InputError(f"'{path}' is not there", "run this in the project's folder")
    table = page()
    write_atomically(path, markers.renew(path.read_text(), str(DOCUMENT), PART, table).encode())


if __name__ == "__main__":
    sys.exit(ended(lambda: main(Path.cwd())))
