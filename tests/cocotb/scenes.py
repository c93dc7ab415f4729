"""Images and configurations of the regression, all from fixed seeds."""

from typing import Any

import numpy as np

from softdepth.golden.front.pair import Image
from softdepth.sim.frames import Pair
from softdepth.spec.config import OPERATORS, Config

SEEDS = range(24)
"""One random configuration each."""


def textured(height: int, width: int, seed: int) -> Pair:
    """A random pair with true matches in it, and sums of every size.

    The contrast of the noise between the views differs from pixel to pixel and from scene to scene, so
    that the criteria visit all labels instead of saturating.
    """
    rng = np.random.default_rng(seed)
    contrast = int(rng.integers(8, 256))
    left = rng.integers(0, contrast, (height, width, 3)).astype(np.uint8)
    right = np.roll(left, -int(rng.integers(0, 5)), axis=1).astype(int)
    right += (rng.normal(size=left.shape) * rng.uniform(0, contrast / 4, (height, width, 1))).astype(int)
    return left, right.clip(0, 255).astype(np.uint8)


def noise(height: int, width: int, seed: int) -> Pair:
    """Two independent images: no candidate is clearly right, so that every detail of a cost decides."""
    rng = np.random.default_rng(seed)
    contrast = int(rng.integers(16, 160))
    left, right = rng.integers(0, contrast, (2, height, width, 3)).astype(np.uint8)
    return left, right


def flat(height: int, width: int, value: int) -> Pair:
    """A pair of one gray: every candidate costs the same."""
    image: Image = np.full((height, width, 3), value, np.uint8)
    return image, image.copy()


def checkerboard(height: int, width: int) -> Pair:
    """Black and white against its inverse: sums are as large as they can be, or zero."""
    board = (np.indices((height, width)).sum(axis=0) % 2 * 255).astype(np.uint8)
    left = np.repeat(board[:, :, None], 3, axis=2)
    return left, 255 - left


def frames_for(config: Config, seed: int) -> list[Pair]:
    """Frames of every awkward size: smallest, odd, one over a power of two, equal neighbours, too low."""
    w, h = config.min_width, config.min_height
    power = 1 << (w + config.disparities // 2).bit_length()
    colour = [
        textured(h, w, seed),
        textured(h + 4, power + 1, seed + 1),
        noise(h + 4, power + 1, seed + 2),
        flat(h + 1, w + 3, 0),
        checkerboard(h + 2, power - 1),
        flat(h, w + 1, 255),
        textured(max(h - 2, 1), w + 2, seed + 3),
        noise(h + 10, min(config.max_width, power + config.disparities), seed + 4),
        noise(h + 3, min(config.max_width, 2 * power), seed + 5),
    ]
    if config.pixel.channels == 3:
        return colour
    return [(left[..., 1].copy(), right[..., 1].copy()) for left, right in colour]


def random_config(seed: int) -> Config:
    """A configuration drawn at random from everything that has gateware."""
    rng = np.random.default_rng(seed)

    def pick(options: list) -> Any:
        return options[int(rng.integers(len(options)))]

    disparities = int(pick([2, 3, 5, 6, 8, 12, 16]))
    fuzzy = bool(rng.random() < 0.8)
    criteria = [
        {
            "window": int(pick([1, 3, 5, 7] if rng.random() < 0.8 else [9])),
            "dx": int(rng.integers(-3, 4)) if rng.random() < 0.5 else 0,
            "label_bits": int(rng.integers(8, 15)),
        }
        for _ in range(3 if fuzzy else 1)
    ]
    criteria[0]["window"] = max(criteria[0]["window"], 3)  # the support has more than one row
    reading = pick(["off", "top", "literal"]) if fuzzy else "off"
    judged = int(rng.integers(4))
    if reading != "off" and judged == 0:
        criteria[int(rng.integers(3))] = {"window": 3, "dx": 0, "label_bits": 12}
    config = Config.from_dict(
        {
            "name": f"random-{seed}",
            "disparities": disparities,
            # Few lanes build fast; `test_lanes` has many.
            "lanes": pick([n for n in range(1, 5) if disparities % n == 0]),
            "max_width": int(rng.integers(64, 200)),
            "max_height": 100,
            "reference": pick(["left", "right"]),
            "cost": "fuzzy" if fuzzy else "sad",
            "operator": pick(sorted(OPERATORS)),
            "firing": pick(["all", "cell"]),
            "rules": pick(["printed", "corrected"]),
            "membership_bits": int(rng.integers(3, 9)),
            "softness": float(rng.choice([0.05, 0.05, 0.4])),
            "sharpness": float(rng.choice([-100.0, 20.0])),
            "max_multipliers": 1000,
            "criteria": criteria,
            "compensation": {
                "reading": reading,
                "threshold": int(rng.integers(0, 3000)),
                "from_disparity": int(rng.integers(0, disparities + 1)),
                "criterion": judged,
            },
        }
    )
    # Any number of rows, and often none or all of them.
    most = 2 * config.reach_rows
    stored = pick([0, int(rng.integers(most + 1)), most])
    return config.override([f"stored_rows={stored}"])


def of_pixels(pair: Pair, config: Config, seed: int) -> Pair:
    """A pair of 8-bit colours in the pixels of `config`; further bits are noise."""
    rng = np.random.default_rng(seed)
    left, right = pair if config.pixel.channels == 3 else (pair[0][..., 1].copy(), pair[1][..., 1].copy())
    more = config.pixel.bits - 8
    if not more:
        return left, right
    noisy = [(v.astype(np.uint16) << more) + rng.integers(0, 1 << more, v.shape) for v in (left, right)]
    return noisy[0].astype(np.uint16), noisy[1].astype(np.uint16)


def whole_frames_for(config: Config, seed: int) -> list[Pair]:
    """Frames of every awkward size for what is summed down columns: of one row, the narrowest, the widest."""
    low, high = config.min_width, config.max_width
    pairs = [
        textured(14, min(low + 29, high), 1),
        noise(6, min(low + 16, high), 2),
        textured(3, low, 3),
        textured(1, low + 1, 4),
        textured(9, min(low + 8, high), 5),
        flat(3, min(low + 5, high), 77),
        noise(12, high, seed),
        textured(20, min(low + 22 + seed, high), seed),
    ]
    return [of_pixels(pair, config, seed) for pair in pairs]


def _windows(seed: int) -> dict[str, int]:
    """Of the island test and the masked medians; not too small for any island test."""
    rng = np.random.default_rng([seed, 1])
    rows, columns = rng.choice([(5, 5), (3, 9), (1, 9), (3, 5), (3, 3)])
    return {
        "island_rows": int(rows),
        "island_columns": int(columns),
        "masked_spacing": int(rng.integers(1, 5)),
        "masked_rows": int(rng.choice([1, 3, 15])),
        "colour_bits": int(rng.choice([1, 4, 6, 12])),
    }


def random_whole_config(seed: int) -> Config:
    """A configuration summed down columns, drawn at random from everything that there is.

    Costs, criteria, pixels and first candidates take turns, so that a few seeds in a row have all of them.
    """
    rng = np.random.default_rng(seed)

    def pick(options: list) -> Any:
        return options[int(rng.integers(len(options)))]

    def label_bits() -> int:
        return int(rng.integers(7, 13))

    def census() -> dict[str, Any]:
        return {
            "kind": "census",
            "rows": pick([1, 3, 5, 9]),
            "taps": pick([1, 3, 5, 7]),
            "spacing": pick([1, 2, 4]),
            "like": pick([20, 32, 100, 256]),
            "neutral": int(rng.integers(25)),
            "running_sums": pick([True, False]),
            "label_bits": label_bits(),
        }

    def gradient() -> dict[str, Any]:
        truncation = int(rng.integers(1, 70))
        return {
            "kind": "gradient",
            "rows": pick([1, 3, 5, 9]),
            "columns": pick([1, 3, 5, 9]),
            "cap": pick([7, 31, 60]),
            "truncation": truncation,
            "neutral": int(rng.integers(truncation + 1)),
            "running_sums": pick([True, False]),
            "label_bits": label_bits(),
        }

    def sad() -> dict[str, Any]:
        return {
            "window": pick([3, 5, 7]),
            "dx": pick([0, 0, -2, 3]),
            "source": pick(["colour", "gradient"]),
            "label_bits": label_bits(),
        }

    disparities = int(pick([2, 3, 5, 6, 8, 12]))
    fuzzy = seed % 2 == 1
    kinds = [
        [census, gradient, gradient],
        [census, gradient, sad],
        [sad, gradient],
        [sad, sad, sad],
        [census],
        [census, census, gradient],
    ][seed % 6]
    criteria = [kind() for kind in (kinds if fuzzy or rng.random() < 0.7 else kinds[:1])]
    check = bool(rng.random() < 0.8)
    return Config.from_dict(
        {
            "name": f"random-whole-{seed}",
            "cost": "fuzzy" if fuzzy else "sum",
            "operator": sorted(OPERATORS)[seed // 2 % len(OPERATORS)],
            "firing": pick(["all", "cell"]),
            "rules": pick(["printed", "corrected"]),
            "membership_bits": int(rng.integers(3, 8)),
            "max_multipliers": 1000,
            "disparities": disparities,
            "min_disparity": (0, 0, 4, -3)[seed % 4],
            "lanes": pick([n for n in range(1, 5) if disparities % n == 0]),
            "max_width": int(rng.integers(64, 120)),
            "max_height": 100,
            "pixel": ("rgb8", "gray8", "gray12", "rgb8", "gray10")[seed % 5],
            "reference": pick(["left", "right"]),
            "criteria": criteria,
            "compensation": {
                "reading": pick(["off", "top", "literal"]) if fuzzy else "off",
                "threshold": int(rng.integers(0, 300)),
                "from_disparity": int(rng.integers(0, disparities + 1)),
                "criterion": 1,
            },
            "post": {
                "check": check,
                "tolerance": int(rng.integers(3)) if check else 0,
                "island": pick([0, 5, 8]),
                "fraction_bits": pick([0, 4]),
                "fill": pick([False, True]),
                "median": pick([0, 5]),
                "masked_median": pick([0, 2, 9]),
                **_windows(seed),
                "like": pick([16, 32, 40]),
                "confidence": pick([False, True]),
            },
        }
    )
