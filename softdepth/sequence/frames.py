"""The frames of a sequence, one stereo pair after the other."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np

from softdepth.golden.data.images import Joined, read_joined, read_pair
from softdepth.golden.data.inputs import size_text
from softdepth.golden.data.pair import StereoPair, require_same_size
from softdepth.sequence import names
from softdepth.sequence.video import Video
from softdepth.spec.errors import InputError


class Frames(Protocol):
    """A sequence, to be read more than once; `read` raises `InputError` for what is wrong with a frame."""

    @property
    def files(self) -> tuple[Path, ...]:
        """All that is read."""
        ...

    @property
    def rate(self) -> float | None:
        """Frames a second, where the sequence says so."""
        ...

    @property
    def expected(self) -> int:
        """Frames, as far as can be told without reading them."""
        ...

    def read(self, bits: int | None = None) -> Iterator[StereoPair]:
        """Every pair in turn, each with a name of its own; images of `bits` a channel where given."""
        ...


@dataclass(frozen=True)
class ImageFrames:
    """Pairs in image files.

    Members
    -------
    paths : of each pair one file (`joined` says how both views lie in it) or two, left first.
    """

    paths: tuple[tuple[Path, ...], ...]
    joined: Joined | None = None
    rate: float | None = None

    def __post_init__(self) -> None:
        stems: dict[str, Path] = {}
        for first, *_ in self.paths:
            if other := stems.get(first.stem):
                raise InputError(
                    f"'{other}' and '{first}' would give results of the same name", "rename one of them"
                )
            stems[first.stem] = first

    @property
    def files(self) -> tuple[Path, ...]:
        return tuple(file for pair in self.paths for file in pair)

    @property
    def expected(self) -> int:
        return len(self.paths)

    def read(self, bits: int | None = None) -> Iterator[StereoPair]:
        for first, *others in self.paths:
            if self.joined:
                yield read_joined(first, self.joined, first.stem, bits=bits)
            else:
                yield read_pair(first, others[0], first.stem, bits=bits)


@dataclass(frozen=True)
class VideoFrames:
    """Pairs in one video (`joined` says how both views lie in it) or two, left first."""

    videos: tuple[Video, ...]
    joined: Joined | None = None

    @property
    def paths(self) -> tuple[Path, ...]:
        """The videos' files."""
        return tuple(video.path for video in self.videos)

    @property
    def files(self) -> tuple[Path, ...]:
        return self.paths

    @property
    def rate(self) -> float | None:
        return self.videos[0].rate

    @property
    def expected(self) -> int:
        return max(video.expected for video in self.videos)

    def read(self, bits: int | None = None) -> Iterator[StereoPair]:
        streams = [video.read() for video in self.videos]
        number = 0
        while True:
            views = [next(stream, None) for stream in streams]
            if all(view is None for view in views):
                break
            if any(view is None for view in views):
                self._unequal(number)
            yield self._pair([view for view in views if view is not None], number)
            number += 1
        if not number:
            raise InputError(f"'{self.paths[0]}' holds no frame that can be read", "give another video")

    def _pair(self, views: list[np.ndarray], number: int) -> StereoPair:
        if self.joined:
            axis = 1 if self.joined == "side-by-side" else 0
            if views[0].shape[axis] % 2:
                raise InputError(
                    f"'{self.paths[0]}' is {size_text(views[0])}, which cannot be halved",
                    "give both views at the same size",
                )
            views = [np.ascontiguousarray(half) for half in np.split(views[0], 2, axis=axis)]
        left, right = views
        require_same_size(left, right, f"'{self.paths[0]}'", f"'{self.paths[-1]}'")
        return StereoPair(left, right, f"{number:06}")

    def _unequal(self, number: int) -> None:
        lengths = [sum(1 for _ in video.read()) for video in self.videos]
        raise InputError(
            f"'{self.paths[0]}' has {lengths[0]} frames, '{self.paths[1]}' has {lengths[1]}",
            "cut both to the same frames",
        )


@dataclass(frozen=True)
class Checked:
    """A sequence that has been read once to its end.

    Members
    -------
    names : of every frame.
    first : the first pair.
    bits : a channel, for all frames alike; None where the files say it.
    notes : of the first frame, and of others how many have some of their own.
    missing : what the sequence should hold and does not, if there is such: a video that breaks off.
    """

    names: tuple[str, ...]
    first: StereoPair
    bits: int | None
    notes: tuple[str, ...]
    missing: str = ""


def find(left: Path, right: Path | None, joined: Joined | None) -> Frames:
    """The sequence that a user names: two folders, patterns or videos; or one of them with both views.

    Raises `InputError` for what is not there, does not fit together, or cannot be opened.
    """
    kind = names.kind_of(left)
    if right is None:
        if joined is None:
            raise InputError(
                f"'{left}' is one view",
                "give RIGHT as well, or --side-by-side or --top-bottom if it holds both",
            )
        if kind == "video":
            return VideoFrames((Video.opened(left),), joined)
        return ImageFrames(tuple((path,) for path in names.files_of(left)), joined)
    if joined is not None:
        raise InputError(f"--{joined} takes one sequence with both views, 2 given", "leave RIGHT out")
    if (other := names.kind_of(right)) != kind:
        raise InputError(f"'{left}' is {_a(kind)}, '{right}' is {_a(other)}", "give two of the same kind")
    if kind == "video":
        return VideoFrames((Video.opened(left), Video.opened(right)))
    return ImageFrames(tuple(names.partners(names.files_of(left), names.files_of(right), (left, right))))


def checked(frames: Frames, bits: int | None, progress: Callable[[int], None] = lambda done: None) -> Checked:
    """Read a whole sequence; raises `InputError` for frames that cannot be read or that differ in size.

    Where files do not say how many bits they hold, all frames get what fits the brightest.
    """
    found: list[str] = []
    first: StereoPair | None = None
    depths: set[int] = set()
    own = 0
    for number, pair in enumerate(frames.read(bits), 1):
        if first is None:
            first = pair
        elif (pair.width, pair.height) != (first.width, first.height):
            raise InputError(
                f"frame '{pair.name}' is {size_text(pair.left)},"
                f" but '{first.name}' is {size_text(first.left)}",
                "give frames of the same size",
            )
        own += len(pair.notes) > len(first.notes)
        depths.add(pair.bits)
        found.append(pair.name)
        progress(number)
    if first is None:
        raise InputError("the sequence has no frame", "give at least one")
    notes = first.notes
    if own:
        notes += (f"{own} more frames have notes of their own; see their reports",)
    if len(depths) > 1:
        bits = max(depths)
        notes += (f"all frames are read with {bits} bits, which the brightest needs",)
        first = next(iter(frames.read(bits)))
    missing = ""
    if len(found) < frames.expected:
        missing = f"'{frames.files[0]}' says that it has {frames.expected} frames, {len(found)} can be read"
    return Checked(tuple(found), replace(first, notes=notes), bits, notes, missing)


def _a(kind: names.Kind) -> str:
    return "a video" if kind == "video" else "a row of images"
