"""The head, the constants and the JSON of an exported core tell the same, and tell all."""

import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from softdepth.export.core_file import check_export, export_core
from softdepth.golden.fixed_model import disparity
from softdepth.hdl.verilog import TOP
from softdepth.sim.transfers import pack_frame
from softdepth.spec.errors import ConfigError, InputError
from softdepth.spec.validity import Validity
from tests.export.conftest import SMALL, exported
from tests.hdl.test_core import images
from tests.support.icarus import needs_icarus
from tests.support.verilog import ports


def head(name: str) -> str:
    """The comment of one of `SMALL`."""
    return comment(exported(name).verilog)


def comment(text: str) -> str:
    """The comment as one line: where it breaks is of no concern."""
    return re.sub(r"\n//\s*", " ", text[: text.index("\n\n")])


@pytest.mark.parametrize("taps", [1, 7])
def test_a_memory_with_initial_words_is_named_where_there_is_one(taps: int) -> None:
    """Those that simulators find cleared are in blocks with a name of their own."""
    config = SMALL["robust"].override([f"criteria.0.taps={taps}"])
    text = export_core(config).verilog
    table = re.search(r"^ *initial begin$", text, re.MULTILINE)
    assert bool(table) == (taps > 1)
    assert ("table of reciprocals" in comment(text)) == bool(table)


@pytest.mark.parametrize("name", SMALL)
def test_every_port_and_field_has_its_place_and_a_meaning(name: str) -> None:
    described = json.loads(exported(name).json)
    found = ports(exported(name).verilog, TOP)
    assert {port["name"]: (port["direction"], port["width"]) for port in described["ports"]} == found
    for port in described["ports"]:
        assert re.search(
            rf"{port['direction']} +{port['width']} +{port['name']} +{re.escape(port['meaning'])}", head(name)
        )
        covered: set[int] = set()
        for field in port["fields"]:
            low, high = field["lsb"], field["lsb"] + field["width"] - 1
            place = f"{high}:{low}" if high > low else f"{low}"
            line = rf"{port['name']}\[{place}\] +{field['name']} +{re.escape(field['meaning'])}"
            assert re.search(line, head(name))
            covered |= set(range(low, high + 1))
        assert covered in (set(), set(range(port["width"])))
    assert [port["name"] for port in described["ports"] if port["fields"]] == [
        "i_payload",
        "o_payload",
        "status",
    ]


def test_colours_are_where_the_model_has_them() -> None:
    """A pixel packed by the simulation's driver, unpacked by the constants."""
    constants = json.loads(exported("sad").json)["constants"]
    left, right = np.array([[[1, 2, 3]] * 8] * 8, np.uint8), np.array([[[4, 5, 6]] * 8] * 8, np.uint8)
    pixel = int(pack_frame(left, right)[0])

    def field(name: str) -> int:
        return pixel >> constants[f"I_PAYLOAD_{name}_LSB"] & (1 << constants[f"I_PAYLOAD_{name}_BITS"]) - 1

    colours = [f"{side}_{colour}" for side in ("LEFT", "RIGHT") for colour in ("RED", "GREEN", "BLUE")]
    assert [field(name) for name in colours] == [1, 2, 3, 4, 5, 6]
    assert (field("SOF"), field("EOL"), field("EOF")) == (1, 0, 0)


@pytest.mark.parametrize("name", SMALL)
def test_constants_are_those_of_the_json(name: str) -> None:
    core = exported(name)
    declared = {
        key: int(value) for key, value in re.findall(r"^  localparam (\w+) = (\d+);$", core.verilog, re.M)
    }
    assert declared == json.loads(core.json)["constants"]
    assert declared["O_PAYLOAD_CODE_LSB"] == declared["O_PAYLOAD_DISPARITY_BITS"]


def test_codes_are_numbered() -> None:
    codes = json.loads(exported("sad").json)["codes"]
    assert codes == {"FULL": 0, "PARTIAL": 1, "BORDER": 2}
    for name, number in codes.items():
        assert re.search(rf" {number} +{name} +{re.escape(Validity[name].meaning)}", head("sad"))


def test_what_else_a_stranger_needs() -> None:
    config, text = SMALL["sad"], head("sad")
    assert "synchronous reset, active high" in text
    assert f"a pixel takes {config.steps} clocks" in text
    assert (
        f"Frames: {config.min_width} x {config.min_height} to {config.max_width} x {config.max_height}"
        in text
    )
    assert text.count("stays at 65535") == 4
    assert re.search(r"i_valid .*without waiting for i_ready", text)
    assert re.search(r"i_ready .*may wait for i_valid, low during reset", text)


@needs_icarus
def test_the_instantiation_compiles(tmp_path: Path) -> None:
    text = exported("sad").verilog
    comment = text[text.index("// To copy:\n") : text.index("// Configuration, as")]
    lines = [line.removeprefix("//") for line in comment.splitlines()[1:]]
    (tmp_path / "user.v").write_text(
        "\n".join(["`default_nettype none", "module user;", *lines, "endmodule"])
    )
    (tmp_path / "core.v").write_text(text)
    done = subprocess.run(
        ["iverilog", "-g2012", "-s", "user", "-o", "user", "core.v", "user.v"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


def test_two_cores_by_name_have_no_module_in_common() -> None:
    first, second = (
        set(re.findall(r"^module (\w+)", export_core(SMALL["sad"], name).verilog, re.M))
        for name in ("a", "b")
    )
    assert first
    assert second
    assert not first & second


@pytest.mark.parametrize("name", ["2fast", "a-b", "a__b", "a_", "", "module", "Entity\n", "logic"])
def test_names_that_some_tool_does_not_take(name: str) -> None:
    with pytest.raises(InputError, match="cannot name a module"):
        check_export(SMALL["sad"], name)


def test_the_right_view_is_refused_and_the_way_to_it_is_right() -> None:
    """The remedy, done in NumPy: lines last pixel first, right as left, and the results last pixel first."""
    right = SMALL["sad"].override(["reference=right"])
    with pytest.raises(
        ConfigError, match=r"feed the right image's lines as left.* last pixel first"
    ) as error:
        export_core(right)
    assert "reference = 'left'" in str(error.value)
    pair = images(3, 20, 6)
    swapped = pair[1][:, ::-1], pair[0][:, ::-1]
    core_view = disparity(*swapped, SMALL["sad"]).disparity[:, ::-1]
    assert np.array_equal(core_view, disparity(*pair, right).disparity)


def test_codes_stand_in_the_documents(project: Path) -> None:
    text = (project / "docs/gateware.md").read_text()
    assert [f"| {code.value} | `{code.name}` | {code.meaning} |" in text for code in Validity] == [
        True
    ] * len(Validity)
