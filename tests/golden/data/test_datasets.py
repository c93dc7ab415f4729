"""Datasets by name: the offline ones always, Middlebury's where it is, the download from a local server."""

import threading
import time
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import numpy as np
import pytest

from softdepth.golden.data import datasets
from softdepth.golden.data.datasets import DATA_VARIABLE, load, names, pixel_sum
from softdepth.golden.data.decode import read_raster
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.truth import Truth, View, cross_check
from softdepth.spec.errors import InputError
from tests.golden.conftest import save

SIZES = {"teddy": (375, 450), "cones": (375, 450), "venus": (383, 434)}


def truth_of(pair: StereoPair) -> Truth:
    assert pair.truth is not None
    assert pair.truth.nonoccluded is not None
    assert pair.truth.disparity.shape == pair.left.shape[:2]
    assert not (pair.truth.nonoccluded & ~pair.truth.known).any()
    return pair.truth


def misfit(pair: StereoPair, view: View) -> float:
    """Mean absolute colour difference between the non-occluded pixels and their true partners."""
    truth = truth_of(pair)
    assert truth.nonoccluded is not None
    y, x = np.nonzero(truth.nonoccluded)
    d = np.rint(truth.disparity[y, x]).astype(int)
    here, there, sign = (pair.left, pair.right, -1) if view == "left" else (pair.right, pair.left, 1)
    return float(np.abs(here[y, x].astype(int) - there[y, x + sign * d]).mean())


@pytest.mark.parametrize("reference", ["left", "right"])
def test_motorcycle_needs_no_network(monkeypatch: pytest.MonkeyPatch, reference: View) -> None:
    monkeypatch.setattr("socket.socket.connect", lambda *_: pytest.fail("went to the network"))
    pair = load("motorcycle", reference)
    truth = truth_of(pair)
    assert pair.left.shape == (500, 741, 3)
    assert np.nanmax(truth.disparity) == pytest.approx(59.909, abs=0.001)
    assert truth.known.mean() == pytest.approx(0.927 if reference == "left" else 0.830, abs=0.001)
    assert misfit(pair, reference) < 12
    assert load().name == "motorcycle"


@pytest.mark.middlebury
@pytest.mark.parametrize("scene", ["teddy", "cones", "venus"])
@pytest.mark.parametrize("reference", ["left", "right"])
def test_middlebury(middlebury: Path, scene: str, reference: View) -> None:
    pair = load(f"middlebury:{scene}", reference)
    truth = truth_of(pair)
    assert pair.left.shape == (*SIZES[scene], 3)
    assert misfit(pair, reference) < 9
    scale = 8 if scene == "venus" else 4
    np.testing.assert_array_equal(truth.gray[truth.known], (truth.disparity * scale)[truth.known])
    if (scene, reference) != ("venus", "right"):
        assert (truth.gray[~truth.known] == 0).all()
    assert truth.evidence == ("warp" if scene == "venus" else "cross-check")


@pytest.mark.middlebury
def test_venus_is_moved_into_the_right_view(middlebury: Path) -> None:
    """Against plain loops over the left view's gray levels; holes get the farther neighbour's level."""
    gray = truth_of(load("middlebury:venus")).gray
    moved = np.zeros_like(gray)
    for y, x in np.ndindex(gray.shape):
        column = round(x - float(gray[y, x]) / 8)
        if column >= 0:
            moved[y, column] = max(moved[y, column], gray[y, x])
    truth = truth_of(load("middlebury:venus", "right"))
    np.testing.assert_array_equal(truth.known, moved > 0)
    np.testing.assert_array_equal(truth.gray[truth.known], moved[truth.known])
    for y, x in np.argwhere(moved == 0):
        left, right = moved[y, :x], moved[y, x + 1 :]
        neighbours = [side[side > 0][index] for side, index in ((left, -1), (right, 0)) if side.any()]
        assert truth.gray[y, x] == min(neighbours)


@pytest.mark.middlebury
def test_teddy_views_confirm_each_other(middlebury: Path) -> None:
    left, right = (truth_of(load("middlebury:teddy", view)) for view in ("left", "right"))
    np.testing.assert_array_equal(left.nonoccluded, cross_check(left.disparity, right.disparity))
    np.testing.assert_array_equal(right.nonoccluded, cross_check(right.disparity, left.disparity, "right"))
    assert 0.85 < left.nonoccluded.mean() < 0.9  # pyright: ignore[reportOptionalMemberAccess]


def test_synthetic_names() -> None:
    pair = load("synthetic:steps@96x64x16#7")
    assert pair.left.shape == (64, 96, 3)
    assert np.nanmax(truth_of(pair).disparity) == 15
    assert pair.name == "synthetic:steps@96x64x16#7"
    assert load("synthetic:steps@96x64").name == "synthetic:steps@96x64x32#0"
    assert load("synthetic:plane#3").name == "synthetic:plane@320x240x32#3"
    right = load("synthetic:steps@96x64x16#7", "right")
    assert (truth_of(right).disparity != truth_of(pair).disparity).any()


@pytest.mark.parametrize(
    "name",
    [
        "",
        "moon",
        "teddy",
        "middlebury:moon",
        "synthetic:",
        "synthetic:moon",
        "synthetic:steps@96",
        "synthetic:steps@axb",
    ],
)
def test_unknown_names_list_the_known(name: str) -> None:
    with pytest.raises(InputError) as caught:
        load(name)
    assert f"'{name}'" in caught.value.problem
    for known in names():
        assert known in caught.value.remedy


def test_names_are_complete() -> None:
    assert names() == (
        *("motorcycle", "middlebury:teddy", "middlebury:cones", "middlebury:venus"),
        *("synthetic:plane", "synthetic:steps", "synthetic:slanted", "synthetic:random"),
    )


def test_unknown_reference() -> None:
    with pytest.raises(InputError, match="'middle'; use left or right"):
        load("motorcycle", "middle")  # pyright: ignore[reportArgumentType]


# A small scene in place of Middlebury's, in a folder or behind a server.
FILES = {"im2.png": 3, "im6.png": 3, "disp2.png": 1, "disp6.png": 1}


@pytest.fixture
def folder(tmp_path: Path, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the scene ``tiny``, known to the registry."""
    (tmp_path / "data" / "tiny").mkdir(parents=True)
    sums = {}
    for file, channels in FILES.items():
        pixels = rng.integers(0, 30, (9, 40, channels), dtype=np.uint8)
        save(tmp_path / "data" / "tiny" / file, pixels if channels == 3 else pixels[:, :, 0])
        sums[file] = pixel_sum(pixels)
    spec = datasets.MiddleburyScene("http://127.0.0.1:9/tiny", 4, sums)
    monkeypatch.setitem(datasets.MIDDLEBURY, "tiny", spec)
    monkeypatch.setattr(datasets.platformdirs, "user_cache_path", lambda *_: tmp_path / "cache")
    monkeypatch.setenv("NO_PROXY", "*")
    monkeypatch.delenv(DATA_VARIABLE, raising=False)
    return tmp_path / "data"


class _Handler(SimpleHTTPRequestHandler):
    requests = 0
    silent = False
    finished: threading.Event

    def do_GET(self) -> None:
        type(self).requests += 1
        if self.silent:
            self.finished.wait()
            return
        super().do_GET()

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def server(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[type[_Handler]]:
    """`folder` behind HTTP, in place of Middlebury's site."""
    handler = type("Handler", (_Handler,), {"finished": threading.Event()})
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(handler, directory=str(folder))) as httpd:
        threading.Thread(target=httpd.serve_forever, daemon=True).start()
        spec = datasets.MiddleburyScene(
            f"http://127.0.0.1:{httpd.server_port}/tiny", 4, datasets.MIDDLEBURY["tiny"].pixels
        )
        monkeypatch.setitem(datasets.MIDDLEBURY, "tiny", spec)
        yield handler
        handler.finished.set()
        httpd.shutdown()


def test_folder_in_another_format(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What counts are the pixels, not the file."""
    scene = folder / "tiny"
    for file, suffix in (("im2.png", ".ppm"), ("disp2.png", ".pgm")):
        pixels = read_raster(scene / file).values
        save((scene / file).with_suffix(suffix), pixels if suffix == ".ppm" else pixels[:, :, 0])
        (scene / file).unlink()
    monkeypatch.setenv(DATA_VARIABLE, str(folder))
    assert load("middlebury:tiny").left.shape == (9, 40, 3)


def test_folder_lacks_the_scene(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(DATA_VARIABLE, str(folder))
    with pytest.raises(InputError, match=rf"{DATA_VARIABLE} is '.*', which has no teddy/im2.png; put"):
        load("middlebury:teddy")


@pytest.mark.parametrize("change", ["pixel", "cut"])
def test_folder_holds_other_pixels(folder: Path, monkeypatch: pytest.MonkeyPatch, change: str) -> None:
    path = folder / "tiny" / "disp6.png"
    if change == "cut":
        path.write_bytes(path.read_bytes()[:-20])
    else:
        pixels = read_raster(path).values[:, :, 0]
        pixels[3, 4] += 1
        save(path, pixels)
    monkeypatch.setenv(DATA_VARIABLE, str(folder))
    with pytest.raises(
        InputError, match=r"disp6\.png' does not hold the pixels of Middlebury's tiny/disp6\.png; put"
    ):
        load("middlebury:tiny")


def test_download_fills_the_cache_once(server: type[_Handler], folder: Path) -> None:
    pair = load("middlebury:tiny")
    np.testing.assert_array_equal(pair.left, read_raster(folder / "tiny" / "im2.png").values)
    assert server.requests == len(FILES)
    load("middlebury:tiny", "right")
    assert server.requests == len(FILES)
    cached = folder.parent / "cache" / "middlebury" / "tiny"
    assert sorted(p.name for p in cached.iterdir()) == sorted(FILES)


def test_damaged_cache_names_the_file(server: type[_Handler], folder: Path) -> None:
    load("middlebury:tiny")
    path = folder.parent / "cache" / "middlebury" / "tiny" / "im6.png"
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(InputError, match=r"im6\.png' does not hold .*; delete it: it is downloaded again"):
        load("middlebury:tiny")
    path.unlink()
    assert load("middlebury:tiny").right.shape == (9, 40, 3)


def no_network(name: str) -> str:
    with pytest.raises(InputError) as caught:
        load(name)
    assert caught.value.remedy == f"set {DATA_VARIABLE} to a folder that has it, or use dataset motorcycle"
    assert "\n" not in str(caught.value)
    return caught.value.problem


def test_no_server(folder: Path) -> None:
    assert "cannot download Middlebury's tiny/im2.png: ConnectionError" in no_network("middlebury:tiny")


def test_file_is_not_on_the_server(server: type[_Handler], folder: Path) -> None:
    (folder / "tiny" / "disp2.png").unlink()
    assert "tiny/disp2.png: HTTPError" in no_network("middlebury:tiny")


def test_silent_server_does_not_hang(server: type[_Handler], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(datasets, "TIMEOUT", 0.2)
    monkeypatch.setattr(server, "silent", True)
    start = time.monotonic()
    assert "Timeout" in no_network("middlebury:tiny")
    assert time.monotonic() - start < 20
