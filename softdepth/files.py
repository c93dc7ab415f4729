"""Where results and caches lie, and how they get there: complete, or not at all."""

import errno
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import platformdirs

from softdepth.spec.errors import InputError

LAST = "report.json"
"""A run's file that is moved in last: where it lies, all the rest lies too."""

UNFINISHED = ".softdepth-"
"""What the names of folders that are being filled begin with."""

MAX_LINKS = 40
"""How many links may follow each other, as in Linux."""


def cache_folder() -> Path:
    """Where builds and other work worth keeping lie: ``$SOFTDEPTH_CACHE``, or the user's cache folder."""
    return Path(os.environ.get("SOFTDEPTH_CACHE") or platformdirs.user_cache_dir("softdepth")).absolute()


def write_atomically(path: str | Path, data: bytes) -> None:
    """Write a file under a temporary name beside its place, then rename it: nobody sees half of it.

    A link stays one: what it leads to is replaced. A device, a FIFO, a pipe or a file that is open already
    (``/dev/stdout``) is written to as it is. A file that is replaced keeps its permissions.

    Raises
    ------
    InputError : a folder that is missing or is none, a path that is a folder, no right to write, a reader
        that has gone, or a full disk. The regular file that was there before is left as it was.
    """
    path = Path(path)
    with _writing(path):
        if path.is_dir():
            raise InputError(f"'{path}' is a folder", "name a file in it")
        place = _replaceable(path)
        if place is None:
            _write_through(path, data)
            return
        part = place.with_name(f".{place.name}.{os.getpid()}.part")
        try:
            part.write_bytes(data)
            if place.exists():
                shutil.copymode(place, part)
            part.replace(place)
        finally:
            part.unlink(missing_ok=True)


def check_writable(path: str | Path) -> None:
    """Raise `InputError` if `write_atomically` could not write, so far as can be told before long work."""
    path = Path(path)
    with _writing(path):
        if path.is_dir():
            raise InputError(f"'{path}' is a folder", "name a file in it")
        place = _replaceable(path)
        folder = place.parent if place else path
        folder.stat()
        if place and not folder.is_dir():
            raise NotADirectoryError
        if not os.access(folder, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def is_replaced(path: str | Path) -> bool:
    """Whether `write_atomically` puts a regular file there, beside which others can lie."""
    with _writing(Path(path)):
        return _replaceable(Path(path)) is not None


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    """Tell what the system says about writing to `path` as a user reads it."""
    remedy = "give a path in a folder that you may write"
    try:
        yield
    except FileNotFoundError as error:
        raise InputError(f"folder '{path.parent}' does not exist", "create it first") from error
    except NotADirectoryError as error:
        raise InputError(f"cannot write '{path}': part of the path is a file", remedy) from error
    except OSError as error:
        raise InputError(f"cannot write '{path}': {error.strerror or error}", remedy) from error


def _replaceable(path: Path) -> Path | None:
    """The regular file, there or to be made, that a path leads to; None for what is no such file.

    What is reached through ``/proc`` is open already: to replace its file would leave who has it open with
    the old one.
    """
    for _ in range(MAX_LINKS):
        if path.parent.resolve().is_relative_to("/proc"):
            return None
        if not path.is_symlink():
            return path if path.is_file() or not path.exists() else None
        path = path.parent / path.readlink()
    raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))


def _write_through(path: Path, data: bytes) -> None:
    with open(os.open(path, os.O_WRONLY | os.O_APPEND), "wb") as file:
        file.write(data)


def move_in(source: Path, target: Path) -> None:
    """Move a file to `target`: it replaces a regular file, and goes through what is none, or a link.

    Raises `OSError` as the system does.
    """
    place = _replaceable(target)
    if place == target:
        shutil.move(source, target)
        return
    if place is None:
        _write_through(target, source.read_bytes())
    else:
        shutil.move(source, place)
    source.unlink(missing_ok=True)


def refuse_to_replace(target: Path, names: Iterable[str], inputs: Iterable[Path]) -> None:
    """Raise `InputError` if a file that is written or removed in `target` is one that is read."""
    read = {path.resolve(): path for path in inputs}
    for name in names:
        if path := read.get((target / name).resolve()):
            raise InputError(f"the results would replace '{path}', which is read", "choose another with -o")


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

    Raises `InputError` if `target` is no folder or cannot be written.
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


@contextmanager
def whole_folder(target: Path) -> Iterator[Path]:
    """Give a temporary folder that becomes `target` when the block ends well: whole, or not at all.

    A folder that was there is replaced. Beside `target`, whose parent must exist, an interrupted process may
    leave a name that begins with `UNFINISHED`; `clear_unfinished` removes such.
    """
    try:
        workplace = Path(tempfile.mkdtemp(dir=target.parent, prefix=UNFINISHED))
    except OSError as error:
        raise _unwritable(target, error) from error
    try:
        yield workplace
        workplace.chmod(0o777 & ~_umask())  # mkdtemp keeps others out
        if target.exists():
            target.rename(workplace.with_name(f"{workplace.name}-old"))
        workplace.rename(target)
    finally:
        shutil.rmtree(workplace, ignore_errors=True)
        shutil.rmtree(workplace.with_name(f"{workplace.name}-old"), ignore_errors=True)


def make_folder(folder: Path) -> None:
    """Make a folder and its parents where they are missing; raises `InputError` if that cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable(folder, error) from error


def clear_unfinished(folder: Path) -> None:
    """Remove what an interrupted `whole_folder` has left in a folder."""
    for path in folder.glob(f"{UNFINISHED}*"):
        shutil.rmtree(path, ignore_errors=True)


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current


def _open(target: Path) -> Path:
    try:
        target.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=target):
            pass
        # In the target, which may be a link or a disk of its own: so moving in is renaming.
        return Path(tempfile.mkdtemp(dir=target, prefix=UNFINISHED))
    except OSError as error:
        raise _unwritable(target, error) from error


def _move(workplace: Path, target: Path, stale: tuple[str, ...], last: str) -> None:
    files = sorted(workplace.iterdir(), key=lambda file: (file.name == last, file.name))
    try:
        (target / last).unlink(missing_ok=True)
        for name in set(stale) - {file.name for file in files}:
            (target / name).unlink(missing_ok=True)
        for file in files:
            move_in(file, target / file.name)
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
