"""Folders of scenes, and pairs made worse."""

import shutil

import cv2
import numpy as np
import pytest

from softdepth.golden.data.synthetic import generate
from softdepth.spec.errors import InputError
from softdepth.studies.evaluate.degrade import WAYS, degraded
from softdepth.studies.evaluate.families import OTHER, family
from softdepth.studies.evaluate.scenes import find
from tests.studies.evaluate.conftest import write_scene


def test_scenes_of_both_kinds_are_found_by_name(tmp_path):
    write_scene(tmp_path / "many" / "b")
    write_scene(tmp_path / "many" / "a", middlebury=True)
    write_scene(tmp_path / "one")
    (tmp_path / "many" / "empty").mkdir()
    found = find([tmp_path / "many", tmp_path / "one"])
    assert [scene.name for scene in found] == ["a", "b", "one"]
    assert [scene.name for scene in find([tmp_path / "many"], leave_out=["a"])] == ["b"]
    for scene in found:
        pair = scene.load()
        assert pair.truth is not None
        assert pair.truth.evidence == ("cross-check" if scene.name == "a" else "warp")
        assert pair.truth.disparity.shape == (pair.height, pair.width)


def test_what_is_wrong_with_folders_is_told(tmp_path):
    write_scene(tmp_path / "a" / "same")
    write_scene(tmp_path / "b" / "same")
    (tmp_path / "none").mkdir()
    for folders, leave_out, error in (
        ([tmp_path / "missing"], (), "is not a folder"),
        ([tmp_path / "none"], (), "holds no scene"),
        ([tmp_path / "a", tmp_path / "b"], (), "two scenes are called 'same'"),
        ([tmp_path / "a"], ("other",), "there is no scene 'other'"),
    ):
        with pytest.raises(InputError, match=error):
            find(folders, leave_out)


def test_the_scale_of_2001_is_eight_levels_a_pixel(tmp_path):
    write_scene(tmp_path / "a", middlebury=True)
    for name in ("venus", "cones"):
        shutil.copytree(tmp_path / "a", tmp_path / name)
    venus, cones = (find([tmp_path / name])[0].load().truth for name in ("venus", "cones"))
    assert venus is not None
    assert cones is not None
    np.testing.assert_allclose(2 * venus.disparity, cones.disparity)


def test_families():
    names = ("venus", "cones", "art", "bowling2", "qPiano", "eth_playground", "kitti03", "kitchen")
    titles = [family(name).split()[0] for name in names]
    assert titles == ["Middlebury"] * 5 + ["ETH3D", "KITTI", OTHER]


def test_degraded_pairs_are_what_they_say():
    pair = generate("steps", width=40, height=20, disparities=8)
    made = {way: degraded(pair, way) for way in WAYS}
    assert np.abs(made["dark"].right - pair.right * 0.7).max() <= 0.5
    assert np.array_equal(made["dark"].left, pair.left)
    assert np.array_equal(made["row"].right[1:], pair.right[:-1])
    assert np.abs(made["gamma"].right / 255.0 - (pair.right / 255.0) ** 1.3).max() < 0.003
    noise = made["noise"].left.astype(int) - pair.left
    inner = (pair.left > 30) & (pair.left < 225)
    assert 4.5 < noise[inner].std() < 5.5
    assert not np.array_equal(made["noise"].left - pair.left, made["noise"].right - pair.right)
    assert all(m.truth is pair.truth for m in made.values())


def test_a_file_that_is_no_image_is_named(tmp_path):
    write_scene(tmp_path / "a")
    (tmp_path / "a" / "right.png").write_bytes(b"no image")
    with pytest.raises(InputError, match=r"right\.png"):
        find([tmp_path])[0].load()
    assert cv2.imread(str(tmp_path / "a" / "left.png")) is not None
