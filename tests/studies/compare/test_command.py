"""``softdepth compare``: its files, its figures, and what it refuses."""

import json
import re

import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.truth import read_truth
from softdepth.spec.config import Config
from softdepth.studies.compare import comparison
from softdepth.studies.compare.agreement import agreement
from softdepth.studies.compare.comparison import Comparison, estimate
from softdepth.studies.compare.output import FILES
from softdepth.studies.compare.sweep import formats
from tests.studies.compare.conftest import point
from tests.support.simulator import simulate_with_faults

SMALL = ("--disparities", 16, "--lanes", 4)


@pytest.fixture
def quick(monkeypatch):
    """A sweep of few formats."""
    monkeypatch.setattr("softdepth.studies.compare.sweep.LABEL_BITS", (12,))
    monkeypatch.setattr("softdepth.studies.compare.sweep.MEMBERSHIP_BITS", (5, 8))


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("reference", ["left", "right"])
def test_figures_are_those_of_the_models(softdepth, files, config, tmp_path, reference):
    out = tmp_path / "out"
    change = ("--set", f"reference={reference}")
    outcome = softdepth("compare", files.left, files.right, "--gt", files.truth, *SMALL, *change, "-o", out)
    assert outcome.code == 0, outcome.err
    assert {file.name for file in out.iterdir()} == {*FILES, "compare.json"}
    found = Comparison.model_validate_json((out / "compare.json").read_text())
    pair, truth = read_pair(files.left, files.right), read_truth(files.truth, view=reference)
    config = config.override([f"reference={reference}", "max_width=48", "max_height=30"])
    fixed, paper = (model.disparity(pair.left, pair.right, config) for model in (fixed_model, float_model))
    assert found.agreement == agreement(fixed, paper, truth)
    assert point(found.sweep, 8, 12).to_float == found.agreement
    assert point(found.sweep, 8, 12).accuracy == found.metrics["fixed"]
    assert found.metrics["float"].paper_rmse is not None
    assert found.config_hash == config.hash
    assert Config.load(out / "config.toml") == config
    assert f"{found.agreement.differ:.2f} % of {found.agreement.pixels} pixels differ" in outcome.out
    assert "label 2^12: " in outcome.out
    assert "2 number formats" in outcome.err
    assert re.search(r"^note: the number formats will take \d+ (s|min) or so$", outcome.err, re.MULTILINE)
    row = f"| 8 | {found.agreement.rmse:.2f} |"
    assert row in (out / "compare.md").read_text()


@pytest.mark.usefixtures("quick")
def test_without_truth(softdepth, files, tmp_path):
    outcome = softdepth("compare", files.left, files.right, *SMALL, "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    found = json.loads((tmp_path / "compare.json").read_text())
    assert found["agreement"]["closer"] is None
    assert found["sweep"]["labels"][0]["enough"] is None
    assert found["agreement"]["pixels"] > 0
    assert "enough" not in outcome.out
    assert "Bad pixels" not in (tmp_path / "compare.md").read_text()


def test_a_cost_without_memberships_is_refused(softdepth, files, tmp_path):
    out = tmp_path / "new" / "out"
    outcome = softdepth("compare", files.left, files.right, *SMALL, "--preset", "sad", "-o", out)
    assert outcome.code == 2
    assert "cost is 'sum'" in outcome.error
    assert not out.parent.exists()


def test_a_failure_leaves_the_earlier_comparison(softdepth, files, tmp_path, monkeypatch):
    out = tmp_path / "out"
    out.mkdir()
    (out / "compare.json").write_text("earlier")

    def fail(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(comparison, "sweep", fail)
    outcome = softdepth("compare", files.left, files.right, *SMALL, "-o", out)
    assert outcome.code == 130
    assert [(file.name, file.read_text()) for file in out.iterdir()] == [("compare.json", "earlier")]


@pytest.mark.usefixtures("quick")
def test_a_gateware_that_differs_fails(softdepth, files, tmp_path, monkeypatch):
    simulate_with_faults(monkeypatch, {(9, 20): 1})
    outcome = softdepth("compare", files.left, files.right, *SMALL, "--engine", "rtl", "-o", tmp_path / "out")
    assert outcome.code == 1
    assert "y=9 x=20: expected" in outcome.err
    assert json.loads((tmp_path / "out" / "compare.json").read_text())["rtl_mismatches"] == 1


@pytest.mark.slow
@pytest.mark.usefixtures("quick")
def test_the_simulated_gateware_gives_the_same_comparison(softdepth, files, tmp_path):
    small = ("--disparities", 4, "--lanes", 4, "--set", "max_width=64", "--preset", "lite")
    found = {}
    for engine in ("rtl", "fixed"):
        out = tmp_path / engine
        outcome = softdepth("compare", files.left, files.right, *small, "--engine", engine, "-o", out)
        assert outcome.code == 0, outcome.err
        found[engine] = json.loads((out / "compare.json").read_text())
    assert found["rtl"]["rtl_mismatches"] == 0
    assert found["rtl"]["agreement"] == found["fixed"]["agreement"]
    assert found["rtl"]["sweep"] == found["fixed"]["sweep"]


def test_the_estimate_counts_every_run(config):
    labels = len({each.criteria[0].label_bits for each in formats(config)})
    seconds = {"fixed": 2.0, "float": 10.0}
    assert estimate(config, seconds) == 2 * len(formats(config)) + 10 * labels
