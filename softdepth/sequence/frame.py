"""One frame of a sequence: computed, written whole, and known again."""

import hashlib
import json
import time
from dataclasses import dataclass, field
from functools import cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ValidationError

from softdepth.files import whole_folder, write_atomically
from softdepth.golden import fixed_model
from softdepth.golden.data import writers
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.maps import DisparityMap
from softdepth.golden.score import pictures
from softdepth.metric import output
from softdepth.metric.scene import Choice, Scene
from softdepth.rig.geometry import Geometry
from softdepth.run.report import Accuracy, accuracy
from softdepth.sources import sources_hash
from softdepth.spec.config import Config
from softdepth.spec.validity import Validity

SCHEMA = 2
REPORT = "frame.json"
LEFT = "left.png"
"""The left view in 8 bits, as the core saw it: depth and points lie on its pixels."""

Engine = Literal["rtl", "fixed", "board"]


class Record(BaseModel):
    """``frame.json``, and a row of the sequence's table.

    Members
    -------
    key : of everything that the frame's files depend on.
    files : what lies beside it.
    seconds, pixels_per_second : of the engine.
    shares : of each validity code, in percent.
    low, high : the disparities worth a colour of their own, in pixels.
    mismatches : pixels in which the gateware departs from the fixed-point model; None without gateware.
    first_mismatches : the first of them, as text.
    """

    schema_version: int = SCHEMA
    index: int
    name: str
    key: str
    files: list[str]
    notes: list[str]
    seconds: float
    pixels_per_second: float
    shares: dict[str, float]
    low: float
    high: float
    mismatches: int | None
    first_mismatches: list[str] = []
    accuracy: Accuracy
    kept: bool = False


@dataclass(frozen=True)
class Recipe:
    """What is done with every frame.

    Members
    -------
    config : of the core.
    engine : whose map is the result.
    geometry : of the rectified pair; without it there is no depth in metres.
    choice : which results become depth.
    disparity_error : standard error of a disparity in pixels, or None.
    about : more that a result depends on, as text: the board's revision.
    """

    config: Config
    engine: Engine
    geometry: Geometry | None = None
    choice: Choice = field(default_factory=Choice)
    disparity_error: float | None = None
    about: str = ""

    @cached_property
    def digest(self) -> str:
        """Of all but the frame: options, configuration, and the program itself."""
        rooms = ("metric", "sim") if self.engine == "rtl" else ("metric",)
        parts = [
            *(
                SCHEMA,
                self.engine,
                self.config.hash,
                self.geometry,
                self.choice,
                self.disparity_error,
                self.about,
            ),
            sources_hash(*rooms),
            *(version(name) for name in ("numpy", "opencv-python-headless")),
        ]
        return hashlib.sha256(repr(parts).encode()).hexdigest()

    def key(self, pair: StereoPair) -> str:
        """The frame's key: the recipe's digest, the pixels of both views and the truth."""
        found = hashlib.sha256(self.digest.encode())
        arrays = [pair.left, pair.right]
        if pair.truth is not None:
            arrays += [each for each in (pair.truth.disparity, pair.truth.nonoccluded) if each is not None]
        for array in arrays:
            found.update(f"{array.dtype} {array.shape}".encode())
            found.update(np.ascontiguousarray(array).data)
        return found.hexdigest()


def kept(folder: Path, recipe: Recipe, pair: StereoPair, index: int) -> Record | None:
    """The record of a frame that an earlier run of the same recipe has finished, or None."""
    try:
        record = Record.model_validate_json((folder / REPORT).read_text())
    except (OSError, ValidationError, ValueError):
        return None
    if record.key != recipe.key(pair) or not all((folder / name).is_file() for name in record.files):
        return None
    return record.model_copy(update={"kept": True, "index": index, "name": pair.name})


def finish(
    folder: Path,
    recipe: Recipe,
    pair: StereoPair,
    index: int,
    found: DisparityMap | None = None,
    seconds: float = 0.0,
) -> Record:
    """Write a frame into `folder`, which appears whole.

    `found` is the gateware's map, which took `seconds`; it is compared with the fixed-point model's. Without
    it the model's map is the result.
    """
    start = time.perf_counter()
    model = fixed_model.disparity(pair.left, pair.right, recipe.config)
    if found is None:
        found, differences, seconds = model, None, time.perf_counter() - start
    else:
        differences = [str(each) for each in model.differences(found)]
    with whole_folder(folder) as place:
        low, high = write(place, recipe, pair, found)
        record = Record(
            index=index,
            name=pair.name,
            key=recipe.key(pair),
            files=sorted(path.name for path in place.iterdir()),
            notes=list(pair.notes),
            seconds=seconds,
            pixels_per_second=found.code.size / max(seconds, 1e-9),
            shares={each.name.lower(): 100 * float((found.code == each).mean()) for each in Validity},
            low=low,
            high=high,
            mismatches=None if differences is None else len(differences),
            first_mismatches=(differences or [])[:3],
            accuracy=accuracy(found, pair.truth),
        )
        text = json.dumps(record.model_dump(exclude={"kept"}), indent=2) + "\n"
        write_atomically(place / REPORT, text.encode())
    return record


def write(place: Path, recipe: Recipe, pair: StereoPair, found: DisparityMap) -> tuple[float, float]:
    """Write a frame's maps into a folder; the range of its disparities that is worth a colour."""
    pixels, given = found.pixels, found.given
    low, high = pictures.colour_range(pixels, given)
    writers.write_disparity_png(place / "disparity.png", pixels, given, first=recipe.config.min_disparity)
    writers.write_pfm(place / "disparity.pfm", pixels, given)
    write_atomically(place / "code.png", pictures.code_picture(found.code))
    coloured = pictures.colour(pixels, given, high, minimum=low, code=found.code)
    writers.write_picture(place / "colour.png", coloured)
    image = pair.as_format("rgb8").left
    writers.write_picture(place / LEFT, image)
    if recipe.geometry is not None:
        scene = Scene.of(
            recipe.geometry, pixels, found.code, found.confidence, choice=recipe.choice, image=image
        )
        output.write(place, scene, recipe.disparity_error)
    return low, high
