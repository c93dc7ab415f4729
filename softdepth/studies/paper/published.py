"""What the paper prints: Table 2, RMSE in gray levels (Bobyr et al. 2021)."""

from collections.abc import Mapping

from softdepth.spec.config import OPERATORS, Operator

SCENES = ("teddy", "cones", "venus")

SAD: Mapping[str, float] = {"teddy": 47.77, "cones": 51.79, "venus": 50.07}


def _row(*values: float) -> dict[Operator, float]:
    return dict(zip(OPERATORS, values, strict=True))


PROTOTYPE: Mapping[str, Mapping[Operator, float]] = {
    "teddy": _row(44.91, 46.74, 40.98, 41.09, 38.42),
    "cones": _row(50.81, 52.76, 47.12, 39.77, 39.70),
    "venus": _row(46.64, 46.64, 46.05, 45.92, 46.16),
}
"""The rows of "[11]", the method before; the paper does not describe it."""

FMCDM: Mapping[str, Mapping[Operator, float]] = {
    "teddy": _row(38.65, 38.86, 38.09, 37.76, 38.32),
    "cones": _row(32.43, 32.83, 31.89, 31.64, 32.45),
    "venus": _row(41.44, 44.94, 38.80, 39.75, 39.63),
}

OUTLIER = ("venus", "prod")
"""Left out of the mean deviation, shown all the same: 3.5 above the next operator, which no reading gives."""

TITLES: Mapping[str, str] = {
    "min": "MIN",
    "prod": "PROD",
    "mean": "MEAN",
    "soft_min_1": "Soft-min I",
    "soft_min_2": "Soft-min II",
}
"""The operators as the paper names them."""
