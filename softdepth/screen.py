"""What a user sees while a command works: stages, progress and tables."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

Advance = Callable[[int], None]
"""Called with the number of pixels done so far; any thread may call it."""

LOG_EVERY_PERCENT = 20


def console(*, stderr: bool = False) -> Console:
    """A console on the present standard output (or error), plain where that is no terminal."""
    return Console(stderr=stderr, highlight=False)


def note(text: str) -> None:
    """One line for the user's eyes, kept apart from results: it goes to standard error, or nowhere."""
    with suppress(OSError):  # a result must not be lost because nobody can be told about it
        print(text, file=sys.stderr, flush=True)


@contextmanager
def progress(what: str, pixels: int) -> Iterator[Advance]:
    """Show how far a long work is: a bar on a terminal, a line every 20 % elsewhere."""
    target = console(stderr=True)
    if not target.is_terminal:
        note(f"{what} ...")
        yield _logger(what, pixels)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with Progress(*columns, console=target, transient=True) as bar:
        task = bar.add_task(what, total=pixels)
        yield lambda done: bar.update(task, completed=done)


def _logger(what: str, pixels: int) -> Advance:
    shown = 0

    def advance(done: int) -> None:
        nonlocal shown
        percent = 100 * done // max(pixels, 1)
        if percent // LOG_EVERY_PERCENT > shown // LOG_EVERY_PERCENT:
            note(f"{what}: {done} of {pixels} pixels ({percent} %)")
            shown = percent

    return advance
