"""The host's end, against a board in Python that misbehaves in every way it can."""

import json
import os
import shutil
import stat
from pathlib import Path

import cv2
import numpy as np
import pytest

from softdepth.board.device import Device
from softdepth.board.link import TRIES, Link
from softdepth.board.port import Port
from softdepth.golden import fixed_model
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.synthetic import generate
from softdepth.run.report import FILES
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError, InputError, ToolError
from softdepth.spec.protocol import Reason, describe
from tests.board.fake import FakeBoard, Misdeeds, plugged_in
from tests.cli.conftest import Files

BAUD = 2_000_000
FAST = 0.25
"""Seconds to wait for the answer of a board that is a thread."""


def pair(config: Config, height: int = 9, width: int = 14) -> tuple[np.ndarray, np.ndarray]:
    left, right = np.random.default_rng(5).integers(0, 256, (2, height, width, 3), dtype=np.uint8)
    return left, right


def compute(board: FakeBoard, timeout: float = FAST) -> dict[str, int]:
    """A frame through the board, checked against the model; what befell the packets."""
    left, right = pair(board.config)
    with Port(board.path, BAUD) as port:
        device = Device(Link(port, timeout))
        found = device.disparity(left, right)
        expected = fixed_model.disparity(left, right, board.config)
        assert list(expected.differences(found)) == []
        return device.link_counters()


def failure(config: Config, misdeeds: Misdeeds) -> str:
    with plugged_in(config, misdeeds) as board, pytest.raises(ToolError) as caught:
        compute(board)
    return str(caught.value)


@pytest.mark.parametrize("changes", [[], ["reference=left"], ["disparities=128"], ["criteria.0.window=7"]])
def test_the_map_is_the_models(config, changes):
    with plugged_in(config.override(changes)) as board:
        counters = compute(board, timeout=5)
    assert counters["repeated"] == counters["timeouts"] == 0
    assert len(board.lines) == 9


@pytest.mark.parametrize("changes", [[], ["post.confidence=false"]])
def test_fractions_codes_and_confidence_are_the_models(changes):
    """`compute` compares all of them."""
    keys = ("disparities=8", "lanes=2", "max_width=64", *changes)
    with plugged_in(Config.preset("robust-small").override(keys)) as board:
        compute(board, timeout=5)


def test_lost_and_garbled_replies_are_asked_for_again(config):
    numbers = frozenset({0, 1, 4, 5, 9, 14, 15, 16})
    with plugged_in(config, Misdeeds(lose_replies=numbers)) as board:
        counters = compute(board)
        assert len(board.lines) == 9  # no line was carried out twice
    assert counters["timeouts"] >= 3
    with plugged_in(config, Misdeeds(garble_replies=numbers)) as board:
        counters = compute(board, timeout=5)
        assert len(board.lines) == 9
    assert counters["broken"] >= 5  # those after may come too late to be read
    assert counters["timeouts"] == 0  # a broken answer is noticed at once


def test_a_silent_port_is_no_board(config):
    message = failure(config, Misdeeds(silent_after=0))
    assert "no board answers" in message
    assert f"at {BAUD} baud" in message


def test_a_board_that_stops_is_given_up(config):
    message = failure(config, Misdeeds(silent_after=5))
    assert f"{TRIES} tries of a packet failed" in message


def test_a_line_that_breaks_everything_is_given_up(config):
    message = failure(config, Misdeeds(garble_replies=frozenset(range(3, 1000))))
    assert "is too bad" in message
    assert "answers were broken" in message


@pytest.mark.parametrize(
    ("reason", "text"),
    [
        (Reason.SIZE, "cannot take images of this size"),
        (Reason.SESSION, "was reset in the middle"),
        (Reason.CORE, "broke its own rules"),
        (Reason.TYPE, "does not know a request"),
    ],
)
def test_refusals_are_told(config, reason, text):
    assert text in failure(config, Misdeeds(refuse=reason))


def test_another_version_of_the_protocol_is_told(config):
    assert "speaks version 9 of the protocol, this program 1" in failure(
        config, Misdeeds(version=9, refuse=Reason.TYPE)
    )


@pytest.mark.parametrize(
    "hello",
    [b"\xff", b"{}", b"[1]", b'{"board":"b","revision":"r","hash":"0","config":{"colour":1}}'],
)
def test_an_unknown_description_is_told(config, hello):
    assert "a core that this version does not know" in failure(config, Misdeeds(hello=hello))


def test_defaults_that_have_changed_are_found(config):
    said = json.loads(describe(config, "ulx3s-85f", "0.0.1"))
    said["config"]["membership_bits"] = 7
    message = failure(config, Misdeeds(hello=json.dumps(said).encode()))
    assert config.hash in message
    assert "0.0.1" in message


def test_lines_out_of_order_are_no_result(config):
    assert "line 1 of the results came in place of line 0" in failure(config, Misdeeds(swap_rows=True))


def test_a_core_that_counts_damage_gives_no_result(config):
    assert "counts broken frames: (0, 2, 0, 0)" in failure(config, Misdeeds(core_counters=(0, 2, 0, 0)))


def test_a_board_without_results_is_given_up(config):
    assert "sent 0 of 9 lines" in failure(config, Misdeeds(never_ready=True))


def test_another_configuration_is_refused_naming_both(config):
    wanted = config.override(["lanes=4"])
    with plugged_in(config) as board, Port(board.path, BAUD) as port:
        device = Device(Link(port))
        device.check(config.override(["name=other"]))  # a name builds no other core
        with pytest.raises(ConfigError) as caught:
            device.check(wanted)
    assert config.hash in caught.value.problem
    assert wanted.hash in caught.value.problem


def test_a_port_has_one_user(config):
    with plugged_in(config) as board, Port(board.path, BAUD):
        with pytest.raises(InputError) as caught:
            Port(board.path, BAUD)
        assert "in use by another program" in str(caught.value)


def test_ports_that_cannot_be_opened_are_told(tmp_path):
    with pytest.raises(InputError, match="there is no serial port"):
        Port(str(tmp_path / "ttyUSB9"), BAUD)
    plain = tmp_path / "file"
    plain.touch()
    with pytest.raises(InputError, match="is not a usable serial port"):
        Port(str(plain), BAUD)
    if os.geteuid():  # root may open anything
        plain.chmod(stat.S_IRUSR)
        with pytest.raises(InputError, match="dialout"):
            Port(str(plain), BAUD)


def test_a_port_that_goes_away_before_the_first_packet():
    master, slave = os.openpty()
    with Port(os.ttyname(slave), BAUD) as port:
        os.close(master)
        for use in (port.drain, lambda: port.write(b"x"), lambda: port.read(0.1)):
            with pytest.raises(ToolError, match="was unplugged or switched off"):
                use()
    os.close(slave)


def test_a_sequence_through_a_board(config, files, softdepth, tmp_path):
    for side, path in (("left", files.left), ("right", files.right)):
        (tmp_path / side).mkdir()
        for k in range(3):
            shutil.copy(path, tmp_path / side / f"{k}.png")
    out = tmp_path / "out"
    with plugged_in(config) as board:
        command = ("board", "--port", board.path, tmp_path / "left", tmp_path / "right", "--processes", 1)
        outcome = softdepth(*command, "-o", out)
        assert outcome.code == 0, outcome.err
        again = softdepth(*command, "-o", out)
        assert "3 of them from an earlier run" in again.out
        refused = softdepth(*command, "--dataset", "motorcycle", "-o", out)
        assert "with a sequence" in refused.error
    assert "frames a second, there and back" in outcome.out
    assert "gateware against fixed model: 0 mismatches" in outcome.out
    summary = json.loads((out / "sequence.json").read_text())
    assert (summary["engine"], summary["config_hash"]) == ("board", config.hash)
    shown = read_pair(files.left, files.right)
    expected = fixed_model.disparity(shown.left, shown.right, config)
    for k in range(3):
        written = cv2.imread(str(out / "frames" / str(k) / "disparity.png"), cv2.IMREAD_UNCHANGED)
        assert np.array_equal(written, np.where(expected.valid, np.maximum(expected.disparity * 256, 1), 0))


def test_the_command_takes_the_boards_configuration(config, files, softdepth, tmp_path):
    out = tmp_path / "out"
    with plugged_in(config) as board:
        outcome = softdepth(
            "board", "--port", board.path, files.left, files.right, "--gt", files.truth, "-o", out
        )
    assert outcome.code == 0, outcome.err
    assert {path.name for path in out.iterdir()} == {*FILES, "report.json"}
    report = json.loads((out / "report.json").read_text())
    assert (report["engine"], report["config_hash"]) == ("board", config.hash)
    assert (report["rtl_mismatches"], report["metrics"]["rtl"]["bad1"]) == (0, None)
    assert report["metrics"]["board"] == report["metrics"]["fixed"]
    assert report["link"]["repeated"] == 0
    shown = read_pair(files.left, files.right)
    expected = fixed_model.disparity(shown.left, shown.right, config)
    written = cv2.imread(str(out / "disparity.png"), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(written, np.where(expected.valid, np.maximum(expected.disparity * 256, 1), 0))
    assert "0 mismatches in 960 pixels" in outcome.out
    assert "0 arrived broken" in outcome.out
    for column in ("board", "fixed", "float", "plain SAD"):
        assert column in outcome.out


def test_the_command_refuses_another_configuration(config, files, softdepth, tmp_path):
    with plugged_in(config) as board:
        outcome = softdepth(
            *("board", "--port", board.path, files.left, files.right),
            *("--preset", "paper", "-o", tmp_path / "out"),
        )
    assert outcome.code == 2
    assert config.hash in outcome.error
    assert Config.preset("paper").hash in outcome.error
    assert not (tmp_path / "out").exists()


def test_the_command_refuses_a_pair_that_is_too_wide(config, softdepth, tmp_path):
    """No option makes the board's core wider."""
    wide = Files.written(generate("random", width=config.max_width + 1, height=24), tmp_path / "wide")
    with plugged_in(config) as board:
        outcome = softdepth("board", "--port", board.path, wide.left, wide.right, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert "is 65x24, but the core is built for max_width = 64; give smaller images" in outcome.error
    assert not (tmp_path / "out").exists()


def test_a_wrong_core_is_a_mismatch(config, files, softdepth, tmp_path):
    """A board that says one thing and computes another is found out."""
    with plugged_in(
        config.override(["criteria.0.window=5"]), Misdeeds(hello=describe(config, "b", "r"))
    ) as board:
        outcome = softdepth("board", "--port", board.path, files.left, files.right, "-o", tmp_path / "out")
    assert outcome.code == 1
    assert "gateware and fixed-point model differ" in outcome.err


def test_unplugging_leaves_nothing_half_written(config, files, softdepth, tmp_path):
    with plugged_in(config, Misdeeds(dies_after=9)) as board:
        outcome = softdepth("board", "--port", board.path, files.left, files.right, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert "was unplugged or switched off" in outcome.error
    assert not (tmp_path / "out").exists()
    assert list(tmp_path.iterdir()) == [files.folder]


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--baud", 0), "--baud 0 is not a rate"),
        (("--baud", 1 << 31, "--port", "/dev/ptmx"), "'/dev/ptmx' is not a usable serial port"),
        (("--timeout", -1), "--timeout -1 is not a time"),
        (("--board", "toaster"), "unknown board 'toaster'"),
    ],
)
def test_options_are_checked_first(softdepth, options, text):
    assert text in softdepth("board", "--port", Path("/nowhere"), "a", "b", *options).error
