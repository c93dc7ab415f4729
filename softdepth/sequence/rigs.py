"""Folders of rigs: the views of each, and the calibration beside them."""

from dataclasses import dataclass
from pathlib import Path

from softdepth.sequence.names import VIDEOS, natural
from softdepth.spec.errors import InputError

CALIBRATIONS = frozenset((".yml", ".yaml", ".xml", ".txt"))
FIRST = ("intrinsic", "left")
"""What the first of two calibration files is called."""
TRUTH = "truth"
LAYOUT = "give LEFT and RIGHT, or a folder with left/ and right/ in it, or in each of its folders"


@dataclass(frozen=True)
class RigFolder:
    """A rig in a folder: ``left`` and ``right`` (folders of images, or videos), and what is known of them.

    Members
    -------
    name : of the folder.
    left, right : the views.
    truth : the folder of known disparities, or None.
    calibration : no file, one, or two with the left one's first.
    """

    name: str
    left: Path
    right: Path
    truth: Path | None
    calibration: tuple[Path, ...]


def find(folder: Path) -> list[RigFolder]:
    """The rigs in a folder: the folder itself, or each of its sub-folders with views, sorted by name.

    Raises `InputError` for a folder without a rig, and for one with a single view or more calibrations than
    a rig has.
    """
    if rig := _rig(folder):
        return [rig]
    inside = sorted((each for each in folder.iterdir() if each.is_dir()), key=natural)
    found = [rig for each in inside if not each.name.startswith(".") and (rig := _rig(each))]
    if not found:
        raise InputError(f"folder '{folder}' holds no rig", LAYOUT)
    return found


def _rig(folder: Path) -> RigFolder | None:
    left, right = _view(folder, "left"), _view(folder, "right")
    if left is None and right is None:
        return None
    if left is None or right is None:
        missing = "left" if left is None else "right"
        raise InputError(
            f"rig '{folder}' has no {missing} view", f"give it {missing}/, or a video called {missing}"
        )
    files = [each for each in folder.iterdir() if each.is_file() and each.suffix.lower() in CALIBRATIONS]
    if len(files) > 2:
        names = ", ".join(sorted(each.name for each in files))
        raise InputError(
            f"rig '{folder}' has {len(files)} calibrations: {names}", "give one, or one per camera"
        )
    files.sort(key=lambda each: (not any(word in each.stem.lower() for word in FIRST), each.name))
    truth = folder / TRUTH
    return RigFolder(folder.resolve().name, left, right, truth if truth.is_dir() else None, tuple(files))


def _view(folder: Path, name: str) -> Path | None:
    if (inside := folder / name).is_dir():
        return inside
    videos = sorted(each for each in folder.glob(f"{name}.*") if each.suffix.lower() in VIDEOS)
    return videos[0] if videos else None
