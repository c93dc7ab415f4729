"""The options by which a command takes its stereo pair: two files, or a data set's name."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth import screen
from softdepth.run import measure
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.images import StereoPair

Left = Annotated[Path | None, typer.Argument(metavar="LEFT", help="Left image, rectified.")]
Right = Annotated[Path | None, typer.Argument(metavar="RIGHT", help="Right image, rectified.")]
Dataset = Annotated[
    str | None, typer.Option("--dataset", metavar="NAME", help="A known pair; see softdepth datasets.")
]
GroundTruth = Annotated[
    Path | None,
    typer.Option("--gt", metavar="FILE", help="Known disparity of the reference view: PFM or gray PNG."),
]
GroundTruthScale = Annotated[
    float | None,
    typer.Option("--gt-scale", metavar="N", help="File units per pixel of disparity."),
]


def read(
    left: Path | None,
    right: Path | None,
    dataset: str | None,
    truth: Path | None,
    scale: float | None,
    config: Config,
    *,
    built: bool = False,
) -> "StereoPair":
    """The pair that these options choose, checked against the core; its notes go to the screen.

    `built` tells that the core is on a board, so that no option changes it any more.

    Raises `InputError` where the options contradict, a file is unusable, or the core cannot take the pair.
    """
    if scale is not None and truth is None:
        raise InputError(f"--gt-scale {scale:g} without --gt", "name the ground truth it belongs to")
    if dataset is None:
        pair = _from_files(left, right, truth, scale, config)
    elif left or truth:
        raise InputError(
            f"--dataset {dataset} brings its own images and truth", "leave the files out, or --dataset"
        )
    else:
        from softdepth.golden.data import datasets

        pair = datasets.load(dataset, reference=config.reference)
    measure.check_fits(pair, config, built=built)
    for text in pair.notes:
        screen.note(f"note: {text}")
    return pair


def _from_files(
    left: Path | None, right: Path | None, truth: Path | None, scale: float | None, config: Config
) -> "StereoPair":
    if left is None or right is None:
        raise InputError(
            f"a pair is two images, {1 if left else 0} given",
            "give LEFT and RIGHT, or --dataset NAME",
        )
    from softdepth.golden.data.images import read_pair
    from softdepth.golden.data.truth import read_truth

    pair = read_pair(left, right)
    if truth is None:
        return pair
    shape = (pair.height, pair.width)
    return replace(pair, truth=read_truth(truth, scale=scale, shape=shape, view=config.reference))
