"""The options that turn disparities into metres, and the files that come of it."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth import screen
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.golden.maps import DisparityMap
    from softdepth.metric.scene import Choice, Scene
    from softdepth.rig.geometry import Geometry
    from softdepth.spec.config import Config

FILES = ("depth.png", "depth.tiff", "depth.pfm", "cloud.ply", "cloud.npz", "view.html")
"""What a run writes besides where the cameras are known."""


@dataclass(frozen=True)
class Kept:
    """Which results become depth."""

    measured_only: Annotated[
        bool, typer.Option("--measured-only", help="Depth of measured results only, none that was filled in.")
    ] = False
    min_confidence: Annotated[
        int, typer.Option("--min-confidence", metavar="N", help="Depth of results this sure only, 0 to 255.")
    ] = 0

    def choice(self) -> "Choice":
        """As the models take it; raises `InputError` for a confidence that there cannot be."""
        from softdepth.metric.scene import Choice

        return Choice(self.measured_only, self.min_confidence)


@dataclass(frozen=True)
class Cameras:
    """The geometry of a rectified pair, by numbers."""

    focal: Annotated[
        float | None, typer.Option("--focal", metavar="PX", help="Focal length of the rectified images, px.")
    ] = None
    baseline: Annotated[
        float | None, typer.Option("--baseline", metavar="M", help="Distance of the cameras, metres.")
    ] = None
    doffs: Annotated[
        float, typer.Option("--doffs", metavar="PX", help="Right principal column less the left one, px.")
    ] = 0.0
    principal: Annotated[
        tuple[float, float] | None,
        typer.Option("--principal", metavar="CX CY", help="Left principal point, px [default: the middle]."),
    ] = None

    @property
    def given(self) -> bool:
        """Whether the user has said anything of the cameras."""
        return self.focal is not None or self.baseline is not None

    def geometry(self, width: int, height: int) -> "Geometry":
        """The geometry of images of this size; raises `InputError` where a number is missing or cannot be."""
        from softdepth.rig.geometry import Geometry

        if self.focal is None or self.baseline is None:
            missing = "--focal" if self.focal is None else "--baseline"
            raise InputError(
                f"depth in metres needs {missing}", "give both --focal (pixels) and --baseline (metres)"
            )
        cx, cy = self.principal or ((width - 1) / 2, (height - 1) / 2)
        return Geometry(self.focal, self.baseline, self.doffs, cx, cy)


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
    from softdepth.metric import writers
    from softdepth.view.page import page

    scene = scene_of(found, geometry, kept, pair)
    if beyond := writers.write_depth_png(folder / "depth.png", scene.depth):
        screen.note(f"depth.png: {beyond} pixels beyond 65.5 m have no depth there; depth.tiff has them")
    writers.write_depth_tiff(folder / "depth.tiff", scene.depth)
    writers.write_depth_pfm(folder / "depth.pfm", scene.depth)
    points = writers.write_ply(folder / "cloud.ply", scene)
    writers.write_npz(folder / "cloud.npz", scene)
    text = page(pair.name, scene, found.confidence, facts(scene, pair, config))
    write_atomically(folder / "view.html", text.encode())
    screen.note(f"{points:,} points in cloud.ply; view.html shows them")
