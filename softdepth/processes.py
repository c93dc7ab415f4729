"""Processes that share long work: begun anew, and gone when the one that has begun them is."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, ProcessPoolExecutor
from contextlib import contextmanager

from softdepth.spec.errors import ToolError


def cores() -> int:
    """The processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def workers(processes: int, option: str) -> Iterator[Executor]:
    """Processes to which work is submitted; `option` is what a user asks for their number with.

    They are begun anew, since OpenCV's threads do not survive a fork. Where the block fails, they are ended
    before its error goes on; raises `ToolError` when one of them dies.
    """
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(processes, context, initializer=_begin)
    try:
        yield pool
    except BaseException as error:
        pool.shutdown(wait=False, cancel_futures=True)
        for each in multiprocessing.active_children():  # none is to write on while this one clears away
            each.terminate()
            each.join()
        if isinstance(error, BrokenExecutor):
            raise ToolError(f"a worker process failed: {error}", f"try again with {option} 1") from error
        raise
    pool.shutdown()


def _begin() -> None:
    """Leave Ctrl-C to the process that has begun this one, and end with it, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=lambda: (parent.join(), os._exit(1)), daemon=True).start()
