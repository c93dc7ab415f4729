"""``softdepth run`` with the simulated gateware."""

import json
import re

import pytest

from tests.support.simulator import simulate_with_faults

SMALL = ("--disparities", 4, "--lanes", 4, "--set", "max_width=64", "--preset", "lite")


@pytest.mark.slow
def test_gateware_gives_the_result_and_is_compared(softdepth, files, tmp_path):
    arguments = ("--gt", files.truth, *SMALL)
    outcome = softdepth("run", files.left, files.right, *arguments, "-o", tmp_path / "rtl")
    assert outcome.code == 0, outcome.err
    report = json.loads((tmp_path / "rtl" / "report.json").read_text())
    assert report["rtl_mismatches"] == 0
    assert report["pixels"] == 48 * 30
    assert report["cycles_per_pixel"] == pytest.approx(1, abs=0.05)
    assert report["sim_pixels_per_second"] > 0
    assert report["metrics"]["rtl"] == report["metrics"]["fixed"]
    assert report["tools"]["verilator"]
    assert "0 mismatches in 1440 pixels" in outcome.out
    softdepth("run", files.left, files.right, *arguments, "--engine", "fixed", "-o", tmp_path / "fixed")
    for name in ("disparity.png", "disparity.pfm", "overview.png", "error.png"):
        assert (tmp_path / "rtl" / name).read_bytes() == (tmp_path / "fixed" / name).read_bytes()


def test_a_mismatch_is_shown_and_fails(softdepth, files, tmp_path, monkeypatch):
    simulate_with_faults(monkeypatch, {(7, 11): 1, (8, 9): 2})
    outcome = softdepth("run", files.left, files.right, *SMALL, "-o", tmp_path / "out")
    assert outcome.code == 1
    assert "differ in 2 pixels" in outcome.err
    assert re.search(r"^  frame 0 y=7 x=11: expected .*; stage: \w", outcome.err, re.M)
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["rtl_mismatches"] == 2
