"""`softdepth build`: a whole bitstream, and every way in which there is none."""

import json
import shutil
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from softdepth.cli.app import main
from softdepth.flow import bitstream
from softdepth.flow.bitstream import FILES, MANIFEST, Manifest, git_revision
from softdepth.flow.synthesis import TOP, cells
from softdepth.spec.boards import BOARDS, find_board
from softdepth.spec.config import Config
from tests.flow.test_route import LOG, REPORT

SMALLEST = ("--preset", "sad", "--disparities", 4, "--lanes", 1, "--set", "max_width=16")


@pytest.fixture
def tools(path, monkeypatch, tmp_path):
    """Tools that take no time: `tools(fmax, luts, wanted)` says what nextpnr reports of its clock."""

    def synthesise(design, family, folder, **_):
        (folder / "netlist.json").write_text(json.dumps({"modules": {TOP: {"cells": {}}}}))

    def prepare(fmax: float = 60.0, luts: int = 100, wanted: float = 50.0) -> None:
        clock = {"achieved": fmax, "constraint": wanted}
        report = {**REPORT, "fmax": {"core": clock}}
        (tmp_path / "said").write_text(LOG.format(luts=luts))
        (tmp_path / "report").write_text(json.dumps(report))
        path("yosys", "echo 'Yosys 0.71'")
        path(
            "nextpnr-ecp5",
            '[ "$1" = --version ] && echo "(Version nextpnr-0.11)" && exit 0\n'
            f"/bin/cat {tmp_path}/said | /usr/bin/tee nextpnr.log\n"
            f"/bin/cp {tmp_path}/report report.json\necho config > placed",
        )
        path(
            "ecppack",
            '[ "$1" = --version ] && exit 0\nwhile [ "$1" != --bit ]; do shift; done; echo bits > "$2"',
        )
        monkeypatch.setattr(bitstream, "synthesise", synthesise)

    return prepare


def build(
    output: Path, *arguments: object, board: str = "ulx3s-12f", core: tuple[object, ...] = SMALLEST
) -> int:
    return main([str(a) for a in ("build", "--board", board, *core, *arguments, "-o", output)])


@dataclass(frozen=True)
class Form:
    """What a family's build must look like, and the core to build.

    Members
    -------
    start : what stands within the first so many bytes of the bitstream.
    word, kind, more_than : nextpnr counts as `word` the netlist's cells of that kind.
    tools : beside yosys.
    """

    start: dict[bytes, int]
    word: str
    kind: str
    more_than: int
    tools: tuple[str, str]
    core: tuple[object, ...] = SMALLEST


ECP5 = {b"LFE5U-12F": 200, b"\xff\xff\xbd\xb3": 400}
ICE40 = {b"\xff\x00\x00\xff\x7e\xaa\x99\x7e": 400}
GOWIN = {b"1010010111000011\n": 1000}
FORMS = {
    "ulx3s-12f": Form(ECP5, "Total DFFs", "TRELLIS_FF", 100, ("nextpnr-ecp5", "ecppack")),
    "icebreaker": Form(ICE40, "ICESTORM_RAM", "SB_RAM40_4K", 20, ("nextpnr-ice40", "icepack"), ()),
    "tangnano20k": Form(GOWIN, "RAM16SDP4", "RAM16SDP4", 20, ("nextpnr-himbaechel", "gowin_pack")),
}
BUILT = ("ulx3s-12f", "icebreaker", pytest.param("tangnano20k", marks=pytest.mark.full))
"""Place and route takes minutes for Gowin's parts, whatever the core."""


@pytest.mark.slow
@pytest.mark.parametrize("board", BUILT)
def test_a_core_becomes_a_bitstream(board, tmp_path, capfd):
    """Synthesis, place and route and packing, with the real tools, for a board of each family.

    It is the smallest core, but for iCEBreaker, whose own is small and fills the part.
    """
    output = tmp_path / "out"
    form = FORMS[board]
    assert build(output, "--seed", 3, board=board, core=form.core) == 0
    said = capfd.readouterr()
    assert [line for line in said.err.splitlines() if line.startswith(f"{board}, sad: ")]
    manifest = Manifest.model_validate_json((output / MANIFEST).read_text())
    assert {file.name for file in output.iterdir()} == {*FILES, MANIFEST, manifest.bitstream}
    bits = (output / manifest.bitstream).read_bytes()
    for what, within in form.start.items():
        assert what in bits[:within], bits[:within]
    config = Config.load(output / "config.toml")
    assert (manifest.config_hash, manifest.seed) == (config.hash, 3)
    assert (config.disparities, config.lanes) == ((4, 1) if form.core else (32, 1))
    assert manifest.wanted_mhz == pytest.approx(find_board(board).core_hz / 1e6, rel=0.01)
    assert manifest.fmax_mhz >= manifest.wanted_mhz
    assert set(manifest.tools) == {"amaranth", "yosys", *form.tools}
    assert list(manifest.seconds) == ["synthesis", "place and route", "packing"]
    found = cells(json.loads((output / "netlist.json").read_text()))
    assert manifest.usage[form.word]["used"] == found[form.kind] > form.more_than


def test_the_manifest_says_how_it_came_about(tools, tmp_path):
    tools()
    assert build(tmp_path / "out") == 0
    manifest = json.loads((tmp_path / "out" / MANIFEST).read_text())
    assert manifest["tools"]["yosys"] == "Yosys 0.71"
    assert manifest["revision"] == git_revision(bitstream.PROJECT)
    assert manifest["fmax_mhz"] == 60.0
    assert manifest["usage"]["Total LUT4s"] == {"used": 100, "available": 24288}


def test_the_second_time_stages_tell_how_long_they_took(tools, tmp_path, capfd):
    tools()
    assert build(tmp_path / "a") == 0
    assert "last time" not in capfd.readouterr().err
    assert build(tmp_path / "b") == 0
    assert "place and route (last time 0 s) ..." in capfd.readouterr().err


def test_what_is_there_already_is_not_built_again(tools, tmp_path, capfd):
    tools()
    out = tmp_path / "out"
    assert build(out) == 0
    capfd.readouterr()
    assert build(out) == 0
    assert "synthesis" not in capfd.readouterr().err
    assert build(out, "--seed", 2) == 0
    assert "synthesis" in capfd.readouterr().err
    (out / "softdepth-ulx3s-12f.bit").unlink()
    assert build(out, "--seed", 2) == 0
    assert (out / "softdepth-ulx3s-12f.bit").read_text() == "bits\n"


def test_a_missed_clock_leaves_no_bitstream(tools, tmp_path, refused):
    tools(fmax=48.5)
    out = tmp_path / "out"
    error = refused("build", "--board", "ulx3s-12f", *SMALLEST, "-o", out)
    for part in ("clock core", "48.5 MHz", "50.0 MHz", "lane.start to lane.end"):
        assert part in error
    assert not out.exists()


def test_a_clock_that_was_not_judged_leaves_no_bitstream(tools, tmp_path, refused):
    tools(wanted=25.0)
    error = refused("build", "--board", "ulx3s-12f", *SMALLEST, "-o", tmp_path / "out")
    assert "should have judged a clock of 50.00 MHz, but judged core 25.00" in error
    assert not (tmp_path / "out").exists()


def test_a_missed_clock_leaves_the_bitstream_before_it(tools, tmp_path, refused):
    tools()
    out = tmp_path / "out"
    assert build(out) == 0
    before = {file.name: file.read_bytes() for file in out.iterdir()}
    tools(fmax=48.5)
    refused("build", "--board", "ulx3s-12f", *SMALLEST, "--seed", 2, "-o", out)
    assert {file.name: file.read_bytes() for file in out.iterdir()} == before


def test_a_core_that_does_not_fit_names_what_is_short(tools, tmp_path, refused):
    tools(luts=50000)
    error = refused("build", "--board", "ulx3s-12f", *SMALLEST, "-o", tmp_path / "out")
    assert "needs 50000 LUT4, and LFE5U-12F has 24288" in error


def test_a_packer_that_fails(tools, path, tmp_path, refused):
    tools()
    path("ecppack", "echo 'ERROR: bad config'; exit 1")
    error = refused("build", "--board", "ulx3s-12f", *SMALLEST, "-o", tmp_path / "out")
    assert "ecppack failed: ERROR: bad config" in error
    assert not (tmp_path / "out").exists()


def test_unknown_board(refused, tmp_path):
    error = refused("build", "--board", "ulx3s", "-o", tmp_path / "out")
    assert "unknown board 'ulx3s'; use one of ulx3s-12f" in error


def test_a_configuration_that_contradicts_itself(refused, tmp_path):
    error = refused("build", "--board", "ulx3s-85f", "--lanes", 3, "-o", tmp_path / "out")
    assert "lanes is 3, which does not divide" in error


def test_a_missing_pin_file(tools, tmp_path, refused, monkeypatch):
    tools()
    monkeypatch.setitem(BOARDS, "ulx3s-12f", replace(find_board("ulx3s-12f"), constraints="nowhere.lpf"))
    assert "nowhere.lpf' is missing" in refused("build", "--board", "ulx3s-12f", *SMALLEST, "-o", tmp_path)


def test_programming_without_the_program_is_told_before_the_build(tools, tmp_path, refused):
    tools()
    error = refused("build", "--board", "ulx3s-12f", *SMALLEST, "-o", tmp_path / "out", "--program")
    assert "'openFPGALoader' is not on PATH" in error
    assert not (tmp_path / "out").exists()


def test_programming_loads_the_bitstream(tools, path, tmp_path):
    tools()
    path("openFPGALoader", f'echo "$@" > {tmp_path}/loaded')
    out = tmp_path / "out"
    assert build(out, "--program") == 0
    assert (tmp_path / "loaded").read_text() == f"--board ulx3s {out}/softdepth-ulx3s-12f.bit\n"


def test_a_board_that_cannot_be_programmed(tools, path, tmp_path, refused):
    tools()
    path("openFPGALoader", "exit 1")
    error = refused("build", "--board", "ulx3s-12f", *SMALLEST, "-o", tmp_path / "out", "--program")
    assert "could not load the bitstream into the ulx3s-12f" in error


def test_every_boards_default_core_is_sound():
    for board in BOARDS.values():
        assert board.config.name == board.preset
        assert board.core_hz % board.baud == 0
        assert bitstream.constraints_file(board).is_file()


def test_the_revision_is_gits(tmp_path):
    assert git_revision(tmp_path) is None
    git = shutil.which("git")
    assert git is not None
    (tmp_path / "file").write_text("1")
    for command in ("init -q", "add file", "-c user.name=a -c user.email=a@b commit -qm first"):
        subprocess.run([git, "-C", str(tmp_path), *command.split()], check=True)
    clean = git_revision(tmp_path)
    assert clean is not None
    (tmp_path / "file").write_text("2")
    assert git_revision(tmp_path) == f"{clean}-dirty"
