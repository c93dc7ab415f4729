"""What a user names as a sequence: a folder of images, a pattern, or a video."""

import glob
import re
from pathlib import Path
from typing import Literal

from softdepth.spec.errors import InputError

IMAGES = frozenset(
    (
        ".png",
        ".jpg",
        ".jpeg",
        ".pgm",
        ".ppm",
        ".pnm",
        ".pbm",
        ".pam",
        ".tif",
        ".tiff",
        ".bmp",
        ".webp",
        ".jp2",
    )
)
TRUTHS = IMAGES | {".pfm", ".npy"}
VIDEOS = frozenset(
    (
        ".mp4",
        ".m4v",
        ".avi",
        ".mkv",
        ".mov",
        ".webm",
        ".mpg",
        ".mpeg",
        ".wmv",
        ".y4m",
        ".mjpeg",
        ".ts",
        ".flv",
    )
)

Kind = Literal["images", "video"]


def is_sequence(path: Path | None) -> bool:
    """Whether a name stands for more than one image: a folder, a pattern, or a video's file."""
    return path is not None and (path.is_dir() or is_pattern(path) or path.suffix.lower() in VIDEOS)


def is_pattern(path: Path) -> bool:
    """Whether a name is a pattern with ``*``, ``?`` or ``[]`` and not a file's own."""
    return glob.has_magic(str(path)) and not path.exists()


def kind_of(path: Path) -> Kind:
    """Images (a folder or a pattern) or a video; raises `InputError` for one image or none."""
    if path.is_dir() or is_pattern(path):
        return "images"
    if not path.exists():
        raise InputError(f"'{path}' does not exist", "give a folder, a pattern in quotes, or a video")
    if path.suffix.lower() in IMAGES:
        raise InputError(
            f"'{path}' is one image", "give its folder, a pattern in quotes, or use softdepth run"
        )
    return "video"


def files_of(path: Path, suffixes: frozenset[str] = IMAGES) -> list[Path]:
    """The files of a folder with one of `suffixes`, or those that a pattern matches, with 2 before 10.

    Raises `InputError` if there is none, or where the folder cannot be read.
    """
    if is_pattern(path):
        found = [each for name in glob.glob(str(path), recursive=True) if (each := Path(name)).is_file()]
        if not found:
            raise InputError(f"no file matches '{path}'", "look what is there with ls")
        return sorted(found, key=natural)
    try:
        inside = list(path.iterdir())
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise InputError(
            f"folder '{path}' cannot be read ({reason})", "check the path and its rights"
        ) from error
    found = [each for each in inside if each.suffix.lower() in suffixes and not each.name.startswith(".")]
    if not found:
        raise InputError(
            f"folder '{path}' holds no images", f"give one with files of {', '.join(sorted(suffixes))}"
        )
    return sorted(found, key=natural)


def natural(path: Path) -> tuple[tuple[tuple[str, int], ...], str]:
    """A key that sorts names as people number them: ``left2`` before ``left10``."""
    parts = re.split(r"(\d+)", str(path))
    return tuple((part, 0) if k % 2 == 0 else ("", int(part)) for k, part in enumerate(parts)), str(path)


def partners(left: list[Path], right: list[Path], names: tuple[Path, Path]) -> list[tuple[Path, Path]]:
    """The pairs of two lists of files, in their order.

    Raises `InputError` for lists of unequal length, and where a file's number names another partner.
    """
    numbers = [_number(path) for path in right]
    known = set(numbers)
    for first, number in zip(left, numbers, strict=False):
        mine = _number(first)
        if mine is not None and mine != number and mine in known:
            other = right[numbers.index(mine)]
            raise InputError(
                f"frame '{first.name}' would be paired with '{right[left.index(first)].name}',"
                f" not '{other.name}'",
                "check that both views have the same frames",
            )
    if len(left) != len(right):
        raise InputError(
            f"'{names[0]}' has {len(left)} frames, '{names[1]}' has {len(right)}",
            "check that both views have the same frames",
        )
    return list(zip(left, right, strict=True))


def _number(path: Path) -> int | None:
    found = re.findall(r"\d+", path.stem)
    return int(found[-1]) if found else None
