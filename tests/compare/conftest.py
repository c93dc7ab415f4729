"""Fixtures of the comparison's tests: the command line's, and a small scene."""

import pytest

from softdepth.config import Config
from softdepth.golden.images import StereoPair
from softdepth.golden.synthetic import generate
from tests.cli.conftest import files, softdepth  # noqa: F401


@pytest.fixture
def config() -> Config:
    return Config.preset("paper").override(["disparities=16", "lanes=4"])


@pytest.fixture
def pair() -> StereoPair:
    """A 48x30 scene with disparities below 16, and its truth."""
    return generate("slanted", width=48, height=30, disparities=16, seed=3)
