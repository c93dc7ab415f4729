"""The package's VHDL instantiation, as GHDL reads it in a design around it."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from softdepth.export import axi_package as module
from softdepth.hdl.axi.core import AxiCore
from softdepth.hdl.text.rtlil import ports_of
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config

needs_ghdl = pytest.mark.skipif(
    shutil.which("ghdl") is None, reason="GHDL is not installed: sudo apt install ghdl"
)
CONFIG = Config.preset("sad").override(["max_width=64", "max_height=48", "disparities=8", "lanes=4"])
OPTIONS = AxiOptions(inputs="two", clocks="own", left=True)
STANDARDS = ("93", "08")


@pytest.fixture(scope="module")
def template() -> str:
    """The component and its instantiation; the Verilog itself is not looked at here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "to_verilog", lambda core, name: "")
        return module.axi_package(CONFIG, "depth", OPTIONS)["depth_instance.vhd"]


def design(template: str) -> str:
    """Both parts where a user puts them, with a signal for each of the core's ports."""
    declaration, instance = re.split(r"(?<=end component;)\n", template)
    widths = {port.name: len(port.value) for port in ports_of(AxiCore(CONFIG, OPTIONS))}  # type: ignore[arg-type]
    vectors = {name: f"_vector({width - 1} downto 0)" if width > 1 else "" for name, width in widths.items()}
    signals = "".join(f"signal {name} : std_logic{vector};\n" for name, vector in vectors.items())
    return (
        "library ieee;\nuse ieee.std_logic_1164.all;\nentity user is\nend entity;\n"
        f"architecture around of user is\n{declaration}\n{signals}begin\n{instance}\nend architecture;\n"
    )


def analysed(text: str, folder: Path, standard: str) -> subprocess.CompletedProcess[str]:
    (folder / "user.vhd").write_text(text)
    command = ["ghdl", "-a", f"--std={standard}", "user.vhd"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


@needs_ghdl
@pytest.mark.parametrize("standard", STANDARDS)
def test_ghdl_analyses_it(template: str, tmp_path: Path, standard: str) -> None:
    done = analysed(design(template), tmp_path, standard)
    assert done.returncode == 0, done.stderr
    assert not done.stderr


@needs_ghdl
@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("aresetn : in std_logic;", "aresetn : in std_logic", "expected|missing"),
        ("tdata : out std_logic_vector(", "tdata : out std_logic_vector(1 + ", "length|match|bounds"),
        ("irq => irq", "irk => irq", "irk"),
        ("irq : out std_logic\n", "irq : out std_logic;\n    shift__ed : out std_logic\n", "underscore"),
    ],
)
def test_ghdl_would_say_so(template: str, tmp_path: Path, old: str, new: str, said: str) -> None:
    """A separator, a width, a port's name, and a name that Verilog has and VHDL has not."""
    text = design(template)
    assert text.count(old) == 1
    done = analysed(text.replace(old, new), tmp_path, "08")
    assert done.returncode
    assert re.search(said, done.stderr), done.stderr
