"""Processes that share work: what they give, and how they end."""

import multiprocessing
import os
import signal
import time

import pytest

from softdepth.processes import workers
from softdepth.spec.errors import InputError, ToolError


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def fail() -> None:
    raise InputError("'x' is wrong", "mend it")


@pytest.mark.slow
def test_a_worker_that_dies_is_told_with_a_remedy():
    with (
        pytest.raises(ToolError, match=r"a worker process failed: .*; try again with --processes 1"),
        workers(1, "--processes") as pool,
    ):
        pool.submit(die).result()


@pytest.mark.slow
def test_an_error_passes_and_ends_the_others():
    def work() -> None:
        with workers(2, "--processes") as pool:
            pool.submit(time.sleep, 600)
            pool.submit(fail).result()

    start = time.monotonic()
    with pytest.raises(InputError, match="'x' is wrong; mend it"):
        work()
    assert time.monotonic() - start < 300
    assert multiprocessing.active_children() == []
