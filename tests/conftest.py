"""Fixtures that every test may use."""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder with ``teddy/``, ``cones/`` and ``venus/``; the test is skipped where there is none."""
    value = os.environ.get("SOFTDEPTH_DATA")
    if not value:
        pytest.skip("SOFTDEPTH_DATA is unset: it names a folder with Middlebury's teddy/, cones/ and venus/")
    folder = Path(value)
    if not folder.is_dir():
        pytest.fail(f"SOFTDEPTH_DATA is '{folder}', which is no folder")
    return folder


@pytest.fixture(scope="session")
def project() -> Path:
    """The project's own folder."""
    return Path(__file__).resolve().parent.parent
