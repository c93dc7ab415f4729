"""Where builds are kept: one folder each, with a lock and a log beside it. Their total size is limited."""

import os
import shutil
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from softdepth.spec.errors import ToolError

MAX_BYTES = 1 << 30
"""What builds may take in total. Most take about a megabyte."""

RECENT_SECONDS = 3600.0
"""A build used within this time stays, since it may be about to run. Once running, it no longer needs its
file."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Be the only process that makes or removes the build `folder`, and note that it is in use.

    Raises `ToolError` if the cache cannot be written.
    """
    path = _lock(folder)
    lock = FileLock(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock.acquire()
    except (OSError, NotImplementedError) as error:  # the latter where a file system has no locks
        raise ToolError(
            f"cannot write the cache '{path.parent}': {getattr(error, 'strerror', None) or error}",
            "set SOFTDEPTH_CACHE to a folder you may write to",
        ) from error
    try:
        os.utime(path)
        yield
    finally:
        lock.release()


def keep(folder: Path, files: Iterable[Path]) -> None:
    """Copy `files` into a new `folder` that appears complete or not at all."""
    if folder.exists():
        return
    folder.parent.mkdir(parents=True, exist_ok=True)
    part = Path(tempfile.mkdtemp(prefix=".part-", dir=folder.parent))
    try:
        for path in files:
            shutil.copy2(path, part / path.name)
        part.rename(folder)
    except OSError:
        if not folder.exists():  # another process may have been first, which is as good
            raise
    finally:
        shutil.rmtree(part, ignore_errors=True)


def log_of(folder: Path) -> Path:
    """The log of the build `folder`, which stays when the build fails."""
    return folder.with_suffix(".log")


def make_room(place: Path) -> None:
    """Remove the builds in `place` that were not used for longest, until the rest take `MAX_BYTES`."""
    builds = sorted((used, path.with_suffix("")) for path in place.glob("*.lock") if (used := _used(path)))
    sizes = {folder: _bytes(folder) for _, folder in builds}
    excess = sum(sizes.values()) - MAX_BYTES
    oldest_recent = time.time() - RECENT_SECONDS
    for used, folder in builds:
        if excess <= 0 or used > oldest_recent:
            return
        if _remove(folder, oldest_recent):
            excess -= sizes[folder]


def _remove(folder: Path, oldest_recent: float) -> bool:
    """Remove a build, unless another process has taken it up by now."""
    path = _lock(folder)
    if not path.exists():
        return False  # it has been removed meanwhile
    with suppress(OSError, Timeout), FileLock(path, blocking=False):
        if _used(path) > oldest_recent:
            return False
        shutil.rmtree(folder, ignore_errors=True)
        log_of(folder).unlink(missing_ok=True)
        # Whoever waits for this lock gets it, and someone else may make a new one: `keep` is safe for two.
        path.unlink()
        return True
    return False


def _lock(folder: Path) -> Path:
    return folder.with_suffix(".lock")


def _used(lock: Path) -> float:
    """When the build was last asked for, in seconds since the epoch; 0 if it has been removed."""
    with suppress(FileNotFoundError):
        return lock.stat().st_mtime
    return 0.0


def _bytes(folder: Path) -> int:
    total = 0
    for path in (*folder.glob("*"), log_of(folder)):
        with suppress(FileNotFoundError):
            total += path.stat().st_size
    return total
