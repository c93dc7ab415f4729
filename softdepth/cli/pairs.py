"""The options by which a command takes its stereo pair: two files, or a data set's name."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth import screen
from softdepth.cli import options
from softdepth.files import refuse_to_replace
from softdepth.run import measure
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.golden.data.images import Joined
    from softdepth.golden.data.pair import StereoPair


TruthScale = Annotated[
    float | None, typer.Option("--gt-scale", metavar="N", help="File units per pixel of disparity.")
]
Bits = Annotated[
    int | None,
    typer.Option("--bits", metavar="N", help="Bits a channel in the image files, where they hold fewer."),
]
SideBySide = Annotated[
    bool, typer.Option("--side-by-side", help="LEFT holds both views: left half and right half.")
]
TopBottom = Annotated[
    bool, typer.Option("--top-bottom", help="LEFT holds both views: the left one above the right one.")
]


@dataclass(frozen=True)
class Source:
    """Where a stereo pair comes from, and what is known of it."""

    left: Annotated[
        Path | None,
        typer.Argument(metavar="LEFT", help="Left image, rectified; '-' is standard input."),
    ] = None
    right: Annotated[Path | None, typer.Argument(metavar="RIGHT", help="Right image, rectified.")] = None
    dataset: Annotated[
        str | None, typer.Option("--dataset", metavar="NAME", help="A known pair; see softdepth datasets.")
    ] = None
    truth: Annotated[
        Path | None,
        typer.Option(
            "--gt",
            metavar="FILE",
            help="Known disparity of the reference view: PFM, NPY, float TIFF or gray PNG.",
        ),
    ] = None
    truth_scale: TruthScale = None
    bits: Bits = None
    side_by_side: SideBySide = False
    top_bottom: TopBottom = False

    @property
    def is_sequence(self) -> bool:
        """Whether the files stand for more than one pair."""
        from softdepth.sequence.names import is_sequence

        return is_sequence(self.left) or is_sequence(self.right)

    @property
    def joined(self) -> "Joined | None":
        """How both views lie in one file, if they do; raises `InputError` for two answers."""
        return joined(self.side_by_side, self.top_bottom)

    def keep_safe(self, output: Path, names: Iterable[str], *others: Path | None) -> None:
        """Raise `InputError` if a file of `names` in `output` is one of the pair's, or of the others."""
        inputs = (self.left, self.right, self.truth, *others)
        refuse_to_replace(output, names, [path for path in inputs if path is not None])

    def read(self, config: Config) -> "StereoPair":
        """The pair, in the core's pixels; its notes go to the screen.

        Raises `InputError` if the options contradict each other, or if a file is unusable.
        """
        scale, truth = self.truth_scale, self.truth
        if scale is not None and truth is None:
            raise InputError(f"--gt-scale {scale:g} without --gt", "name the ground truth it belongs to")
        layout = self.joined
        if self.dataset is None:
            if self.is_sequence:
                raise InputError(
                    f"'{self.left}' and '{self.right}' are not two images", "use softdepth sequence for more"
                )
            pair = _images(self.left, self.right, layout, self.bits)
            if truth is not None:
                pair = _with_truth(pair, (self.left, self.right), truth, scale, config)
        elif self.left or truth or self.bits is not None or self.side_by_side or self.top_bottom:
            raise InputError(
                f"--dataset {self.dataset} brings its own images and truth",
                "leave out the files and what is said about them, or --dataset",
            )
        else:
            from softdepth.golden.data import datasets

            pair = datasets.load(self.dataset, reference=config.reference)
        pair = pair.as_format(config.pixel)
        for text in pair.notes:
            screen.note(f"note: {text}")
        return pair

    def read_for(self, choice: options.Choice) -> "tuple[StereoPair, Config]":
        """The pair, and the configuration that is chosen with a core as large as its images.

        ``max_width`` and ``max_height`` stay as they are if the user set them. Raises `InputError` like
        `read`, and if the core cannot take the pair.
        """
        config = choice.configuration()
        pair = self.read(config)
        fitted = measure.as_large_as(
            pair, config, keys=[key for key in measure.LIMITS if not choice.sets(key)]
        )
        if fitted != config:
            size = f"{fitted.max_width}x{fitted.max_height}"
            screen.note(f"note: the core is built for {size}, as large as the images")
        measure.check_fits(pair, fitted, again=options.command)
        return pair, fitted


def joined(side_by_side: bool, top_bottom: bool) -> "Joined | None":
    """How both views lie in one file, if they do; raises `InputError` for two answers."""
    if side_by_side and top_bottom:
        raise InputError("--side-by-side and --top-bottom contradict each other", "give one of the two")
    return "side-by-side" if side_by_side else "top-bottom" if top_bottom else None


def _images(left: Path | None, right: Path | None, layout: "Joined | None", bits: int | None) -> "StereoPair":
    from softdepth.golden.data.images import read_joined, read_pair

    if layout is not None:
        if left is None or right is not None:
            count = 2 if right else 0
            raise InputError(f"--{layout} takes one file with both views, {count} given", "name that file")
        return read_joined(left, layout, bits=bits)
    if left is None or right is None:
        raise InputError(
            f"a pair is two images, {1 if left else 0} given",
            "give LEFT and RIGHT, one file with --side-by-side or --top-bottom, or --dataset NAME",
        )
    return read_pair(left, right, bits=bits)


def _with_truth(
    pair: "StereoPair",
    images: tuple[Path | None, Path | None],
    path: Path,
    scale: float | None,
    config: Config,
) -> "StereoPair":
    from softdepth.golden.data.inputs import is_standard_input
    from softdepth.golden.data.truth import read_truth

    if is_standard_input(path) and any(is_standard_input(image) for image in images):
        raise InputError("an image and --gt cannot both come from standard input", "give one as a file")
    truth = read_truth(
        path,
        scale=scale,
        shape=(pair.height, pair.width),
        view=config.reference,
        candidates=config.max_disparity + 1,
    )
    return replace(pair, truth=truth, notes=(*pair.notes, *truth.notes))
