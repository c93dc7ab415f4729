"""Pairs to inspect, made in code."""

import numpy as np
import pytest

from softdepth.golden.data.images import read_pair
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.synthetic import generate
from softdepth.inspect.inspection import Inspection, inspect
from softdepth.spec.config import Config


def look(left: np.ndarray, right: np.ndarray, disparities: int = 64) -> Inspection:
    """Inspect for a core of so many candidates, one lane."""
    return inspect(left, right, Config.preset("sad").override([f"disparities={disparities}", "lanes=1"]))


def spoilt(found: Inspection) -> list[str]:
    """The codes of what is wrong; a range larger than needed spoils nothing."""
    return [finding.code for finding in found.findings if finding.code != "needless"]


def read(left, right) -> StereoPair:
    """Two files as `softdepth inspect` reads them."""
    return read_pair(left, right).as_format("rgb8")


@pytest.fixture(scope="session")
def pair() -> StereoPair:
    """A sound pair: 240x160, disparities 1 .. 23."""
    return generate("random", width=240, height=160, disparities=24, seed=1)


@pytest.fixture(scope="session")
def other() -> StereoPair:
    """Another scene of that size."""
    return generate("random", width=240, height=160, disparities=24, seed=77)
