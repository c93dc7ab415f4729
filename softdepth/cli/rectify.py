"""``softdepth rectify``: a raw pair and its calibration to a pair that the core can take."""

from pathlib import Path
from typing import Annotated

import typer

from softdepth import screen
from softdepth.cli import calibrations

PIXEL = "rgb8"
"""The pixels that are written."""


def rectify(
    left: Annotated[Path, typer.Argument(metavar="LEFT", help="Left image, as the camera gives it.")],
    right: Annotated[Path, typer.Argument(metavar="RIGHT", help="Right image, likewise.")],
    calibration: Annotated[
        list[Path],
        typer.Option(
            "--calibration",
            metavar="FILE",
            help="OpenCV, ROS camera_info, Kalibr; twice where each camera has a file, left first.",
        ),
    ],
    unit: calibrations.Unit = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of the rectified pair.")
    ] = Path("out/rectified"),
) -> None:
    """Rectify a raw pair: its images, its new calibration, and a picture with epipolar lines."""
    from softdepth.files import refuse_to_replace, result_folder
    from softdepth.golden.data.images import read_pair
    from softdepth.inspect.measurements import measure
    from softdepth.rig import output as results
    from softdepth.rig.rectify import Rectifier

    rig = calibrations.raw_rig(calibration, unit)
    refuse_to_replace(output, results.FILES, (left, right, *calibration))
    pair = read_pair(left, right).as_format(PIXEL)
    for text in pair.notes:
        screen.note(f"note: {text}")
    rectifier = Rectifier.of(rig, (pair.width, pair.height))
    views = rectifier.apply(pair.left, pair.right)
    with result_folder(output, stale=results.FILES, last="calibration.yml") as folder:
        results.write(folder, rectifier, *views)
    geometry, rows = rectifier.geometry, measure(*views).rows
    print(f"focal length {geometry.focal:.3f} px, baseline {geometry.baseline * 1000:.3f} mm")
    for side, (up, down) in zip(("left", "right"), rectifier.row_budget(), strict=True):
        print(f"row budget, {side}: {up} rows up, {down} down, {up + down + 1} lines held")
    if rows is None:
        print("rows: unknown, too few points are found in both views")
    else:
        print(
            f"rows: {rows.offset:+.2f} off in the middle, changing by up to {rows.change:.2f},"
            f" residual {rows.residual:.2f} px"
        )
    print(f"results: {output}")
