"""The work of a sequence: frames through an engine, finished in processes while the next are under way."""

import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from softdepth import screen
from softdepth.files import clear_unfinished
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.maps import DisparityMap
from softdepth.processes import workers
from softdepth.sequence.frame import Recipe, Record, finish, kept

if TYPE_CHECKING:
    from softdepth.board.device import Device

Pairs = Callable[[], Iterator[StereoPair]]
"""Gives every pair of the sequence as the core takes it, each time that it is called."""


@dataclass(frozen=True)
class Work:
    """A sequence on its way.

    Members
    -------
    pairs : gives the frames.
    names : of them all.
    recipe : what is done with each.
    folder : gets a folder for each frame, of the frame's name.
    processes : that models are computed and files written in; 1 is this process itself.
    device : the board, for that engine.
    """

    pairs: Pairs
    names: tuple[str, ...]
    recipe: Recipe
    folder: Path
    processes: int
    device: "Device | None" = None

    def run(self) -> list[Record]:
        """The record of every frame; those that are there from an earlier run are kept."""
        clear_unfinished(self.folder)
        through = {"rtl": self._simulated, "board": self._board, "fixed": self._model}[self.recipe.engine]
        try:
            count = min(self.processes, len(self.names))
            with workers(count, "--processes") if count > 1 else nullcontext(_Here()) as pool:
                return through(pool)
        finally:
            clear_unfinished(self.folder)

    def _model(self, pool: Executor) -> list[Record]:
        pending: deque[Future[Record]] = deque()
        found: list[Record] = []
        with self._progress() as advance:
            for index, pair in enumerate(self.pairs()):
                record = self._kept(pair, index)
                pending.append(_there(record) if record else self._submit(pool, pair, index))
                while len(pending) >= 2 * self.processes:
                    found.append(pending.popleft().result())
                    advance(len(found))
            while pending:
                found.append(pending.popleft().result())
                advance(len(found))
        return found

    def _board(self, pool: Executor) -> list[Record]:
        assert self.device is not None
        pending: list[Future[Record]] = []
        with self._progress() as advance:
            for index, pair in enumerate(self.pairs()):
                if record := self._kept(pair, index):
                    pending.append(_there(record))
                else:
                    start = time.perf_counter()
                    found = self.device.disparity(pair.left, pair.right)
                    seconds = time.perf_counter() - start
                    pending.append(self._submit(pool, pair, index, found, seconds))
                advance(index + 1)
            return [each.result() for each in pending]

    def _simulated(self, pool: Executor) -> list[Record]:
        """All frames in one session, back to back, so that the core keeps its state from frame to frame.

        A run that goes on where an earlier one was stopped begins with the last frame that was finished:
        after it, the core's state is what it was.
        """
        from softdepth.sim.frames import run_frames
        from softdepth.sim.toolchain import find_toolchain

        pairs = list(self.pairs())
        found: dict[int, Future[Record]] = {}
        for index, pair in enumerate(pairs):
            if record := self._kept(pair, index):
                found[index] = _there(record)
        missing = [index for index in range(len(pairs)) if index not in found]
        if missing:
            find_toolchain()
            first, end = max(missing[0] - 1, 0), missing[-1] + 1
            size = pairs[0].width * pairs[0].height

            def handed(number: int, result: DisparityMap, seconds: float) -> None:
                index = first + number
                if index not in found:
                    found[index] = self._submit(pool, pairs[index], index, result, seconds)

            views = [(pair.left, pair.right) for pair in pairs[first:end]]
            with screen.progress("gateware, simulated by Verilator", size * len(views)) as advance:
                run_frames(self.recipe.config, views, progress=advance, handed=handed)
        return [found[index].result() for index in range(len(pairs))]

    def _submit(self, pool: Executor, pair: StereoPair, index: int, *more: Any) -> "Future[Record]":
        return pool.submit(finish, self.folder / self.names[index], self.recipe, pair, index, *more)

    def _kept(self, pair: StereoPair, index: int) -> Record | None:
        return kept(self.folder / self.names[index], self.recipe, pair, index)

    def _progress(self) -> Any:
        return screen.progress("frames", len(self.names), "frames")


class _Here(Executor):
    """Does what is submitted at once, in this process."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> "Future[Any]":
        return _there(fn(*args, **kwargs))


def _there(result: Any) -> "Future[Any]":
    future: Future[Any] = Future()
    future.set_result(result)
    return future
