"""Fixtures that every test may use."""

import os
from collections.abc import Generator
from pathlib import Path

import pytest

from tests.support.proofs import SAID


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder with ``teddy/``, ``cones/`` and ``venus/``; the test is skipped where there is none."""
    return _folder("SOFTDEPTH_DATA", "Middlebury's teddy/, cones/ and venus/")


def _folder(variable: str, what: str) -> Path:
    """The folder that an environment variable names; the test is skipped where it is unset."""
    value = os.environ.get(variable)
    if not value:
        pytest.skip(f"{variable} is unset: it names a folder with {what}")
    folder = Path(value)
    if not folder.is_dir():
        pytest.fail(f"{variable} is '{folder}', which is not a folder")
    return folder


@pytest.fixture(scope="session")
def scenes_dir() -> Path:
    """The folder with a folder for each scene of known depth; the test is skipped where there is none."""
    return _folder("SOFTDEPTH_SCENES", "SCENE/left.png, right.png and truth.pfm")


@pytest.fixture(scope="session")
def cases_dir() -> Path:
    """The folder with small inputs that are wrong in known ways; the test is skipped where there is none."""
    return _folder("SOFTDEPTH_CASES", "pairs that are wrong in known ways")


@pytest.fixture(scope="session")
def project() -> Path:
    """The project's own folder."""
    return Path(__file__).resolve().parent.parent


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None]:
    """A proof must go as deep as its claim says."""
    SAID.clear()
    yield
    if mark := item.get_closest_marker("proves"):
        assert SAID, "nothing was proven"
        for depth in SAID:
            assert depth in mark.args[0].depth, f"proven is '{depth}', claimed '{mark.args[0].depth}'"
