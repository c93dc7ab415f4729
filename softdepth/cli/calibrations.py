"""Calibration files as the commands take them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth.files import refuse_to_replace, write_atomically
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.rig.geometry import Geometry
    from softdepth.rig.rectify import Rectifier
    from softdepth.rig.rig import Rig

Unit = Annotated[
    float | None,
    typer.Option("--unit", metavar="METRES", help="What OpenCV's lengths are in: 0.001 for millimetres."),
]


RESULT = "calibration.yml"
"""What a run that rectifies calls its pair's new calibration."""
MARK = "The pair that softdepth run has rectified, lengths in metres."
"""The comment in it, which tells it from a calibration that belongs to the user."""


@dataclass(frozen=True)
class Raw:
    """The calibration of a pair that has not been rectified yet."""

    rectify: Annotated[
        list[Path] | None,
        typer.Option(
            "--rectify",
            metavar="FILE",
            help="The images are raw: rectify them by this calibration first; twice where it has two files.",
        ),
    ] = None

    def check(self, dataset: str | None, output: Path | None = None) -> None:
        """Raise `InputError` for a rectified pair, and where results would replace the calibration."""
        if not self.rectify:
            return
        if dataset is not None:
            raise InputError(
                f"--rectify {self.rectify[0]} is for raw images, --dataset {dataset} is rectified already",
                "give one of the two",
            )
        if output is not None:
            refuse_to_replace(output, [RESULT], self.rectify)


def stale(output: Path, inputs: Sequence[Path]) -> tuple[str, ...]:
    """The name of the calibration that an earlier run has left in its folder, unless it is read now."""
    path = output / RESULT
    try:
        ours = MARK.encode() in path.read_bytes()
    except OSError:
        return ()
    return (RESULT,) if ours and path.resolve() not in {each.resolve() for each in inputs} else ()


def write(folder: Path, rectifier: "Rectifier", pair: "StereoPair") -> None:
    """Write a rectified pair's calibration into a run's folder."""
    from softdepth.rig.output import calibration

    text = calibration(rectifier, pair.width, pair.height, comment=MARK)
    write_atomically(folder / RESULT, text.encode())


def rig(paths: Sequence[Path], unit: float | None) -> "Rig":
    """The rig of calibration files, left camera first; raises `InputError` for what is wrong with them."""
    from softdepth.rig.readers import any as readers

    if unit is not None and not 0 < unit < float("inf"):
        raise InputError(f"--unit {unit:g} is not a length", "give metres, for example --unit 0.001")
    return readers.read(paths, 1.0 if unit is None else unit)


def raw_rig(paths: Sequence[Path], unit: float | None) -> "Rig":
    """The same of a raw pair; raises `InputError` for the calibration of rectified images as well."""
    found = rig(paths, unit)
    if found.rectified:
        raise InputError(
            f"'{paths[0]}' is the calibration of rectified images",
            "use the images as they are, with run --calibration",
        )
    return found


def geometry(paths: Sequence[Path], unit: float | None, size: tuple[int, int] | None) -> "Geometry":
    """The geometry of rectified images of `size` (width, height), or of those that were calibrated for.

    Raises `InputError` for images of another size, and where the calibration leaves open how the images
    were rectified.
    """
    found = rig(paths, unit)
    calibrated = found.left.size
    if size is None and calibrated is not None and found.rectification is None:
        from softdepth.rig.rectify import Rectifier

        return Rectifier.of(found, calibrated).geometry  # what --rectify would make of it
    if found.rectification is None:
        raise InputError(
            f"'{paths[0]}' does not tell how its images were rectified",
            "give raw images and --rectify in place of --calibration, or use softdepth rectify first",
        )
    if size is not None and calibrated is not None and calibrated != size:
        raise InputError(
            f"the images are {size[0]}x{size[1]}, '{paths[0]}' is for {calibrated[0]}x{calibrated[1]}",
            "give images of that size, or the calibration of these",
        )
    return found.rectification.geometry
