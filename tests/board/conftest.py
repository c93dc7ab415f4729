"""Configurations and pairs small enough for a simulated serial line."""

from pathlib import Path

import pytest

from softdepth.golden.data.synthetic import generate
from softdepth.spec.config import Config
from tests.cli.conftest import Files, softdepth

__all__ = ["softdepth"]

WIDTH, HEIGHT = 40, 24


@pytest.fixture(scope="session")
def config() -> Config:
    """The right view as reference, so that a swap or a mirroring too many shows."""
    keys = ("disparities=8", "lanes=2", "max_width=64", "max_height=64", "reference=right")
    return Config.preset("sad").override(keys)


@pytest.fixture
def files(tmp_path: Path) -> Files:
    """A pair and the truth of its right view."""
    pair = generate("random", width=WIDTH, height=HEIGHT, disparities=8, seed=3, view="right")
    return Files.written(pair, tmp_path / "input")
