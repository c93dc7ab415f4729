"""The page: complete in itself, and what a browser shows of it."""

import base64
import re
import shutil
import subprocess

import cv2
import numpy as np
import pytest

from softdepth.metric.scene import Scene
from softdepth.rig.geometry import Geometry
from softdepth.view import page as module
from softdepth.view.page import page

FLAGS = (
    *("--headless", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync", "--enable-unsafe-swiftshader", "--use-gl=angle"),
    *("--use-angle=swiftshader", "--window-size=1000,1300", "--virtual-time-budget=10000"),
)


@pytest.fixture
def scene() -> Scene:
    """A green wall with a red square in front of it, and a stripe without depth."""
    depth = np.full((60, 80), 3.0, np.float32)
    image = np.full((60, 80, 3), (20, 160, 40), np.uint8)
    depth[20:40, 30:50], image[20:40, 30:50] = 1.5, (230, 20, 20)
    depth[:, :6] = np.nan
    return Scene(Geometry(90, 0.1, cx=40, cy=30), depth, np.zeros(depth.shape, bool), image)


def test_it_loads_nothing(scene):
    text = page("a <pair>", scene, np.full((60, 80), 128, np.uint8), ("preset & all",))
    own = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
    assert "a &lt;pair&gt;" in own
    assert "preset &amp; all" in own
    assert not re.search(r"(src|href)=[\"'](?!data:)", own)
    assert "<script src" not in text
    assert own.count("data:image/png;base64,") == 3
    assert "4,440 points" in own


def test_without_image_or_confidence(scene):
    text = page("x", Scene(scene.geometry, scene.depth, scene.filled))
    own = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
    assert own.count("data:image/png;base64,") == 1


def test_a_scene_without_depth(scene):
    nothing = Scene(scene.geometry, np.full_like(scene.depth, np.nan), scene.filled, scene.image)
    assert "0 points" in page("x", nothing)


def test_what_is_far_does_not_look_like_what_has_no_depth(scene):
    text = page("x", scene)
    pictures = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", text)
    shown = cv2.imdecode(np.frombuffer(base64.b64decode(pictures[1]), np.uint8), cv2.IMREAD_COLOR)
    assert shown is not None
    none, far = shown[5, 2].astype(int), shown[5, 60].astype(int)
    assert none.max() < 40
    assert far.max() > 150


def test_many_points_are_thinned(scene, monkeypatch):
    monkeypatch.setattr(module, "MAX_POINTS", 1000)
    assert "thinned to at most 1,000" in page("x", scene)


@pytest.mark.slow
def test_a_browser_shows_it(scene, tmp_path):
    """Pictures in the upper part, the cloud's red square below them."""
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    if browser is None:
        pytest.skip("chromium is not there; on Debian: sudo apt-get install -y chromium")
    (tmp_path / "view.html").write_text(page("x", scene))
    shot = tmp_path / "shot.png"
    subprocess.run(
        [
            browser,
            *FLAGS,
            f"--user-data-dir={tmp_path / 'user'}",
            f"--screenshot={shot}",
            tmp_path / "view.html",
        ],
        check=True,
        capture_output=True,
        timeout=120,
    )
    picture = cv2.imread(str(shot)).astype(int)
    blue, green, red = (picture[..., k] for k in range(3))
    is_red, is_green = (red > 180) & (green < 80) & (blue < 80), (green > 120) & (red < 80) & (blue < 90)
    cloud = slice(700, 1300)
    assert is_red[:500].sum() > 1000, "the left image"
    assert is_red[cloud].sum() > 300, "the square among the points"
    assert is_green[cloud].sum() > 300, "the wall among the points"
