"""Three small synthetic scenes in Middlebury's place."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.truth import Truth, View
from softdepth.studies.paper import figure4, scenes, speed
from softdepth.studies.paper.published import SCENES
from softdepth.studies.paper.scenes import Scene

WIDTH, HEIGHT = 110, 34
KINDS: dict[str, str] = dict(zip(SCENES, ("steps", "slanted", "plane"), strict=True))


def scene(name: str, size: tuple[int, int] | None = None) -> Scene:
    """A synthetic scene under a Middlebury name, of one size whatever the reading asks for."""
    pairs: dict[View, StereoPair] = {
        v: generate(KINDS[name], width=WIDTH, height=HEIGHT, disparities=32, view=v) for v in VIEWS
    }
    truths: dict[View, Truth] = {}
    for view, pair in pairs.items():
        assert pair.truth is not None
        truths[view] = pair.truth
    return Scene(name, pairs["left"].left, pairs["left"].right, truths, f"synthetic {name} {size}")


VIEWS: tuple[View, View] = ("left", "right")


@pytest.fixture(scope="module")
def tiny() -> Iterator[None]:
    """The evaluation sees the synthetic scenes, a pixel inside them, and times few rows."""
    made = {name: scene(name) for name in SCENES}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scenes, "load", lambda name, size=None: made[name])
        patch.setattr(figure4, "COLUMN", 20)
        patch.setattr(figure4, "ROW", 17)
        patch.setattr(speed, "ROWS", 12)
        patch.setattr(speed, "REPEATS", 1)
        yield


@pytest.fixture
def cache_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of this test's own."""
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "paper"
