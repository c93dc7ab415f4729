"""``softdepth run`` with the models: files, report, notes. The gateware's turn is in test_run_rtl."""

import json
import tomllib

import cv2
import numpy as np
import pytest

from softdepth.golden import fixed_model, float_model
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.truth import read_truth
from softdepth.golden.score.metrics import evaluate
from softdepth.spec.config import Config

SMALL = ("--disparities", 16, "--lanes", 4)
FILES = {
    "disparity.png",
    "disparity.pfm",
    "colour.png",
    "code.png",
    "overview.png",
    "config.toml",
    "report.json",
}
IMAGES = ("max_width=48", "max_height=30")
"""The core is as large as the images."""


def config(**changes: object) -> Config:
    return Config.preset("paper").override(
        ["disparities=16", "lanes=4", *IMAGES, *(f"{k}={v}" for k, v in changes.items())]
    )


@pytest.mark.parametrize(("engine", "model"), [("fixed", fixed_model), ("float", float_model)])
def test_maps_are_the_models(softdepth, files, tmp_path, engine, model):
    out = tmp_path / "a" / "b"
    outcome = softdepth("run", files.left, files.right, *SMALL, "--engine", engine, "-o", out)
    assert outcome.code == 0, outcome.err
    assert {file.name for file in out.iterdir()} == FILES
    pair = read_pair(files.left, files.right)
    expected = model.disparity(pair.left, pair.right, config())
    written = cv2.imread(str(out / "disparity.png"), cv2.IMREAD_UNCHANGED)
    assert written is not None
    assert np.array_equal(written, np.where(expected.valid, np.maximum(expected.disparity * 256, 1), 0))
    floats = read_truth(out / "disparity.pfm", shape=expected.shape).disparity
    assert np.array_equal(np.nan_to_num(floats), expected.disparity)


def test_report_scores_every_measured_engine(softdepth, files, tmp_path):
    out = tmp_path / "out"
    outcome = softdepth(
        *("run", files.left, files.right, "--gt", files.truth, *SMALL),
        *("--engine", "fixed", "--also", "float,sad", "-o", out),
    )
    assert outcome.code == 0, outcome.err
    report = json.loads((out / "report.json").read_text())
    pair, truth = read_pair(files.left, files.right), read_truth(files.truth)
    sad = Config.preset("sad").override(["disparities=16", "lanes=4"])
    maps = {
        "fixed": fixed_model.disparity(pair.left, pair.right, config()),
        "float": float_model.disparity(pair.left, pair.right, config()),
        "sad": fixed_model.disparity(pair.left, pair.right, sad),
    }
    for engine, found in maps.items():
        expected = evaluate(found.disparity, truth, valid=found.valid).as_dict()
        assert report["metrics"][engine] == pytest.approx(expected)
        assert report["seconds"][engine] > 0
    assert report["pixels"] == 48 * 30
    assert report["config_hash"] == config().hash
    assert (out / "error.png").exists()
    assert f"{report['metrics']['fixed']['bad1']:.2f} %" in outcome.out


def test_what_an_engine_does_not_measure_is_null(softdepth, files, tmp_path):
    softdepth(
        "run", files.left, files.right, "--gt", files.truth, *SMALL, "--engine", "float", "-o", tmp_path
    )
    report = json.loads((tmp_path / "report.json").read_text())
    for key in ("rtl_mismatches", "cycles_per_pixel", "sim_pixels_per_second"):
        assert report[key] is None
    for engine in ("rtl", "fixed", "sad", "board"):
        assert set(report["metrics"][engine].values()) == {None}
        assert report["metrics"][engine].keys() == report["metrics"]["float"].keys()
    assert report["metrics"]["float"]["rmse"] is not None


def test_the_written_configuration_repeats_the_run(softdepth, files, tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    change = ("--set", "criteria.0.window=5", "--set", "reference=right", "--operator", "min")
    softdepth("run", files.left, files.right, *SMALL, *change, "--engine", "fixed", "-o", first)
    written = Config.load(first / "config.toml")
    assert written == config(reference="right", operator="min").override(["criteria.0.window=5"])
    softdepth(
        "run", files.left, files.right, "--config", first / "config.toml", "--engine", "fixed", "-o", second
    )
    assert tomllib.loads((second / "config.toml").read_text())["reference"] == "right"
    assert (first / "disparity.pfm").read_bytes() == (second / "disparity.pfm").read_bytes()


def test_dataset_by_name(softdepth, tmp_path):
    name = "synthetic:steps@60x40x16"
    outcome = softdepth("run", "--dataset", name, *SMALL, "--engine", "fixed", "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    report = json.loads((tmp_path / "report.json").read_text())
    assert (report["width"], report["height"]) == (60, 40)
    assert report["metrics"]["fixed"]["nonocc_bad1"] is not None
    assert report["metrics"]["rtl"]["nonocc_bad1"] is None


def test_gray_is_converted_with_a_note(softdepth, files, tmp_path):
    outcome = softdepth(
        "run", files.left, files.gray_right(), *SMALL, "--engine", "float", "-o", tmp_path / "out"
    )
    assert outcome.code == 0
    assert "note: gray.png is gray" in outcome.err
    assert json.loads((tmp_path / "out" / "report.json").read_text())["notes"]


def test_an_earlier_result_leaves_nothing_stale(softdepth, files, tmp_path):
    out = tmp_path / "out"
    command = ("run", files.left, files.right, *SMALL, "--engine", "float", "-o", out)
    softdepth(*command, "--gt", files.truth)
    (out / "notes.txt").write_text("mine")
    assert (out / "error.png").exists()
    softdepth(*command)
    assert {file.name for file in out.iterdir()} == {*FILES, "notes.txt"}


def test_truth_scale(softdepth, files, tmp_path):
    for scale in (1, 2):
        softdepth(
            "run",
            *(files.left, files.right, "--gt", files.truth, "--gt-scale", scale),
            *(*SMALL, "--engine", "float", "-o", tmp_path / str(scale)),
        )
    one, two = (
        json.loads((tmp_path / s / "report.json").read_text())["metrics"]["float"] for s in ("1", "2")
    )
    assert two["mae"] > one["mae"]


@pytest.mark.parametrize(
    ("engine", "also", "computed"),
    [
        ("fixed", (), {"fixed"}),
        ("float", (), {"float"}),
        ("fixed", ("--also", "float,sad"), {"fixed", "float", "sad"}),
        ("fixed", ("--also", "sad, fixed"), {"fixed", "sad"}),
        ("float", ("--also", "fixed"), {"float", "fixed"}),
        ("fixed", ("--also", "paper"), {"fixed", "paper"}),
    ],
)
def test_what_is_asked_for_is_computed_and_nothing_else(softdepth, files, tmp_path, engine, also, computed):
    outcome = softdepth("run", files.left, files.right, *SMALL, "--engine", engine, *also, "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    report = json.loads((tmp_path / "report.json").read_text())
    assert {name for name, seconds in report["seconds"].items() if seconds is not None} == computed
    assert report["engine"] == engine


@pytest.mark.parametrize("width", [48, 1300])
def test_the_core_is_as_large_as_the_images(softdepth, tmp_path, width):
    pair = ("--dataset", f"synthetic:random@{width}x1100x4" if width > 48 else "synthetic:random@48x30x4")
    few = ("--preset", "sad", "--disparities", 4, "--lanes", 4, "--engine", "fixed")
    outcome = softdepth("run", *pair, *few, "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    written = Config.load(tmp_path / "config.toml")
    height = 1100 if width > 48 else 30
    assert (written.max_width, written.max_height) == (width, height)
    assert f"note: the core is built for {width}x{height}, as large as the images" in outcome.err


def test_what_is_set_stays(softdepth, files, tmp_path):
    core = tmp_path / "core.toml"
    core.write_text("max_height = 64\n")
    arguments = (
        "--config",
        core,
        "--set",
        "max_width=100",
        *SMALL,
        "--engine",
        "fixed",
        "-o",
        tmp_path / "out",
    )
    outcome = softdepth("run", files.left, files.right, *arguments)
    assert outcome.code == 0, outcome.err
    written = Config.load(tmp_path / "out" / "config.toml")
    assert (written.max_width, written.max_height) == (100, 64)
    assert "as large as the images" not in outcome.err
