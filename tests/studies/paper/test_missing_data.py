"""Without its images the evaluation says so at once."""

import pytest

from softdepth.cli.app import main
from softdepth.golden.data.datasets import DATA_VARIABLE
from softdepth.studies.paper import scenes, work


def test_missing_data_is_said_before_any_work(monkeypatch, tmp_path, capfd):
    (tmp_path / "data").mkdir()
    monkeypatch.setenv(DATA_VARIABLE, str(tmp_path / "data"))
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(work, "compute", lambda *_: pytest.fail("worked without data"))
    scenes.load.cache_clear()
    assert main(["paper", "-o", str(tmp_path / "out")]) == 2
    err = capfd.readouterr().err
    assert err.count("\n") == 1
    assert f"{DATA_VARIABLE} is '{tmp_path / 'data'}', which has no teddy/im2.png; put" in err
    assert not (tmp_path / "out").exists()
    scenes.load.cache_clear()
