"""The documents hold what was measured, and name every key."""

import re

import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.golden.data import datasets
from softdepth.run.report import Report
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.studies.compare import document
from softdepth.studies.compare.agreement import Agreement, agreement
from softdepth.studies.compare.comparison import Comparison
from softdepth.studies.compare.output import FILES
from softdepth.studies.compare.sweep import Label, Point, Sweep
from softdepth.studies.markers import markers, renew
from tests.project.test_documents import table_keys
from tests.studies.compare.conftest import point


@pytest.fixture
def home(tmp_path):
    """A project whose documents have markers and nothing between them."""
    for part, path in document.PARTS.items():
        file = tmp_path / path
        file.parent.mkdir(exist_ok=True)
        earlier = file.read_text() if file.exists() else ""
        file.write_text("\n".join([earlier, *markers(part), "below"]))
    return tmp_path


def test_parts_are_renewed_from_comparisons(softdepth, home, monkeypatch):
    monkeypatch.setattr("softdepth.studies.compare.sweep.LABEL_BITS", (12,))
    monkeypatch.setattr("softdepth.studies.compare.sweep.MEMBERSHIP_BITS", (6, 8))
    monkeypatch.setattr(document, "EXHAUSTIVE_BITS", (2,))
    results = home / "results"
    for operator in ("min", "mean"):
        for seed in (1, 2):
            outcome = softdepth(
                *("compare", "--dataset", f"synthetic:random@48x30x16#{seed}", "--operator", operator),
                *("--disparities", 16, "-o", results / f"{operator}{seed}"),
            )
            assert outcome.code == 0, outcome.err
    document.main(results, home)
    text = (home / "docs/compare.md").read_text()
    files = [results / f"{name}/compare.json" for name in ("mean1", "mean2", "min1", "min2")]
    found = [Comparison.model_validate_json(path.read_text()) for path in files]
    for c in found:
        name = f"| {c.pair} | paper | {c.config['operator']} | "
        distances = (
            c.agreement.rmse,
            c.sweep.labels[0].to_float.rmse,
            point(c.sweep, 8, 12).to_same_label.rmse,
        )
        assert f"{name}{c.agreement.differ:.2f} % |" in text
        assert " | ".join(f"{rmse:.2f} px" for rmse in distances) in text
        assert f"{name}{c.metrics['float'].bad1:.2f} % | {c.metrics['fixed'].bad1:.2f} % |" in text
        assert f"{name}{c.sweep.labels[0].enough or '-'} |" in text
    order = [line.split(" | ")[:3] for line in text.splitlines() if line.startswith("| synthetic")][:4]
    assert order == [["| " + c.pair, "paper", c.config["operator"]] for c in found]
    mean = sum(point(c.sweep, 6, 12).accuracy.bad1 or 0 for c in found[:2]) / 2
    assert f"| 6 | {mean:.2f} |" in text.split("**paper, MEAN, mean of 2 pairs: Bad")[1].split("**")[1]
    assert "| `soft_min_2`, k = 100, against nested |" in (home / "docs/operators.md").read_text()
    assert (home / document.PICTURE).stat().st_size > 0
    document.main(results, home)
    assert (home / "docs/compare.md").read_text() == text


def test_results_must_be_there(home):
    with pytest.raises(InputError, match="make compare"):
        document.main(home / "nowhere", home)


def test_markers_must_be_there():
    with pytest.raises(InputError, match=r"page\.md has lost its part markers"):
        renew("text", "page.md", "part", "new")


def test_every_key_and_file_is_documented(project):
    own = set(Comparison.model_fields) - set(Report.model_fields)
    nested = {key for model in (Agreement, Label, Point) for key in model.model_fields}
    text = (project / "docs/compare.md").read_text().split("## What it writes")[1]
    assert table_keys(text) == own | nested | {*FILES, "compare.json"}
    assert set(Sweep.model_fields) == {"labels", "points"}
    assert "`labels` and `points`" in text


def documented(project, pair: str, preset: str, operator: str) -> list[str]:
    text = (project / "docs/compare.md").read_text()
    row = re.search(rf"^\| {pair} \| {preset} \| {operator} \| (.*) \|$", text, re.MULTILINE)
    assert row, "run make compare"
    return [re.sub(" %| px", "", cell) for cell in row[1].split(" | ")]


@pytest.mark.middlebury
@pytest.mark.usefixtures("data_dir")
@pytest.mark.parametrize("preset", ["paper", "lite"])
def test_documented_figures_are_reproduced(project, preset):
    config = Config.preset(preset)
    pair = datasets.load("middlebury:venus")
    fixed, paper = (model.disparity(pair.left, pair.right, config) for model in (fixed_model, float_model))
    found = agreement(fixed, paper)
    differ, differ1, _, rmse, *_ = documented(project, pair.name, preset, config.operator)
    assert (differ, differ1, rmse) == tuple(f"{v:.2f}" for v in (found.differ, found.differ1, found.rmse))


@pytest.mark.parametrize("preset", ["paper", "lite"])
def test_the_text_names_the_presets_formats(project, preset):
    config = Config.preset(preset)
    text = (project / "docs/compare.md").read_text()
    assert f"**`{preset}`: {config.membership_bits} bits, T = 2^{config.criteria[0].label_bits}.**" in text
