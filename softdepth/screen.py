"""What a user sees while a command works: stages, progress and tables."""

import sys
import time
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
def progress(what: str, pixels: int, unit: str = "pixels") -> Iterator[Advance]:
    """Show how far a long work is: a bar on a terminal, a line every 20 % elsewhere."""
    target = console(stderr=True)
    if not target.is_terminal:
        note(f"{what} ...")
        yield _logger(what, pixels, unit)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with Progress(*columns, console=target, transient=True) as bar:
        task = bar.add_task(what, total=pixels)
        yield lambda done: bar.update(task, completed=done)


def duration(seconds: float) -> str:
    """A time as a user estimates it: seconds up to two minutes, then minutes, then hours."""
    if seconds < 120:
        return f"{max(round(seconds), 1)} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 120 else f"{minutes // 60} h {minutes % 60} min"


def _logger(what: str, pixels: int, unit: str) -> Advance:
    shown = 0
    start = time.monotonic()

    def advance(done: int) -> None:
        nonlocal shown
        percent = 100 * done // max(pixels, 1)
        if percent // LOG_EVERY_PERCENT > shown // LOG_EVERY_PERCENT:
            left = (time.monotonic() - start) / done * (pixels - done)
            ends = f", about {duration(left)} left" if done < pixels else ""
            note(f"{what}: {done} of {pixels} {unit} ({percent} %){ends}")
            shown = percent

    return advance
