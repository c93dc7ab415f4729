"""How far the gateware's operators are from the paper's formulas, over every possible input."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from softdepth.golden import fixed_model
from softdepth.golden.costs.fuzzy import operators
from softdepth.golden.costs.fuzzy.fixed_operators import pair_operator
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError
from softdepth.spec.operators import REGISTRY

Array = NDArray[np.float64]
Reference = Literal["at once", "nested"]
"""The formula's form: the float model's own, or that of two operands nested as the gateware nests it."""

MAX_BITS = 8
"""The widest memberships: 257**3 combinations take seconds, and one bit more takes eight times that."""


@dataclass(frozen=True)
class OperatorError:
    """The difference between an operator in integers and in floating point, over all its inputs.

    Members
    -------
    worst : the largest difference, in memberships (1.0 is full).
    inputs : where it is: the integers a, b, c, ``0 .. one`` each; the first such in that order.
    mean, rms : of the difference's absolute value, over all combinations.
    steps : `worst` in units of the fixed-point step ``1 / one``.
    """

    worst: float
    inputs: tuple[int, int, int]
    mean: float
    rms: float
    steps: float


def operator_error(config: Config, reference: Reference = "at once") -> OperatorError:
    """Compare ``Theta(a, b, c)`` of both models for all a, b, c in ``0 .. one``.

    Parameters
    ----------
    config : the operator, its softness or sharpness, and the membership bits.
    reference : the float formula to compare with. ``at once`` is the float model's, of three operands.
        ``nested`` is Theta(a, Theta(b, c)), which differs from it for `soft_min_2` alone (eq. 6 with
        three weights is not eq. 6 twice).

    Raises `ConfigError` for memberships of more than `MAX_BITS` bits.
    """
    if config.membership_bits > MAX_BITS:
        raise ConfigError(
            f"membership_bits is {config.membership_bits}: too many combinations to try them all",
            f"use at most {MAX_BITS}",
        )
    one = config.one
    fixed, scale = pair_operator(config), one * REGISTRY[config.operator].scale
    formula = _nested(config) if reference == "nested" else _at_once(config)
    levels = levels_of(config)
    b, c = np.meshgrid(levels, levels, indexing="ij")
    pairs = fixed(b, c)
    worst, inputs, absolute, squares = -1.0, (0, 0, 0), 0.0, 0.0
    for a in levels:
        strength = fixed(np.full_like(b, a), pairs) / scale
        error = np.abs(strength - formula(np.float64(a / one), levels[:, None] / one, levels[None, :] / one))
        error = np.round(error, 12)  # else the last bits of equal errors would choose among them
        absolute += error.sum()
        squares += (error**2).sum()
        if error.max() > worst:
            worst = float(error.max())
            row, column = divmod(int(error.argmax()), len(levels))
            inputs = (int(a), row, column)
    count = len(levels) ** 3
    return OperatorError(worst, inputs, float(absolute / count), float(np.sqrt(squares / count)), worst * one)


def levels_of(config: Config) -> NDArray[Any]:
    """0 .. one, as the fixed model's memberships come: made by it, in its type."""
    criterion = config.criteria[0]
    shift = criterion.label_bits - config.membership_bits
    low, _, _ = fixed_model.memberships(
        criterion, np.arange(config.one + 1, dtype=np.int32)[::-1] << shift, config
    )
    return low


def _at_once(config: Config) -> Callable[..., Array]:
    """The operator of the float model."""
    return operators.operator(config.operator, delta=config.softness, k=config.sharpness)


def _nested(config: Config) -> Callable[..., Array]:
    """Theta(a, Theta(b, c)) in floating point, of eq. 6 with two operands; the others nest by themselves."""
    if config.operator != "soft_min_2":
        return _at_once(config)

    def pair(a: Array, b: Array) -> Array:
        wa, wb = np.exp(-config.sharpness * a), np.exp(-config.sharpness * b)
        return (a * wa + b * wb) / (wa + wb)

    return lambda a, b, c: pair(a, pair(b, c))
