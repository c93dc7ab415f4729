"""How a program ends: whatever stops it, one line and an exit code, and no child left behind."""

import errno
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType

import psutil

from softdepth import caches
from softdepth.spec.errors import SoftdepthError

DONE = 0
MISMATCH = 1
"""The gateware and the fixed model disagree."""
USER = 2
"""Not done, and the user can mend it: one line says what is wrong and what to do."""
BUG = 3
"""Not done, and it is a fault of this program."""
SIGNALLED = 128
"""Stopped by a signal: this and the signal's number, as shells say it. Ctrl-C is 130, SIGTERM is 143."""

_STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stopped(KeyboardInterrupt):
    """A signal asks the program to end. It unwinds as for Ctrl-C, so nothing half-made is left behind."""


def ended(work: Callable[[], int | None]) -> int:
    """Do `work`, tell the user what stopped it, and return the exit code of the program.

    `work` returns the code of what it has done itself; None is `DONE`.
    """
    _open_streams()
    with _stopping() as received:
        try:
            caches.settle()
            code = work() or DONE
            sys.stdout.flush()
        except SoftdepthError as error:
            code = _refused(str(error))
        except (KeyboardInterrupt, SystemExit) as error:
            code = DONE
            if not received:
                code = _unheard(error) if isinstance(error, SystemExit) else SIGNALLED + signal.SIGINT
        except OSError as error:
            code = _refused(_explain(error))
        except MemoryError:
            code = _refused("there is not enough memory; take smaller images, or fewer candidates")
        except Exception as error:  # the last resort of every program
            code = _bug(error)
        if received:
            code = SIGNALLED + received[0]
        if (problem := _unwritten()) and code in (DONE, MISMATCH):
            code = _refused(problem)
    return code


def _refused(message: str) -> int:
    with suppress(OSError):  # nobody is there to be told
        print(f"error: {message}", file=sys.stderr, flush=True)
    return USER


def _bug(error: Exception) -> int:
    with suppress(OSError):
        traceback.print_exception(error)
        what = " ".join(f"{type(error).__name__}: {error}".split())
        print(f"error: a fault of softdepth ({what}); please report it with the lines above", file=sys.stderr)
    return BUG


def _unheard(error: SystemExit) -> int:
    """The code of an exit that a library asked for: typer's, where standard output is a closed pipe."""
    if isinstance(error.__context__, BrokenPipeError):
        return _refused(_explain(error.__context__))
    return error.code if isinstance(error.code, int) else USER


def _explain(error: OSError) -> str:
    if problem := _unwritten():
        return problem
    reason = (error.strerror or str(error) or type(error).__name__).lower()
    if error.filename is not None:
        return f"cannot use '{error.filename}' ({reason}); see that it is there and that you may use it"
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return f"standard output or a file could not be written ({reason}); make room, or write elsewhere"
    if error.errno == errno.EPIPE:
        return "what was to read the output has ended; let it read to the end, or write to a file"
    return f"the system refused ({reason}); see that files and folders may be used"


def _unwritten() -> str | None:
    """Why standard output takes no more, if it does not; what it was to get is dropped then."""
    try:
        sys.stdout.flush()
    except OSError as error:
        with suppress(OSError, ValueError):  # no file of the system stands behind it
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stdout.fileno())
            os.close(nowhere)
        if isinstance(error, BrokenPipeError):
            return "standard output was closed before its end; let its reader read on, or write to a file"
        reason = (error.strerror or str(error)).lower()
        return f"cannot write standard output ({reason}); make room there, or send it elsewhere"
    return None


def _open_streams() -> None:
    """Give a program that was started without standard output or error one that leads nowhere."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115  lives as long as the program


@contextmanager
def _stopping() -> Iterator[list[int]]:
    """Turn the first signal that asks for an end into `Stopped`, children first; give what was received.

    A signal that was ignored from outside, as ``nohup`` does, stays so. More signals change nothing: what
    is half-made is being cleared away.
    """
    received: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield received
        return
    before = {child.pid for child in psutil.Process().children()}

    def stop(number: int, _frame: FrameType | None) -> None:
        if received:
            return
        received.append(number)
        _end_children(before)
        raise Stopped

    usual = (signal.SIG_DFL, signal.default_int_handler)
    earlier = {each: found for each in _STOPPING if (found := signal.getsignal(each)) in usual}
    for each in earlier:
        signal.signal(each, stop)
    try:
        yield received
    finally:
        for each, handler in earlier.items():
            signal.signal(each, handler)


def _end_children(but: set[int]) -> None:
    """Ask every program that this one has started, and theirs, to end; all but those that were there."""
    with suppress(psutil.Error):
        for child in psutil.Process().children():
            if child.pid not in but:
                with suppress(psutil.Error):
                    for each in (*child.children(recursive=True), child):
                        with suppress(psutil.Error):
                            each.terminate()
