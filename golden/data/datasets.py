"""Stereo pairs with ground truth, by name: `load`, `names`."""

import hashlib
import os
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import platformdirs
import pooch
import skimage.data

from softdepth.golden.data.decode import read_raster
from softdepth.golden.data.pair import StereoPair
from softdepth.golden.data.synthetic import SCENES, generate
from softdepth.golden.data.truth import View, from_disparity, warp
from softdepth.spec.errors import InputError

DEFAULT = "motorcycle"
"""The dataset that needs no network."""

DATA_VARIABLE = "SOFTDEPTH_DATA"
"""The environment variable that names a folder with ``teddy/``, ``cones/`` and ``venus/``."""

TIMEOUT = 20
"""Seconds that a server may stay silent."""

_SITE = "https://vision.middlebury.edu/stereo/data"
_SYNTHETIC = re.compile(
    r"(?P<scene>\w+)(@(?P<width>\d+)x(?P<height>\d+)(x(?P<disparities>\d+))?)?(#(?P<seed>\d+))?"
)


@dataclass(frozen=True)
class MiddleburyScene:
    """A scene: where it is, its truth's gray levels per pixel, and the SHA-256 of each file's pixels."""

    url: str
    scale: int
    pixels: dict[str, str]


MIDDLEBURY = {
    "teddy": MiddleburyScene(
        f"{_SITE}/scenes2003/newdata/teddy",
        4,
        {
            "im2.png": "8ab3351a6fdd07aa07426589b7c5bfb99ddd6508e67271953eb607f4b44c498e",
            "im6.png": "e0b74127a75fd69935ec6ec1683a991e07e10f0b5c7b2062781153ef48cd1ada",
            "disp2.png": "a676341f430db5dd4be1534b4b8881b215c714a541e3c07d67f3a3cf33edf14d",
            "disp6.png": "845074a5c4051c686bb9d7f04a6ca4ea8657a5338ed30e50fcddd3b5617889d1",
        },
    ),
    "cones": MiddleburyScene(
        f"{_SITE}/scenes2003/newdata/cones",
        4,
        {
            "im2.png": "f31fb9f56ee6b81c1442b8f18dad1ea9d92c6886d89f9b8b07852f4da1dad433",
            "im6.png": "450e60009f99e3e0db5db241c7a3b23d6cecce0b239747164422c09be3fa980b",
            "disp2.png": "8fc3e350e686d71ac3fdc7703e8472f36f4e2a10e6fec3594a4e0ee0a3526d12",
            "disp6.png": "e83439fdffddf79c27a534c472d93f1f573e8710255668c1654ae28c9fc6b219",
        },
    ),
    "venus": MiddleburyScene(
        f"{_SITE}/scenes2001/data/venus",
        8,
        {
            "im2.ppm": "6ea6f1c3c9126f8817d7ea585f3911f29b2c7ffa135b29e82e5c31ffc8ce32ec",
            "im6.ppm": "7c320c4464846b7b0722ebac952eec132d6c74d40ed553e6c4a0cea9d0ba3714",
            "disp2.pgm": "faff1306a04ce1a7b35bbc43564abc8a501bd2629c02e8793a08548e34a9a611",
        },
    ),
}
"""The scenes by name. Sums are over decoded pixels, because archives and mirrors re-encode the files."""


def names() -> tuple[str, ...]:
    """Every dataset's name; a synthetic one may be followed by ``@WIDTHxHEIGHTxDISPARITIES#SEED``."""
    return (DEFAULT, *(f"middlebury:{s}" for s in MIDDLEBURY), *(f"synthetic:{s}" for s in SCENES))


def load(name: str = DEFAULT, reference: View = "left") -> StereoPair:
    """The pair called `name`, with the ground truth of its `reference` view.

    ``motorcycle`` comes with scikit-image. ``middlebury:SCENE`` is read from the folder named by
    ``SOFTDEPTH_DATA`` or, if that is not set, from the user's cache, downloading it if needed.
    ``synthetic:SCENE[@WIDTHxHEIGHT[xDISPARITIES]][#SEED]`` is made on the spot.

    Raises
    ------
    InputError : an unknown name or reference, bad synthetic parameters, no network, or files that
        are missing or hold other pixels than published.
    """
    if reference not in ("left", "right"):
        raise InputError(f"unknown reference view '{reference}'", "use left or right")
    family, _, rest = name.partition(":")
    if name == DEFAULT:
        return _motorcycle(reference)
    if family == "middlebury" and rest in MIDDLEBURY:
        return _middlebury(rest, reference)
    if family == "synthetic" and (match := _SYNTHETIC.fullmatch(rest)) and match["scene"] in SCENES:
        numbers = {k: int(v) for k, v in match.groupdict().items() if k != "scene" and v is not None}
        return generate(match["scene"], view=reference, **numbers)
    raise InputError(f"unknown dataset '{name}'", f"use one of {', '.join(names())}")


def _motorcycle(reference: View) -> StereoPair:
    """Middlebury 2014's Motorcycle as scikit-image ships it: 741x500, disparities up to 60."""
    left, right, disparity = skimage.data.stereo_motorcycle()
    disparity = np.where(np.isfinite(disparity), disparity, np.nan)
    truth = from_disparity(warp(disparity) if reference == "right" else disparity, view=reference)
    return StereoPair(left, right, DEFAULT, truth)


def _middlebury(scene: str, reference: View) -> StereoPair:
    spec = MIDDLEBURY[scene]
    images = {Path(file).stem: _fetch(scene, file) for file in spec.pixels}
    gray = {
        view: images[stem][:, :, 0]
        for view, stem in (("left", "disp2"), ("right", "disp6"))
        if stem in images
    }
    disparity = {view: np.where(g > 0, g / spec.scale, np.nan).astype(np.float32) for view, g in gray.items()}
    if "right" not in gray:
        # Venus: only the left view's truth is published, so it is moved into the right view. What
        # nobody measured there stays unknown, but the paper's RMSE needs a gray level everywhere.
        disparity["right"] = warp(disparity["left"])
        gray["right"] = _fill_from_farther(np.nan_to_num(disparity["right"] * spec.scale))
    other = disparity["left" if reference == "right" else "right"] if "disp6" in images else None
    truth = from_disparity(disparity[reference], gray=gray[reference], other=other, view=reference)
    return StereoPair(images["im2"], images["im6"], f"middlebury:{scene}", truth)


def _fill_from_farther(gray: np.ndarray) -> np.ndarray:
    """Replace each 0 by the smaller of the nearest levels left and right in its row: holes show the
    background."""
    columns = np.arange(gray.shape[1])

    def left_neighbour(levels: np.ndarray) -> np.ndarray:
        last = np.maximum.accumulate(np.where(levels > 0, columns, 0), axis=1)
        return np.take_along_axis(levels, last, axis=1)

    left, right = left_neighbour(gray), left_neighbour(gray[:, ::-1])[:, ::-1]
    return np.where((left > 0) & (right > 0), np.minimum(left, right), np.maximum(left, right))


def _fetch(scene: str, file: str) -> np.ndarray:
    """One Middlebury file's pixels: RGB for an image, one channel for a truth."""
    folder = os.environ.get(DATA_VARIABLE)
    path = _find(Path(folder), scene, file) if folder else _download(scene, file)
    remedy = f"put Middlebury's own {scene} there" if folder else "delete it: it is downloaded again"
    problem = f"'{path}' does not hold the pixels of Middlebury's {scene}/{file}"
    try:
        pixels = np.ascontiguousarray(read_raster(path).values)
    except InputError as error:
        raise InputError(problem, remedy) from error
    if pixel_sum(pixels) != MIDDLEBURY[scene].pixels[file]:
        raise InputError(problem, remedy)
    return pixels


def _find(folder: Path, scene: str, file: str) -> Path:
    """`file` in a user's folder, in whichever format it has."""
    stem = Path(file).stem
    for suffix in (".png", ".ppm", ".pgm"):
        if (path := folder / scene / f"{stem}{suffix}").is_file():
            return path
    raise InputError(
        f"{DATA_VARIABLE} is '{folder}', which has no {scene}/{file}",
        f"put Middlebury's {scene} there, or unset {DATA_VARIABLE} to download it",
    )


def _download(scene: str, file: str) -> Path:
    """`file` in the cache, downloaded on first use."""
    cache = platformdirs.user_cache_path("softdepth") / "middlebury" / scene
    pooch.get_logger().setLevel("WARNING")
    try:
        path = pooch.retrieve(
            f"{MIDDLEBURY[scene].url}/{file}",
            known_hash=None,  # the pixels are checked instead
            fname=file,
            path=cache,
            downloader=pooch.HTTPDownloader(timeout=TIMEOUT),  # pyright: ignore[reportArgumentType]
        )
    except (OSError, ValueError) as error:
        raise InputError(
            f"cannot download Middlebury's {scene}/{file}: {type(error).__name__}",
            f"set {DATA_VARIABLE} to a folder that has it, or use dataset {DEFAULT}",
        ) from error
    return Path(path)


def pixel_sum(pixels: np.ndarray) -> str:
    """SHA-256 over shape and values, which no re-encoding changes; a truth's single axis is dropped."""
    pixels = pixels[:, :, 0] if pixels.shape[2] == 1 else pixels
    return hashlib.sha256(repr(pixels.shape).encode() + np.ascontiguousarray(pixels).tobytes()).hexdigest()
