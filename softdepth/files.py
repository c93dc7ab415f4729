"""Where results and caches lie, and how they get there: complete, or not at all."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import platformdirs

from softdepth.spec.errors import InputError

LAST = "report.json"
"""A run's file that is moved in last: where it lies, all the rest lies too."""


def cache_folder() -> Path:
    """Where builds and other work worth keeping lie: ``$SOFTDEPTH_CACHE``, or the user's cache folder."""
    return Path(os.environ.get("SOFTDEPTH_CACHE") or platformdirs.user_cache_dir("softdepth")).absolute()


def write_atomically(path: str | Path, data: bytes) -> None:
    """Write a file under a temporary name beside its place, then rename it: nobody sees half of it.

    Raises
    ------
    InputError : a folder that is missing or is none, a path that is a folder, no right to write, or
        a full disk. The file that was there before is left as it was.
    """
    path = Path(path)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    remedy = "give a path in a folder that you may write"
    try:
        if path.is_dir():
            raise InputError(f"'{path}' is a folder", "name a file in it")
        try:
            part.write_bytes(data)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)
    except FileNotFoundError as error:
        raise InputError(f"folder '{path.parent}' does not exist", "create it first") from error
    except NotADirectoryError as error:
        raise InputError(f"cannot write '{path}': part of the path is a file", remedy) from error
    except OSError as error:
        raise InputError(f"cannot write '{path}': {error.strerror or error}", remedy) from error


@contextmanager
def result_folder(target: Path, stale: tuple[str, ...] = (), last: str = LAST) -> Iterator[Path]:
    """Give a temporary folder whose files move into `target` when the block ends well.

    `target` and its parents are made as needed, and are proven writable before the block starts. When the
    block fails, nothing is left behind and an earlier content of `target` stays as it was.

    Parameters
    ----------
    target : where the results shall lie.
    stale : names that an earlier run may have left and that this one may not write again; they are
        removed when the new files move in.
    last : the file that is moved in last.

    Raises `InputError` where `target` is no folder or cannot be written.
    """
    made = [folder for folder in (target, *target.parents) if not folder.exists()]
    done = False
    try:
        workplace = _open(target)
        try:
            yield workplace
            _move(workplace, target, stale, last)
            done = True
        finally:
            shutil.rmtree(workplace, ignore_errors=True)
    finally:
        if not done:
            for folder in made:
                _remove_if_empty(folder)


def _open(target: Path) -> Path:
    try:
        target.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=target):
            pass
        # beside the target, so that moving in is renaming
        return Path(tempfile.mkdtemp(dir=target.absolute().parent, prefix=f".{target.name}-"))
    except OSError as error:
        raise _unwritable(target, error) from error


def _move(workplace: Path, target: Path, stale: tuple[str, ...], last: str) -> None:
    files = sorted(workplace.iterdir(), key=lambda file: (file.name == last, file.name))
    try:
        (target / last).unlink(missing_ok=True)
        for name in set(stale) - {file.name for file in files}:
            (target / name).unlink(missing_ok=True)
        for file in files:
            os.replace(file, target / file.name)
    except OSError as error:
        raise _unwritable(target, error) from error


def _remove_if_empty(folder: Path) -> None:
    try:
        folder.rmdir()
    except OSError:
        return


def _unwritable(target: Path, error: OSError) -> InputError:
    reason = error.strerror or type(error).__name__
    return InputError(f"cannot write to '{target}' ({reason.lower()})", "choose another with -o")
