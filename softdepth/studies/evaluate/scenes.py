"""Folders of scenes: pairs with known depth."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from softdepth.golden.data.images import read_pair
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.truth import Truth, from_disparity, read_truth
from softdepth.spec.errors import InputError
from softdepth.studies.evaluate.families import EIGHTHS, LEVELS, family

_SUFFIXES = (".png", ".ppm", ".pgm")


@dataclass(frozen=True)
class Scene:
    """A folder with a pair and its truth.

    Members
    -------
    name : the folder's name.
    group : the data set it is of (`families`).
    left, right, truth : its files.
    other_truth : the right view's, if there is one.
    """

    name: str
    group: str
    left: Path
    right: Path
    truth: Path
    other_truth: Path | None = None

    def load(self) -> StereoPair:
        """The pair in 8 bits, with the truth of its left view; raises `InputError` for unusable files."""
        pair = read_pair(self.left, self.right, self.name).as_format("rgb8")
        return replace(pair, truth=self._truth((pair.height, pair.width)))

    def _truth(self, shape: tuple[int, int]) -> Truth:
        gray = self.truth.suffix != ".pfm"
        scale = LEVELS if gray and self.group == EIGHTHS else None
        found = read_truth(self.truth, scale=scale, shape=shape)
        if self.other_truth is None:
            return found
        other = read_truth(self.other_truth, scale=scale, shape=shape, view="right")
        return from_disparity(found.disparity, gray=found.gray, other=other.disparity)


def find(folders: Sequence[Path], leave_out: Sequence[str] = ()) -> list[Scene]:
    """Every scene in some folders, each of which is one itself or holds one a subfolder; by name.

    A scene has ``left.png``, ``right.png`` and ``truth.pfm``, or, as Middlebury's, ``im2``, ``im6`` and
    ``disp2`` (and ``disp6``).

    Raises
    ------
    InputError : a folder that is missing or holds no scene, an unknown name in `leave_out`, or two
        scenes of the same name.
    """
    scenes: dict[str, Scene] = {}
    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"'{folder}' is not a folder", "give one whose subfolders are scenes")
        found = [
            s for f in (folder, *sorted(folder.iterdir())) if f.is_dir() and (s := _scene(f)) is not None
        ]
        if not found:
            raise InputError(
                f"'{folder}' holds no scene",
                "give a folder whose subfolders have left.png, right.png and truth.pfm",
            )
        for scene in found:
            if scene.name in scenes:
                raise InputError(f"two scenes are called '{scene.name}'", "rename one of the folders")
            scenes[scene.name] = scene
    for name in leave_out:
        if name not in scenes:
            raise InputError(f"there is no scene '{name}'", f"leave out one of {', '.join(sorted(scenes))}")
    return [scene for name, scene in sorted(scenes.items()) if name not in leave_out]


def _scene(folder: Path) -> Scene | None:
    def file(stem: str, suffixes: Sequence[str] = _SUFFIXES) -> Path | None:
        return next((p for s in suffixes if (p := folder / f"{stem}{s}").is_file()), None)

    for left, right, truth, other in (("left", "right", "truth", ""), ("im2", "im6", "disp2", "disp6")):
        files = file(left), file(right), file(truth, (".pfm", *_SUFFIXES))
        if None not in files:
            name = folder.resolve().name
            return Scene(name, family(name), *files, file(other) if other else None)  # type: ignore[arg-type]
    return None
