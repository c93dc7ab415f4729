"""A pair as users have it: on standard input, in one file, of any depth, with a truth that does not fit."""

import io
import json
import re
import subprocess
import sys

import cv2
import numpy as np
import pytest
from PIL import Image

from softdepth.golden import fixed_model
from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.truth import read_truth
from softdepth.golden.data.writers import write_pfm
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity
from tests.support.images import read_image

SMALL = ("--disparities", 16, "--lanes", 4, "--preset", "sad", "--engine", "fixed")


@pytest.fixture
def standard_input(monkeypatch):
    """Let standard input hold these bytes."""

    def hold(data: bytes) -> None:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    return hold


@pytest.fixture
def plain(softdepth, files, tmp_path):
    """The map of the pair's two files, as bytes."""
    assert softdepth("run", files.left, files.right, *SMALL, "-o", tmp_path / "plain").code == 0
    return (tmp_path / "plain" / "disparity.pfm").read_bytes()


def report(folder):
    return json.loads((folder / "report.json").read_text())


@pytest.mark.parametrize("which", ["left", "right", "truth"])
def test_standard_input(softdepth, files, tmp_path, standard_input, plain, which):
    names = {"left": files.left, "right": files.right, "truth": files.truth}
    standard_input(names[which].read_bytes())
    names[which] = "-"
    out = tmp_path / "out"
    outcome = softdepth("run", names["left"], names["right"], "--gt", names["truth"], *SMALL, "-o", out)
    assert outcome.code == 0, outcome.err
    assert (out / "disparity.pfm").read_bytes() == plain
    assert report(out)["metrics"]["fixed"]["bad1"] is not None
    assert report(out)["pair"] == ("stdin" if which == "left" else "left")


def test_standard_input_once(softdepth, files, standard_input):
    standard_input(files.left.read_bytes())
    assert "standard input" in softdepth("run", "-", "-", *SMALL).error
    assert "standard input" in softdepth("run", "-", files.right, "--gt", "-", *SMALL).error


def test_standard_input_without_a_picture(softdepth, files, standard_input):
    standard_input(b"")
    assert "standard input is empty" in softdepth("run", "-", files.right, *SMALL).error
    standard_input(b"hello")
    assert "cannot be decoded" in softdepth("run", "-", files.right, *SMALL).error


@pytest.mark.parametrize("option", ["--side-by-side", "--top-bottom"])
def test_a_pair_in_one_file(softdepth, files, tmp_path, plain, option):
    both = [read_image(path).pixels for path in (files.left, files.right)]
    path = tmp_path / "both.png"
    Image.fromarray(np.hstack(both) if option == "--side-by-side" else np.vstack(both)).save(path)
    outcome = softdepth("run", path, option, *SMALL, "--gt", files.truth, "-o", tmp_path / "out")
    assert outcome.code == 0, outcome.err
    assert (tmp_path / "out" / "disparity.pfm").read_bytes() == plain


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("--side-by-side",), "takes one file with both views, 0 given"),
        (("LEFT", "RIGHT", "--top-bottom"), "takes one file with both views, 2 given"),
        (("LEFT", "--side-by-side", "--top-bottom"), "contradict"),
        (("LEFT",), "--side-by-side"),
        (("--dataset", "motorcycle", "--side-by-side"), "brings its own images"),
        (("--dataset", "motorcycle", "--bits", "10"), "brings its own images"),
        (("LEFT", "RIGHT", "--bits", "7"), "more than --bits 7 allows"),
    ],
)
def test_what_contradicts(softdepth, files, tmp_path, arguments, problem):
    named = [{"LEFT": files.left, "RIGHT": files.right}.get(a, a) for a in arguments]
    outcome = softdepth("run", *named, *SMALL, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert problem in outcome.error


def test_ten_bits_score_as_eight(softdepth, tmp_path):
    """A PGM that says 1023 is no dark 16-bit picture."""
    pair = generate("slanted", width=64, height=40, disparities=16, seed=5)
    views = [image[:, :, 1] for image in (pair.left, pair.right)]
    assert pair.truth is not None
    write_pfm(tmp_path / "truth.pfm", pair.truth.disparity)
    scores = []
    for bits in (8, 10):
        names = [tmp_path / f"{side}{bits}.pgm" for side in "ab"]
        for name, view in zip(names, views, strict=True):
            samples = view if bits == 8 else (view.astype(np.uint16) * 4 + view // 64).astype(">u2")
            name.write_bytes(b"P5\n64 40\n%d\n" % (2**bits - 1) + samples.tobytes())
        out = tmp_path / str(bits)
        outcome = softdepth("run", *names, "--gt", tmp_path / "truth.pfm", *SMALL, "-o", out)
        assert outcome.code == 0, outcome.err
        scores.append(report(out)["metrics"]["fixed"]["bad1"])
    assert scores[0] == scores[1]
    assert "10 bits a channel: reduced to the 8 of the core" in outcome.err


@pytest.mark.parametrize("pixel", ["gray12", "rgb12", "gray10"])
def test_a_twelve_bit_camera_on_a_core_of_its_pixels(softdepth, files, tmp_path, pixel):
    """Nothing is lost on the way to a core of the camera's depth, and nothing is tripled for a gray one."""
    views, names = [], []
    for path in (files.left, files.right):
        red, green, _ = (read_image(path).pixels[:, :, c].astype(np.uint16) for c in range(3))
        views.append(green * 16 + red // 16)
        names.append(tmp_path / f"raw_{path.name}")
        cv2.imwrite(str(names[-1]), views[-1])
    outcome = softdepth("run", *names, *SMALL, "--set", f"pixel={pixel}", "--also", "sad", "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    assert ("all three channels" in outcome.err) == (pixel == "rgb12")
    assert ("reduced to the 10 of the core" in outcome.err) == (pixel == "gray10")
    if pixel == "gray10":
        views = [np.rint(view * (1023 / 4095)).astype(np.uint16) for view in views]
    if pixel == "rgb12":
        views = [np.dstack([view] * 3) for view in views]
    config = Config.preset("sad").override(["disparities=16", "lanes=4", f"pixel={pixel}"])
    expected = fixed_model.disparity(*views, config)
    found = read_truth(tmp_path / "disparity.pfm").disparity
    np.testing.assert_array_equal(np.nan_to_num(found), expected.disparity)


def test_bits_of_a_dark_camera(softdepth, files, tmp_path):
    names = []
    for path in (files.left, files.right):
        names.append(tmp_path / f"dark_{path.name}")
        cv2.imwrite(str(names[-1]), read_image(path).pixels[:, :, 1].astype(np.uint16))
    outcome = softdepth("run", *names, *SMALL, "-o", tmp_path / "a")
    assert "so read as 8 bits; --bits N" in outcome.err
    outcome = softdepth("run", *names, "--bits", 12, *SMALL, "-o", tmp_path / "b")
    assert "so read as" not in outcome.err
    assert "less than a quarter of the range" in outcome.err


def test_what_is_scored_is_always_told(softdepth, files, tmp_path):
    outcome = softdepth("run", files.left, files.right, *SMALL, "-o", tmp_path)
    assert "scored: no pixel, because no ground truth is given" in outcome.out
    found = report(tmp_path)
    assert found["truth"] is None
    code = np.asarray(Image.open(tmp_path / "code.png"))
    assert found["metrics"]["fixed"]["density"] == pytest.approx(100 * np.mean(code < Validity.BORDER))
    assert found["metrics"]["fixed"]["bad1"] is None
    truth = read_truth(files.truth).disparity
    truth[:10] = np.nan
    write_pfm(tmp_path / "part.pfm", truth)
    outcome = softdepth("run", files.left, files.right, "--gt", tmp_path / "part.pfm", *SMALL, "-o", tmp_path)
    known = np.isfinite(truth)
    scored = report(tmp_path)["truth"]
    assert scored["scored"] == known.sum()
    assert scored["scored_percent"] == pytest.approx(100 * known.mean())
    assert (scored["outside"], scored["outside_percent"]) == (0, 0)
    assert f"scored: {known.sum()} pixels of known disparity, {100 * known.mean():.2f} %" in outcome.out
    assert "outside" not in outcome.out


def test_truth_out_of_reach_counts_as_wrong(softdepth, files, tmp_path):
    """Converging cameras: what lies behind has negative disparities, which no candidate reaches."""
    truth = read_truth(files.truth).disparity
    known = np.isfinite(truth)
    truth[:, :12] = -6
    truth[:, 12:24] = 40
    known[:, :24] = True
    write_pfm(path := tmp_path / "far.pfm", np.where(known, truth, np.nan))
    outcome = softdepth("run", files.left, files.right, "--gt", path, *SMALL, "-o", tmp_path)
    found = report(tmp_path)
    outside = 24 * 30
    assert found["truth"]["scored"] == known.sum()
    assert found["truth"]["outside"] == outside
    share = 100 * outside / known.sum()
    assert found["truth"]["outside_percent"] == pytest.approx(share)
    assert f"{share:.2f} % of them lie outside 0 .. 15, and count as wrong, not as absent" in outcome.out
    assert found["metrics"]["fixed"]["bad1"] >= share


def test_levels_that_cannot_be_right(softdepth, files, tmp_path):
    levels = np.nan_to_num(read_truth(files.truth).disparity).astype(np.uint8)
    levels[3, 3] = 15
    cv2.imwrite(str(path := tmp_path / "levels.png"), levels)
    outcome = softdepth("run", files.left, files.right, "--gt", path, *SMALL, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert "--gt-scale 1" in outcome.error
    command = ("run", files.left, files.right, "--gt", path, "--gt-scale", 1, *SMALL, "-o", tmp_path / "out")
    assert softdepth(*command).code == 0


def test_codes_of_the_model_are_written(softdepth, files, tmp_path):
    softdepth("run", files.left, files.right, *SMALL, "-o", tmp_path)
    config = Config.preset("sad").override(["disparities=16", "lanes=4"])
    left, right = (read_image(path).pixels for path in (files.left, files.right))
    code = fixed_model.disparity(left, right, config).code
    assert {Validity.FULL, Validity.PARTIAL, Validity.BORDER} == set(np.unique(code))
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "code.png")), code)


def test_partial_results_look_different(softdepth, files, tmp_path):
    """With flat views every disparity is 0, so a change of colour is one of code."""
    image = np.full((30, 48, 3), 90, np.uint8)
    Image.fromarray(image).save(path := tmp_path / "flat.png")
    softdepth("run", path, path, *SMALL, "-o", tmp_path / "out")
    colours = np.asarray(Image.open(tmp_path / "out" / "colour.png").convert("RGB")).astype(int)
    code = np.asarray(Image.open(tmp_path / "out" / "code.png"))
    shades = {kind: np.unique(colours[code == kind], axis=0) for kind in np.unique(code)}
    assert all(len(shade) == 1 for shade in shades.values())
    assert np.abs(shades[Validity.FULL] - shades[Validity.PARTIAL]).max() > 60


def test_a_real_standard_input(files, tmp_path):
    """A pipe, in a process of its own."""
    command = [sys.executable, "-m", "softdepth", "run", "-", files.right, *SMALL, "-o", tmp_path / "out"]
    with files.left.open("rb") as left:
        done = subprocess.run(
            [str(part) for part in command], stdin=left, capture_output=True, text=True, check=False
        )
    assert done.returncode == 0, done.stderr
    assert re.search(r"^stdin, 48x30", done.stdout, re.MULTILINE)


def test_sixteenths_and_filled_pixels(softdepth, files, tmp_path):
    """Files are in pixels; a filled pixel has a disparity and is scored, but nobody measured it."""
    out = tmp_path / "out"
    small = ("--preset", "robust-small", "--disparities", 16, "--lanes", 4, "--engine", "fixed")
    outcome = softdepth("run", files.left, files.right, "--gt", files.truth, *small, "-o", out)
    assert outcome.code == 0, outcome.err
    config = Config.load(out / "config.toml")
    found = fixed_model.disparity(*(read_image(path).pixels for path in (files.left, files.right)), config)
    assert config.post.fraction_bits == 4
    assert (found.code == Validity.FILLED).any()
    written = read_truth(out / "disparity.pfm").disparity
    np.testing.assert_array_equal(written[found.given], found.pixels[found.given])
    assert np.isnan(written[~found.given]).all()
    scores = report(out)["metrics"]["fixed"]
    assert scores["density"] == pytest.approx(100 * found.valid.mean())
    truth = read_truth(files.truth)
    error = np.abs(found.pixels - truth.disparity)[truth.known]
    assert scores["bad1"] == pytest.approx(100 * np.mean((error > 1) | ~found.given[truth.known]))
    assert scores["measured_mae"] == pytest.approx(error[found.valid[truth.known]].mean(), rel=1e-5)
