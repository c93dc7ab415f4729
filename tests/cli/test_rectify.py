"""``softdepth rectify``: files in, files out, and what it says."""

import pytest

from softdepth.golden.data.writers import write_picture
from softdepth.rig.rectify import Rectifier
from tests.rig import rigs
from tests.rig.test_rectify import raw_pair


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    folder = tmp_path_factory.mktemp("raw")
    _, views = raw_pair(Rectifier.of(rigs.rig(), rigs.SIZE))
    for name, view in zip(("left.png", "right.png"), views, strict=True):
        write_picture(folder / name, view)
    rigs.opencv(folder / "rig.yml", 0.001)
    return folder


def test_a_raw_pair_becomes_a_rectified_one(softdepth, raw, tmp_path):
    out = tmp_path / "out"
    images = (raw / "left.png", raw / "right.png")
    outcome = softdepth("rectify", *images, "--calibration", raw / "rig.yml", "--unit", 0.001, "-o", out)
    assert outcome.code == 0, outcome.err
    assert {path.name for path in out.iterdir()} == {
        "left.png",
        "right.png",
        "calibration.yml",
        "epipolar.png",
    }
    assert "baseline 120.0" in outcome.out
    assert "row budget, left: " in outcome.out
    again = softdepth("inspect", out / "left.png", out / "right.png")
    assert "not rectified" not in again.out
    assert "rows are offset" not in again.out
    assert "not rectified" in softdepth("inspect", *images).out
    once_more = softdepth("rectify", *images, "--calibration", out / "calibration.yml")
    assert "rectified images" in once_more.error


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--calibration", "none.yml"], "cannot be read"),
        (["--calibration", "rig.yml", "--unit", "0"], "--unit 0 is not a length"),
        ([], "calibration"),
    ],
)
def test_a_wrong_call_writes_nothing(softdepth, raw, tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(raw)
    outcome = softdepth("rectify", "left.png", "right.png", *arguments, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert message in outcome.error
    assert not (tmp_path / "out").exists()
