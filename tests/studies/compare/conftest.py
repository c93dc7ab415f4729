"""Fixtures of the comparison's tests: the command line's, and a small scene."""

import pytest

from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.synthetic import generate
from softdepth.spec.config import Config
from softdepth.studies.compare.sweep import Point, Sweep
from tests.cli.conftest import files, softdepth  # noqa: F401


def point(found: Sweep, membership_bits: int, label_bits: int) -> Point:
    """A point that must be there."""
    wanted = found.point(membership_bits, label_bits)
    assert wanted is not None
    return wanted


@pytest.fixture
def config() -> Config:
    return Config.preset("paper").override(["disparities=16", "lanes=4"])


@pytest.fixture
def pair() -> StereoPair:
    """A 48x30 scene with disparities below 16, and its truth."""
    return generate("slanted", width=48, height=30, disparities=16, seed=3)
