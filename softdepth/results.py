"""A folder of results that is either complete or untouched."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from softdepth.errors import InputError

LAST = "report.json"
"""A run's file that is moved in last: where it lies, all the rest lies too."""


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
