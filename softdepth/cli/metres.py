"""The options that turn disparities into metres, and the files that result."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from softdepth import screen
from softdepth.cli import calibrations
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.golden.maps import DisparityMap
    from softdepth.metric.scene import Choice, Scene
    from softdepth.rig.geometry import Geometry
    from softdepth.rig.rectify import Rectifier
    from softdepth.spec.config import Config

FILES = ("depth.png", "depth.tiff", "depth.pfm", "cloud.ply", "cloud.npz", "uncertainty.tiff", "view.html")
"""What a run writes besides where the cameras are known."""


@dataclass(frozen=True)
class Kept:
    """Which results become depth, and what is known about their error."""

    measured_only: Annotated[
        bool, typer.Option("--measured-only", help="Depth of measured results only, none that was filled in.")
    ] = False
    min_confidence: Annotated[
        int, typer.Option("--min-confidence", metavar="N", help="Depth of results this sure only, 0 to 255.")
    ] = 0
    disparity_error: Annotated[
        float | None,
        typer.Option(
            "--disparity-error",
            metavar="PX",
            help="Standard error of a disparity: writes that of each depth, in metres (uncertainty.tiff).",
        ),
    ] = None

    def choice(self) -> "Choice":
        """As the models take it; raises `InputError` for an impossible confidence or error."""
        from softdepth.metric.scene import Choice

        if self.disparity_error is not None and not 0 < self.disparity_error < float("inf"):
            raise InputError(
                f"--disparity-error {self.disparity_error:g} is not an error", "give pixels, for example 0.25"
            )
        return Choice(self.measured_only, self.min_confidence)

    def check(self, config: "Config", metres: bool = True) -> None:
        """Raise `InputError` if a core cannot give what is asked for, and for options without `metres`.

        Depth, points and their colours are in the left camera's frame, which a map of the right view is not.
        """
        if metres and config.reference == "right":
            raise InputError(
                "depth in metres is for the left view, but the configuration's reference is right",
                "use --set reference=left, or leave the cameras out",
            )
        if self.min_confidence and not config.post.confidence:
            raise InputError(
                f"min_confidence is {self.min_confidence}, but preset {config.name} has no confidence",
                "use a preset that has it, such as robust, or leave the floor out",
            )
        given = {
            "--measured-only": self.measured_only,
            f"--min-confidence {self.min_confidence}": self.min_confidence,
            f"--disparity-error {self.disparity_error}": self.disparity_error,
        }
        if not metres and (options := [name for name, value in given.items() if value]):
            raise InputError(
                f"{options[0]} is about depth in metres, but the cameras are not known",
                "give --focal and --baseline, --calibration or --rectify as well",
            )


@dataclass(frozen=True)
class Cameras:
    """The geometry of a rectified pair, by numbers or by a calibration."""

    focal: Annotated[
        float | None, typer.Option("--focal", metavar="PX", help="Focal length of the rectified images, px.")
    ] = None
    baseline: Annotated[
        float | None, typer.Option("--baseline", metavar="M", help="Distance of the cameras, metres.")
    ] = None
    doffs: Annotated[
        float | None,
        typer.Option(
            "--doffs", metavar="PX", help="Right principal column less the left one, px [default: 0]."
        ),
    ] = None
    principal: Annotated[
        tuple[float, float] | None,
        typer.Option("--principal", metavar="CX CY", help="Left principal point, px [default: the middle]."),
    ] = None
    calibration: Annotated[
        list[Path] | None,
        typer.Option(
            "--calibration",
            metavar="FILE",
            help="A calibration in place of the numbers (docs/rig.md); twice where it has two files.",
        ),
    ] = None
    unit: calibrations.Unit = None
    frame_id: Annotated[
        str | None,
        typer.Option("--frame-id", metavar="NAME", help="Name of the left camera's optical frame."),
    ] = None

    @property
    def numbers(self) -> list[str]:
        """The options that give a number of the geometry, as far as the user has given them."""
        found = {
            "--focal": self.focal,
            "--baseline": self.baseline,
            "--doffs": self.doffs,
            "--principal": self.principal,
        }
        return [option for option, value in found.items() if value is not None]

    @property
    def given(self) -> bool:
        """Whether the user said anything about the cameras."""
        return bool(self.numbers or self.calibration or self.unit is not None or self.frame_id is not None)

    def geometry(self, size: tuple[int, int] | None) -> "Geometry":
        """The geometry of images of `size` (width, height); None is the size that was calibrated for.

        Raises `InputError` if a number is missing or cannot be, and for options that contradict.
        """
        if self.calibration:
            self.refuse_numbers("--calibration", self.calibration)
            return self.named(calibrations.geometry(self.calibration, self.unit, size))
        from softdepth.rig.geometry import Geometry

        if self.unit is not None:
            raise InputError(f"--unit {self.unit:g} without a calibration", "give --calibration as well")
        if self.focal is None or self.baseline is None:
            missing = "--focal" if self.focal is None else "--baseline"
            raise InputError(
                f"depth in metres needs {missing}",
                "give both --focal (pixels) and --baseline (metres), or --calibration",
            )
        width, height = size or (0, 0)
        cx, cy = self.principal or ((width - 1) / 2, (height - 1) / 2)
        return self.named(Geometry(self.focal, self.baseline, self.doffs or 0.0, cx, cy))

    def refuse_numbers(self, option: str, paths: list[Path]) -> None:
        """Raise `InputError` for numbers beside a calibration, which was given by `option`."""
        if self.numbers:
            raise InputError(
                f"{option} {paths[0]} and {self.numbers[0]} contradict each other",
                "give the calibration or the numbers",
            )

    def named(self, geometry: "Geometry") -> "Geometry":
        """A geometry in the frame that the user has named."""
        if self.frame_id is None:
            return geometry
        if not self.frame_id or any(each.isspace() for each in self.frame_id):
            raise InputError(f"--frame-id '{self.frame_id}' is not a name", "give one without spaces")
        return replace(geometry, frame_id=self.frame_id)


class Prepared(NamedTuple):
    """A pair as the core takes it: rectified, and what is known of its cameras."""

    pair: "StereoPair"
    geometry: "Geometry | None"
    rectifier: "Rectifier | None" = None


def prepare(pair: "StereoPair", cameras: Cameras, raw: calibrations.Raw) -> Prepared:
    """Rectify a pair where the user asks for it, and find its geometry.

    Raises `InputError` for options that contradict each other, and for a calibration that does not fit.
    """
    size = (pair.width, pair.height)
    if not raw.rectify:
        return Prepared(pair, cameras.geometry(size) if cameras.given else None)
    cameras.refuse_numbers("--rectify", raw.rectify)
    if cameras.calibration:
        raise InputError(
            f"--rectify {raw.rectify[0]} and --calibration {cameras.calibration[0]} contradict each other",
            "give --rectify for raw images, --calibration for rectified ones",
        )
    from softdepth.rig.rectify import Rectifier

    rectifier = Rectifier.of(calibrations.raw_rig(raw.rectify, cameras.unit), size)
    geometry = cameras.named(rectifier.geometry)
    left, right = rectifier.apply(pair.left, pair.right)
    text = f"the pair is rectified by '{raw.rectify[0]}'"
    screen.note(f"note: {text}")
    return Prepared(replace(pair, left=left, right=right, notes=(*pair.notes, text)), geometry, rectifier)


def scene_of(found: "DisparityMap", geometry: "Geometry", kept: Kept, pair: "StereoPair") -> "Scene":
    """The scene of a map, coloured by the left image."""
    from softdepth.metric.scene import Scene

    return Scene.of(
        geometry,
        found.pixels,
        found.code,
        found.confidence,
        choice=kept.choice(),
        image=pair.as_format("rgb8").left,
    )


def facts(scene: "Scene", pair: "StereoPair", config: "Config") -> tuple[str, ...]:
    """What the page says above its pictures."""
    known = scene.depth == scene.depth
    share = 100 * known.mean()
    filled = 100 * scene.filled.mean()
    return (
        f"{pair.width}x{pair.height} pixels, preset {config.name}, {config.disparities} candidates",
        f"{share:.1f} % of the pixels have a depth, {filled:.1f} % filled in from a neighbour",
        f"focal length {scene.geometry.focal:g} px, baseline {scene.geometry.baseline:g} m",
    )


def write(
    folder: Path,
    found: "DisparityMap",
    geometry: "Geometry",
    kept: Kept,
    pair: "StereoPair",
    config: "Config",
) -> None:
    """Write every one of `FILES` into a folder."""
    from softdepth.files import write_atomically
    from softdepth.metric import output
    from softdepth.view.page import page

    scene = scene_of(found, geometry, kept, pair)
    points, notes = output.write(folder, scene, kept.disparity_error)
    for text in notes:
        screen.note(text)
    text = page(pair.name, scene, found.confidence, facts(scene, pair, config))
    write_atomically(folder / "view.html", text.encode())
    screen.note(f"{points:,} points in cloud.ply; view.html shows them")
