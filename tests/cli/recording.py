"""A recorded sequence of three frames, and what is computed of it."""

from pathlib import Path

from softdepth.golden import fixed_model
from softdepth.golden.data.images import read_pair
from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.writers import write_pfm, write_picture
from softdepth.golden.maps import DisparityMap
from softdepth.spec.config import Config

NAMES = ("f8", "f9", "f10")
"""In the order that people number them."""
SMALL = ("--preset", "sad", "--disparities", 8, "--lanes", 8, "--processes", 1)
CONFIG = Config.preset("sad").override(["disparities=8", "lanes=8", "max_width=48", "max_height=30"])
METRES = ("--focal", 100, "--baseline", 0.1)


def record(folder: Path) -> None:
    """Write three frames into ``left`` and ``right``, and their truth."""
    for name in ("left", "right", "truth"):
        (folder / name).mkdir()
    for seed, name in enumerate(NAMES):
        pair = generate("random", width=48, height=30, disparities=8, seed=seed)
        assert pair.truth is not None
        write_picture(folder / "left" / f"{name}.png", pair.left)
        write_picture(folder / "right" / f"{name}.png", pair.right)
        write_pfm(folder / "truth" / f"{name}.pfm", pair.truth.disparity)


def expected(folder: Path, name: str, config: Config = CONFIG) -> DisparityMap:
    """What the fixed-point model gives for a frame."""
    pair = read_pair(folder / "left" / f"{name}.png", folder / "right" / f"{name}.png")
    return fixed_model.disparity(pair.left, pair.right, config)
