"""The command on two small scenes: tables, page, document, and what is refused before any work."""

import json

import numpy as np
import pytest

from softdepth.cli.app import main
from softdepth.golden import fixed_model
from softdepth.spec.config import Config
from softdepth.studies.evaluate import evaluation, opencv, variants, work
from softdepth.studies.evaluate.document import Evaluation
from softdepth.studies.evaluate.scenes import find
from softdepth.studies.evaluate.score import score
from tests.studies.evaluate.conftest import write_scene


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("scenes")
    write_scene(place / "cones")
    write_scene(place / "eth_small", width=64)
    return place


@pytest.fixture(scope="module")
def results(folder, tmp_path_factory):
    place = tmp_path_factory.mktemp("results")
    document = place / "accuracy.md"
    document.write_text("before\n<!-- accuracy:begin -->\nold\n<!-- accuracy:end -->\nafter\n")
    arguments = ["evaluate", "--scenes", folder, "--degraded", "--fuzzy", "--ablation"]
    arguments += ["-o", place / "out"]
    arguments += ["--set", "disparities=32", "--processes", 1, "--document", document]
    arguments += ["--preset", "robust", "--preset", "sad"]
    assert main([str(a) for a in arguments]) == 0
    return place


def test_scores_are_those_of_the_maps(folder, results):
    found = Evaluation.model_validate_json((results / "out" / "evaluate.json").read_text())
    assert [scene.name for scene in found.scenes] == ["cones", "eth_small"]
    assert found.groups == ["ETH3D", "Middlebury 2003"]
    pair = find([folder])[0].load()
    assert pair.truth is not None
    config = Config.preset("robust").override(["disparities=32"])
    robust = fixed_model.disparity(pair.left, pair.right, config)
    scores = found.scenes[0].scores["clean"]
    assert scores["robust"] == score(robust.pixels, pair.truth, robust.valid)
    assert scores["robust"].error < scores["sad"].error
    raw = opencv.match("hh", pair.left, pair.right, 32)
    assert scores["hh"] == score(opencv.filled(raw), pair.truth)
    dark = found.scenes[0].scores["dark"]
    assert dark["sad"].error > 2 * dark["robust"].error
    assert not {*found.fuzzy, *found.ablations} & set(dark)


def test_each_saving_taken_back(results):
    """Each gives another core, and all of them together one that filters as `robust` does."""
    ablations, base = variants.ablations(), Config.preset("robust-small").hash
    assert len({config.hash for config in ablations.values()} | {base}) == len(ablations) + 1
    assert ablations["all of these"].post == Config.preset("robust").post
    document = (results / "accuracy.md").read_text()
    found = Evaluation.model_validate_json((results / "out" / "evaluate.json").read_text())
    for name in ablations:
        assert f"| {name} | {found.score(name).nonocc1:.2f} |" in document


def test_every_file_is_written_and_says_the_same(results):
    out = results / "out"
    assert {file.name for file in out.iterdir()} == {
        "accuracy.md", "accuracy.html", "confidence.png", "evaluate.json",
    }  # fmt: skip
    document = (results / "accuracy.md").read_text()
    assert document.startswith("before\n")
    assert document.endswith("after\n")
    assert "old" not in document
    table = (out / "accuracy.md").read_text().removeprefix("# Accuracy\n\n").strip()
    assert table in document
    error = Evaluation.model_validate(json.loads((out / "evaluate.json").read_text())).score("robust").error
    assert f"| {error:.2f} |" in document
    page = (out / "accuracy.html").read_text()
    assert "http" not in page
    assert page.count("data:image/jpeg") == 2 * 2 + 2 * 2 * 3  # two scenes: left, truth, three maps twice


def test_the_table_fits_a_terminal_of_80_columns(results, monkeypatch, capsys):
    found = Evaluation.model_validate_json((results / "out" / "evaluate.json").read_text())
    monkeypatch.setenv("COLUMNS", "80")
    evaluation.show(evaluation.Outcome(found, {}))
    shown = capsys.readouterr().out.splitlines()
    assert len(shown) == 2 + len(found.methods) - len(found.fuzzy) - len(found.ablations)  # no row is wrapped
    assert max(map(len, shown)) <= 80
    assert any(f" {found.score('sad').error:.2f} " in line for line in shown)


def test_results_without_a_value_are_filled_for_the_score(folder):
    pair = find([folder])[0].load()
    sad = fixed_model.disparity(pair.left, pair.right, Config.preset("sad").override(["disparities=32"]))
    pixels = work.everywhere(sad)
    assert np.array_equal(pixels[sad.valid], sad.disparity[sad.valid])
    assert np.array_equal(pixels[5, 0], sad.disparity[5, 1])
    robust = fixed_model.disparity(pair.left, pair.right, Config.preset("robust"))
    assert np.array_equal(work.everywhere(robust), robust.pixels)


def test_our_filters_on_their_results_remove_islands(folder):
    pair = find([folder])[0].load()
    raw = np.full((pair.height, pair.width), 80, np.int16)
    raw[10:12, 10:12] = -16
    raw[20:40, 30:60] = -16
    raw[30, 40] = 500  # alone among invalid ones
    found = opencv.with_post(raw, pair.left, work.POST)
    assert (found == 5).all()
    assert (opencv.filled(raw)[30, 40], opencv.filled(raw)[10, 10]) == (500 / 16, 5)


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["--preset", "nothing"], "unknown preset 'nothing'"),
        (["--document", "missing.md"], "cannot read 'missing.md'"),
        (["--leave-out", "teddy"], "there is no scene 'teddy'"),
    ],
)
def test_mistakes_are_told_before_the_work(folder, arguments, error, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(work, "run", lambda *_: pytest.fail("the work has begun"))
    assert main(["evaluate", "--scenes", str(folder), *arguments]) == 2
    assert error in capsys.readouterr().err


@pytest.mark.slow
def test_scored_maps_of_the_gateware_are_the_models(tmp_path):
    """``--engine rtl`` scores simulated maps, and says for each scene in how many pixels they differ."""
    write_scene(tmp_path / "scenes" / "tiny", width=40, height=16)
    for engine in ("rtl", "fixed"):
        core = ["--preset", "sad", "--set", "disparities=8", "--set", "lanes=2"]
        arguments = [*core, "--processes", "1", "--engine", engine]
        output = tmp_path / engine
        assert main(["evaluate", "--scenes", str(tmp_path / "scenes"), *arguments, "-o", str(output)]) == 0
    simulated, model = (
        Evaluation.model_validate_json((tmp_path / engine / "evaluate.json").read_text())
        for engine in ("rtl", "fixed")
    )
    assert (simulated.engine, model.engine) == ("rtl", "fixed")
    assert simulated.scenes[0].mismatches == {"sad": 0}
    assert model.scenes[0].mismatches == {}
    assert simulated.scenes[0].scores == model.scenes[0].scores
