"""Scores, their means over scenes, and sparsification, worked out by hand."""

import math
from pathlib import Path

import numpy as np
import pytest

from softdepth.golden.data.truth import Truth
from softdepth.studies.evaluate.document import Evaluation, SceneResult
from softdepth.studies.evaluate.lanes import FIGURES, LaneFigures, core_of, known, to_json
from softdepth.studies.evaluate.score import Score, by_confidence, geometric_mean, score, sparsification
from softdepth.studies.evaluate.tables import fuzzy
from softdepth.studies.evaluate.variants import compared

ROOT = Path(__file__).resolve().parents[3]
TRUTH = Truth(
    disparity=np.array([[10, 10, 10, 10, np.nan]], np.float32),
    gray=np.zeros((1, 5), np.float32),
    nonoccluded=np.array([[True, True, True, False, False]]),
)
FOUND = np.array([[10.9, 11.5, 12.5, 20, 99]], np.float32)


def test_a_score_counts_known_pixels_and_those_that_both_views_see():
    found = score(FOUND, TRUTH, np.array([[True, True, False, False, False]]))
    assert (found.nonocc1, found.nonocc2) == pytest.approx((200 / 3, 100 / 3))
    assert (found.all1, found.all2, found.measured) == pytest.approx((75, 50, 40))
    assert found.error == pytest.approx((200 / 3 + 100 / 3 + 75 + 50) / 4)


def test_exactly_one_pixel_off_is_not_bad():
    assert score(np.full((1, 5), 11.0, np.float32), TRUTH).error == 0


def test_sparsification_leaves_out_the_least_sure_first():
    truth = Truth(np.full((1, 20), 5, np.float32), np.zeros((1, 20)), np.ones((1, 20), bool))
    found = np.full((1, 20), 5, np.float32)
    found[0, :5] = 9  # five bad ones
    sure = np.arange(20, dtype=np.uint8)[None]  # the least sure of all
    every = np.ones((1, 20), bool)
    good = sparsification(found, truth, every, sure)
    assert good.bad1 == good.best
    assert good.bad1[:6] == pytest.approx([100 * (5 - k) / (20 - k) for k in range(6)])
    assert (good.area, good.pixels) == (pytest.approx(np.mean(good.bad1)), 20)
    wrong = sparsification(found, truth, every, sure[:, ::-1].copy())
    assert wrong.bad1[-1] == 100
    assert wrong.area > 4 * good.area
    measured = every.copy()
    measured[0, :3] = False
    assert sparsification(found, truth, measured, sure).pixels == 17
    levels, bad = by_confidence(found, truth, measured, sure)
    assert levels[:6].tolist() == [0, 0, 0, 1, 1, 1]
    assert bad[:6].tolist() == [0, 0, 0, 1, 1, 0]


def evaluation(errors):
    """Scenes with the errors of two methods; the first half are of one group."""

    def scored(error):
        return Score(nonocc1=error, nonocc2=error, all1=error, all2=error)

    scenes = [
        SceneResult(
            name=str(i),
            group="a" if i < len(errors) / 2 else "b",
            width=4,
            height=4,
            scores={"clean": {"ours": scored(ours), "hh": scored(hh)}},
        )
        for i, (ours, hh) in enumerate(errors)
    ]
    return Evaluation(
        engine="fixed",
        presets={},
        hashes={},
        fuzzy=[],
        methods={"ours": "Ours", "hh": "HH"},
        ways=["clean"],
        scenes=scenes,
    )


def test_ratios_are_geometric_means_over_scenes():
    found = evaluation([(1, 2), (40, 10)])
    assert found.ratio("ours", "hh") == pytest.approx(math.sqrt(0.5 * 4))
    assert found.ratio("ours", "hh", group="a") == pytest.approx(0.5)
    assert found.score("ours").error == pytest.approx(20.5)
    assert geometric_mean([2, 8]) == pytest.approx(4)


def test_a_lane_is_told_beside_its_accuracy():
    found = evaluation([(1, 2)])
    found.fuzzy, found.lanes = ["ours"], {"ours": LaneFigures(config="x", lut4=1234, ff=5, multipliers=2.25)}
    head, row = fuzzy(found).rows
    assert dict(zip(head, row, strict=True))["LUT4 per lane"] == "1,234"
    assert row[-1] == "2.2"
    found.lanes = {"another": found.lanes["ours"]}
    assert fuzzy(found).rows[1][-2:] == ["-", "-"]
    found.lanes = {}
    assert "LUT4" not in " ".join(fuzzy(found).rows[0])


def test_only_lanes_of_the_same_core_are_known(tmp_path):
    configs = {name: config for name, config in compared().items() if name.startswith("fuzzy m")}
    figures = {
        name: LaneFigures(config=core_of(config).hash, lut4=1, ff=1, multipliers=1)
        for name, config in configs.items()
    }
    (tmp_path / "lanes.json").write_bytes(to_json(figures))
    assert known(configs, tmp_path / "lanes.json") == figures
    changed = configs | {"fuzzy min": configs["fuzzy min"].override(["membership_bits=6"])}
    assert list(known(changed, tmp_path / "lanes.json")) == ["fuzzy mean"]
    assert known(configs, tmp_path / "none.json") == {}


def test_the_lanes_of_the_project_are_those_that_are_compared():
    """Renewed by ``python -m softdepth.studies.fuzzy_lanes``."""
    assert known(compared(), ROOT / FIGURES).keys() == compared().keys()
