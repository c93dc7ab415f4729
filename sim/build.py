"""Verilog into a simulation program, once for each design.

Verilator can only optimise signals that nothing looks at. cocotb's runner makes every signal visible, which
makes simulation several times slower, so this module calls Verilator itself and shows cocotb only the top
ports.
"""

import errno
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import cocotb
import cocotb_tools.config

from softdepth.files import cache_folder
from softdepth.sim import build_cache
from softdepth.sim.toolchain import Toolchain, find_toolchain
from softdepth.spec.errors import ToolError

TOP = "softdepth_core"
"""Module and program name of every simulated design."""

INPUTS = ("clk", "rst", "i_valid", "i_payload", "o_ready")
OUTPUTS = ("i_ready", "o_valid", "o_payload", "status")

VERILATOR_FLAGS = (
    *("--cc", "--exe", "--no-timing", "--top-module", TOP, "--prefix", "Vtop", "-o", TOP),
    *("--timescale", "1ns/1ns"),
    *("-O3", "--x-assign", "fast", "--no-assert"),
    # Amaranth's Verilog is checked by Amaranth; the style of generated text is nobody's concern.
    *("-Wno-lint", "-Wno-style"),
)
COCOTB_FLAGS = ("--vpi", "--x-initial", "fast")
MAKE_FLAGS = ("OPT_FAST=-Og", "OPT_SLOW=-O0", "OPT_GLOBAL=-O2")

LEAST_ROOM = 1 << 20
"""Bytes: if a failed build leaves less free space than this, the disk was full."""


@dataclass(frozen=True)
class Build:
    """A simulation program: its folder, whether it was there before, and the seconds it took."""

    folder: Path
    cached: bool
    seconds: float


@dataclass(frozen=True)
class Bench:
    """A bench in C++, and further flags for Verilator."""

    text: str
    flags: tuple[str, ...]


def build(
    verilog: str,
    *,
    waves: bool = False,
    inputs: Sequence[str] = INPUTS,
    outputs: Sequence[str] = OUTPUTS,
    bench: Bench | None = None,
) -> Build:
    """Build a design whose top module is `TOP`, or take it from the cache.

    `inputs` and `outputs` are the ports that a bench drives and reads: by default the core's. With
    `waves` the program can record every signal, and runs slower. With a `bench` in C++ there is no Python in
    it. Builds at the same time are safe: the second waits for the first. Raises `ToolError` for a missing
    tool or a failed build.
    """
    start = time.monotonic()
    tools = find_toolchain()
    flags = (*VERILATOR_FLAGS, *(("--trace",) if waves else ()), *(bench.flags if bench else COCOTB_FLAGS))
    ports = "" if bench else _visible_ports(inputs, outputs)
    settings = (*flags, *MAKE_FLAGS, *_versions(tools))
    runtime = cache_folder() / "runtime" / _digest(settings)
    folder = cache_folder() / "sim" / _digest((verilog, bench.text if bench else ports, *settings))
    with build_cache.locked(folder):
        cached = (folder / TOP).exists()
        if not cached:
            with _room():
                _build(verilog, ports, flags, tools, folder, runtime, bench)
    if not cached:
        build_cache.make_room(folder.parent)
    return Build(folder, cached, time.monotonic() - start)


def _build(
    verilog: str,
    ports: str,
    flags: Sequence[str],
    tools: Toolchain,
    folder: Path,
    runtime: Path,
    bench: Bench | None,
) -> None:
    # make refuses paths with spaces, which a user's cache folder may have.
    with (
        tempfile.TemporaryDirectory(prefix="softdepth-") as name,
        build_cache.log_of(folder).open("w") as log,
    ):
        work = Path(name)
        (work / "top.v").write_text(verilog)
        if bench:
            (work / "bench.cpp").write_text(bench.text)
            sources: list[str | Path] = ["bench.cpp", "top.v"]
        else:
            (work / "ports.vlt").write_text(ports)
            libraries = cocotb_tools.config.libs_dir
            main = cocotb_tools.config.share_dir / "lib" / "verilator" / "verilator.cpp"
            link = f"-Wl,-rpath,{libraries} -L{libraries} -lcocotbvpi_verilator"
            sources = ["-LDFLAGS", link, main, "ports.vlt", "top.v"]
        _run([tools.verilator, *flags, "--Mdir", "obj", *sources], work, tools, log)
        objects = work / "obj"
        _reuse_runtime(runtime, objects)
        jobs = f"-j{os.cpu_count() or 1}"
        compile_ = [tools.make, jobs, "-C", "obj", "-f", "Vtop.mk", *MAKE_FLAGS, *tools.make_variables]
        _run(compile_, work, tools, log)
        build_cache.keep(runtime, objects.glob("verilated*.o"))
        build_cache.keep(folder, [objects / TOP])


@contextmanager
def _room() -> Iterator[None]:
    """Tell where a build is made and kept, when the system does not let it be written."""
    try:
        yield
    except OSError as error:
        raise ToolError(
            f"the simulation cannot be kept in '{cache_folder()}', or made in '{tempfile.gettempdir()}':"
            f" {(error.strerror or str(error)).lower()}",
            "make room there, or set SOFTDEPTH_CACHE and TMPDIR to other folders",
        ) from error


def _run(command: Sequence[str | Path], folder: Path, tools: Toolchain, log: TextIO) -> None:
    log.write(f"$ {' '.join(map(str, command))}\n")
    log.flush()
    done = subprocess.run(
        [str(part) for part in command],
        cwd=folder,
        env=dict(tools.environment),
        stdout=log,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        check=False,
    )
    if done.returncode:
        said = Path(log.name).read_text(errors="replace").splitlines()
        reason = next((line for line in said if "rror" in line), f"exit status {done.returncode}")
        if shutil.disk_usage(folder).free < LEAST_ROOM:  # few programs say so
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        raise ToolError(f"building the simulation failed: {reason}", f"see {log.name}")


def _visible_ports(inputs: Sequence[str], outputs: Sequence[str]) -> str:
    """A Verilator control file that shows cocotb the ports and nothing else."""
    lines = [f'public_flat_rw -module "{TOP}" -var "{port}"' for port in inputs]
    lines += [f'public_flat_rd -module "{TOP}" -var "{port}"' for port in outputs]
    return "\n".join(["`verilator_config", *lines, ""])


def _versions(tools: Toolchain) -> tuple[str, ...]:
    """Everything outside the design that a program is linked with or built by."""
    libraries = str(cocotb_tools.config.libs_dir)
    abi = sys.implementation.cache_tag
    return tools.verilator_version, tools.compiler_version, cocotb.__version__, libraries, abi


def _digest(texts: Sequence[str]) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:20]


def _reuse_runtime(runtime: Path, objects: Path) -> None:
    """Verilator's own library is the same in every design, and most of a small build's time."""
    for path in runtime.glob("*.o"):
        shutil.copyfile(path, objects / path.name)  # a fresh date, so that make takes it
