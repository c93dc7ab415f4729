"""The paper's five operators on three memberships (eqs. 2 to 6), in floating point."""

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from softdepth.spec.errors import ConfigError
from softdepth.spec.registry import Registry

Array = NDArray[np.float64]
Theta = Callable[[Array, Array, Array], Array]
"""The operator of a rule: the memberships of criteria 1, 2, 3 to its firing strength."""
MAX_STEEPNESS = 500.0
"""The largest |k| of `soft_min_2`: beyond it, exp(-k) times a few leaves double precision's range."""


def minimum(a: Array, b: Array, c: Array) -> Array:
    """MIN (eq. 2) of three operands."""
    return np.minimum(np.minimum(a, b), c)


def product(a: Array, b: Array, c: Array) -> Array:
    """PROD (eq. 3) of three operands."""
    return a * b * c


def mean(a: Array, b: Array, c: Array) -> Array:
    """MEAN (eq. 4), of three operands at once."""
    return (a + b + c) / 3


def soft_min_1(a: Array, b: Array, c: Array, *, delta: float) -> Array:
    """Soft-min I (eq. 5), nested: I(a, I(b, c)). It is slightly negative where operands are 0."""
    return _soft_min_1(a, _soft_min_1(b, c, delta), delta)


def _soft_min_1(a: Array, b: Array, delta: float) -> Array:
    return (a + b + delta**2 - np.sqrt((a - b) ** 2 + delta**2)) / 2


def soft_min_2(a: Array, b: Array, c: Array, *, k: float) -> Array:
    """Soft-min II (eq. 6) over the three operands at once: their mean weighted by exp(-k*a).

    With k > 0 it is a soft minimum; with the printed k = -100, a soft maximum.
    """
    wa, wb, wc = np.exp(-k * a), np.exp(-k * b), np.exp(-k * c)
    return (a * wa + b * wb + c * wc) / (wa + wb + wc)


def operator(name: str, *, delta: float, k: float) -> Theta:
    """The operator called `name`, with its softness bound.

    Raises `ConfigError` for a negative `delta` or a `k` beyond `MAX_STEEPNESS`.
    """
    if not delta >= 0:
        raise ConfigError(f"delta is {delta}, but it is a width", "use 0 or more; the paper has 0.05")
    if not abs(k) <= MAX_STEEPNESS:
        raise ConfigError(f"k is {k}", f"use -{MAX_STEEPNESS:g}..{MAX_STEEPNESS:g}; the paper has -100")
    return FLOAT[name](delta, k)


FLOAT: Registry[Callable[[float, float], Theta]] = Registry("operator in floating point")
"""The operators by name: (delta, k) -> Theta."""

FLOAT.register("min", lambda *_: minimum)
FLOAT.register("prod", lambda *_: product)
FLOAT.register("mean", lambda *_: mean)
FLOAT.register("soft_min_1", lambda delta, _: partial(soft_min_1, delta=delta))
FLOAT.register("soft_min_2", lambda _, k: partial(soft_min_2, k=k))
