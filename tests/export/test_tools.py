"""Every tool reads an exported core as it comes, with no more to say than what is waived here by name."""

import re
import subprocess
from functools import cache
from pathlib import Path

import pyslang
import pytest
from pyslang.ast import Compilation
from pyslang.syntax import SyntaxTree

from softdepth.export.core_file import export_core
from softdepth.flow.tools import find_tool
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.verilog import TOP, to_verilog
from softdepth.sim.toolchain import find_toolchain
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from tests.export.conftest import BUILT, SMALL, exported
from tests.support.icarus import STANDARDS, needs_icarus

WAIVED = {
    "VARHIDDEN": "an inner register is called as an instance of the module around is",
    "DECLFILENAME": "the file holds all modules, and a user names it",
    "PROCASSINIT": "registers hold a value from power-up on, and another after a clock: FPGAs can do that",
    "UNUSEDPARAM": "the constants of the head are for the user",
    "UNUSEDSIGNAL": "rst of modules whose registers have none; bits that only some configurations need",
}
"""What Verilator may say at -Wall, with the reason."""

SLANG_WAIVED = {
    "ArithOpMismatch": "operands are extended to the width of the result, as Verilog does by itself",
    "SignConversion": "a sum of signed operands is kept as bits",
}


AXI = {
    "axi": (SMALL["sad"], AxiOptions(left=True)),
    "axi-two": (SMALL["robust-small"], AxiOptions("wishbone", inputs="two", clocks="own")),
}
"""Cores with AXI streams: both buses, one clock or three, and every register."""


@cache
def verilog(name: str) -> str:
    """One of `SMALL` or `AXI`, its module called `TOP`."""
    return to_verilog(AxiCore(*AXI[name]), TOP) if name in AXI else exported(name).verilog


@pytest.fixture(params=[*SMALL, *AXI])
def core(request, tmp_path: Path) -> Path:
    path = tmp_path / "core.v"
    path.write_text(verilog(request.param))
    return path


def verilator(folder: Path, *arguments: str) -> str:
    tools = find_toolchain()
    done = subprocess.run(
        [tools.verilator, *arguments],
        cwd=folder,
        env=dict(tools.environment),
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stderr


def warnings(said: str) -> set[str]:
    errors = re.findall(r"^%Error: (?!Exiting due to)(.*)", said, re.MULTILINE)
    return set(re.findall(r"^%(?:Warning|Error)-(\w+)", said, re.MULTILINE)) | set(errors)


def test_verilator_makes_cpp_without_a_word(core: Path) -> None:
    """The first command of a customer: no flag, and warnings are fatal."""
    said = verilator(core.parent, "--cc", "core.v")
    assert "%" not in said
    assert (core.parent / "obj_dir" / "Vcore.h").exists()


SLOW, FULL = pytest.mark.slow, pytest.mark.full
DEFAULTS = {"sad": (), "lite": SLOW, "paper": SLOW, "robust-small": SLOW, "compact": FULL}
"""Presets with a mark where they take seconds; the rest takes what `robust` takes."""


@pytest.mark.parametrize("name", [pytest.param(each, marks=DEFAULTS.get(each, FULL)) for each in BUILT])
def test_verilator_makes_cpp_of_default_cores(name: str, tmp_path: Path) -> None:
    """Wide memories of several blocks, and as many lanes as users begin with: small cores have neither."""
    config = Config.preset(name)
    text = to_verilog(config) if config.whole_frame else export_core(config).verilog
    (tmp_path / "core.v").write_text(text)
    assert "%" not in verilator(tmp_path, "--cc", "core.v")


def test_verilator_lints(core: Path) -> None:
    found = warnings(verilator(core.parent, "--lint-only", "-Wall", "--top-module", TOP, "core.v"))
    assert found <= WAIVED.keys()


def test_verilator_would_say_so(tmp_path: Path) -> None:
    (tmp_path / "core.v").write_text("module m(input [3:0] a, output [1:0] b); assign b = a; endmodule\n")
    assert warnings(verilator(tmp_path, "--lint-only", "-Wall", "core.v")) - WAIVED.keys() == {"WIDTHTRUNC"}


@needs_icarus
@pytest.mark.parametrize("standard", STANDARDS)
def test_icarus_compiles(core: Path, standard: str) -> None:
    done = subprocess.run(
        ["iverilog", standard, "-Wall", "-s", TOP, "-o", "core", "core.v"],
        cwd=core.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert not done.stdout + done.stderr


def test_yosys_checks(core: Path) -> None:
    script = f"read_verilog core.v; hierarchy -check -top {TOP}; proc; check -assert"
    said = find_tool("yosys").run(["-q", "-l", "log", "-p", script], core.parent, log="log")
    assert "Warning" not in said


def slang(text: str) -> set[str]:
    """Kinds of diagnostics; those that are errors begin with a ``!``."""
    compilation = Compilation()
    compilation.addSyntaxTree(SyntaxTree.fromText(text))
    found: list[pyslang.Diagnostic] = list(compilation.getAllDiagnostics())
    names = {re.sub(r"DiagCode\((\w+)\)", r"\1", str(each.code)): each.isError() for each in found}
    return {f"{'!' * error}{name}" for name, error in names.items()}


def test_slang_elaborates(core: Path) -> None:
    assert slang(core.read_text()) <= SLANG_WAIVED.keys()


def test_slang_would_say_so() -> None:
    assert any(name.startswith("!") for name in slang("module m; wire a; assign a = b; endmodule"))
