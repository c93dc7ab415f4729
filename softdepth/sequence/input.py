"""A sequence as the core takes it: frames in its pixels, rectified, with their truth."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.truth import Truth, read_truth
from softdepth.rig.rectify import Rectifier
from softdepth.sequence import names
from softdepth.sequence.frames import Checked, Frames
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError


@dataclass(frozen=True)
class Input:
    """Frames and what is done to them before they reach the core.

    Members
    -------
    frames, checked : the sequence, and what was found when it was read once.
    config : of the core.
    rectifier : of raw frames, or None.
    truths : a file a frame, or none at all; `scale` is their units per pixel.
    """

    frames: Frames
    checked: Checked
    config: Config
    rectifier: Rectifier | None = None
    truths: tuple[Path, ...] = ()
    scale: float | None = None

    def pairs(self) -> Iterator[StereoPair]:
        """Every frame in turn; raises `InputError` if the sequence is no longer what it was."""
        number = -1
        for number, read in enumerate(self.frames.read(self.checked.bits)):
            if number >= len(self.checked.names):
                break
            if (read.width, read.height) != (self.checked.first.width, self.checked.first.height):
                raise InputError(f"frame '{read.name}' has changed", "do not change the files meanwhile")
            pair = read.as_format(self.config.pixel)
            if self.rectifier is not None:
                left, right = self.rectifier.apply(pair.left, pair.right)
                pair = replace(pair, left=left, right=right)
            if self.truths:
                truth = self._truth(self.truths[number])
                pair = replace(pair, truth=truth, notes=(*pair.notes, *truth.notes))
            yield pair
        if number + 1 != len(self.checked.names):
            raise InputError(
                f"the sequence had {len(self.checked.names)} frames, now it has {number + 1}",
                "do not change the files meanwhile",
            )

    def check_truths(self, progress: Callable[[int], None] = lambda done: None) -> None:
        """Read every truth once; raises `InputError` for one that is wrong."""
        for number, path in enumerate(self.truths, 1):
            self._truth(path)
            progress(number)

    def _truth(self, path: Path) -> Truth:
        first = self.checked.first
        return read_truth(
            path,
            scale=self.scale,
            shape=(first.height, first.width),
            view=self.config.reference,
            candidates=self.config.max_disparity + 1,
        )


def truths(path: Path, frames: int) -> tuple[Path, ...]:
    """The truth of each frame in a folder or a pattern; raises `InputError` for fewer or more than frames."""
    if not path.is_dir() and not names.is_pattern(path):
        what = "one file" if path.exists() else "not there"
        raise InputError(f"truth '{path}' is {what}", "give a folder, or a pattern in quotes")
    found = names.files_of(path, names.TRUTHS)
    if len(found) != frames:
        raise InputError(f"{len(found)} truths in '{path}' for {frames} frames", "give one a frame")
    return tuple(found)
