"""What nextpnr says is read as it is meant: area, clocks, and designs that do not fit or are too slow."""

import json
from pathlib import Path

import pytest

from softdepth.flow.families import FAMILIES, Part, part_of
from softdepth.flow.route import TimingError, place_and_route, usage
from softdepth.flow.tools import ToolRunError
from softdepth.spec.boards import BOARDS
from softdepth.spec.errors import ConfigError

PART = Part("ecp5", "LFE5U-12F", "CABGA381", "6")
LOG = """Info: Logic utilisation before packing:
Info:     Total LUT4s:     {luts}/24288    20%
Info:         logic LUTs:   1703/24288     7%
Info:      Total DFFs:      7179/24288    29%
Info: Device utilisation:
Info: 	              DP16KD:       3/     56     5%
"""


def step(kind: str, delay: float, start: str, end: str) -> dict:
    return {"type": kind, "delay": delay, "from": {"cell": start}, "to": {"cell": end}}


REPORT = {
    "fmax": {
        "fast": {"achieved": 200.0, "constraint": 25.0},
        "core": {"achieved": 80.0, "constraint": 100.0},
    },
    "critical_paths": [
        {"from": "posedge fast", "to": "posedge core", "path": [step("logic", 90.0, "x", "y")]},
        {
            "from": "posedge core",
            "to": "posedge core",
            "path": [
                step("clk-to-q", 0.5, "lane.start", "lane.start"),
                step("routing", 6.0, "lane.start", "lane.middle"),
                step("logic", 2.0, "lane.middle", "lane.middle"),
                step("routing", 3.5, "lane.middle", "lane.end"),
                step("setup", 0.5, "lane.end", "lane.end"),
            ],
        },
    ],
}


@pytest.fixture
def nextpnr(path, tmp_path: Path):
    """A nextpnr that says what the test wants: `nextpnr(luts, code)`; gives the folder to run in."""

    def place(luts: int, code: int = 0) -> Path:
        folder = tmp_path / "work"
        folder.mkdir()
        (tmp_path / "said").write_text(LOG.format(luts=luts))
        (tmp_path / "report").write_text(json.dumps(REPORT))
        path(
            FAMILIES[PART.family].placer,
            '[ "$1" = --version ] && echo "(Version nextpnr-0.11)" && exit 0\n'
            f'echo "$@" > arguments\n/bin/cat {tmp_path}/said\n/bin/cp {tmp_path}/report report.json\n'
            f"[ {code} = 0 ] || echo 'ERROR: it went wrong'\nexit {code}",
        )
        return folder

    return place


def test_counts_are_read_from_the_log():
    counted = usage(LOG.format(luts=4965))
    assert vars(counted["Total LUT4s"]) == {"used": 4965, "available": 24288}
    assert counted["DP16KD"].used == 3
    assert set(counted) == {"Total LUT4s", "logic LUTs", "Total DFFs", "DP16KD"}


def test_the_clock_with_least_to_spare_comes_first(nextpnr):
    routed = place_and_route(nextpnr(4965), PART, mhz=100, seed=7)
    slowest = routed.clocks[0]
    assert (slowest.name, slowest.fmax_mhz, slowest.wanted_mhz, slowest.met) == ("core", 80.0, 100.0, False)
    assert str(slowest.path) == "lane.start to lane.end, 12.50 ns through 1 cells"
    assert routed.clocks[1].met
    assert routed.clocks[1].path is None, "a path between two clocks limits neither"
    assert routed.used("Total LUT4s") == 4965
    assert routed.used("unheard of") == 0


def test_a_clock_that_is_missed_is_an_error_that_names_it_all(nextpnr):
    with pytest.raises(TimingError) as caught:
        place_and_route(nextpnr(4965), PART, mhz=100, seed=7).check_timing()
    problem = caught.value.problem
    for part in ("clock core", "80.0 MHz", "100.0 MHz", "seed 7", "from lane.start to lane.end", "12.50 ns"):
        assert part in problem
    assert "--seed" in caught.value.remedy


@pytest.mark.parametrize("code", [0, 1])
def test_a_design_that_does_not_fit_names_both_numbers(nextpnr, code):
    with pytest.raises(ConfigError, match="needs 30000 LUT4, and LFE5U-12F has 24288; use fewer lanes"):
        place_and_route(nextpnr(30000, code), PART, mhz=100)


def test_another_failure_is_told_as_it_is(nextpnr):
    with pytest.raises(ToolRunError, match="nextpnr-ecp5 failed: ERROR: it went wrong"):
        place_and_route(nextpnr(100, 1), PART, mhz=100)


def test_nextpnr_is_told_part_clock_seed_and_pins(nextpnr, tmp_path):
    pins = tmp_path / "board.lpf"
    pins.write_text("LOCATE")
    folder = nextpnr(100)
    place_and_route(folder, PART, mhz=62.5, seed=9, constraints=pins)
    told = (folder / "arguments").read_text()
    for part in ("--12k --package CABGA381 --speed 6", "--lpf board.lpf", "--freq 62.5 --seed 9"):
        assert part in told
    assert (folder / "board.lpf").read_text() == "LOCATE"


def test_every_board_has_a_part_that_the_tools_know():
    told = {
        name: " ".join(FAMILIES[board.family].place(part_of(board), "n", "p", "c"))
        for name, board in BOARDS.items()
    }
    assert "--85k --package CABGA381 --speed 6 --lpf c" in told["ulx3s-85f"]
    assert "--up5k --package sg48 --pcf c" in told["icebreaker"]
    assert "--device GW2AR-LV18QN88C8/I7 --vopt family=GW2A-18C --vopt cst=c" in told["tangnano20k"]
    assert {name: FAMILIES[board.family].suffix for name, board in BOARDS.items()} == {
        **{f"ulx3s-{size}f": ".bit" for size in (12, 25, 45, 85)},
        "icebreaker": ".bin",
        "tangnano20k": ".fs",
    }
