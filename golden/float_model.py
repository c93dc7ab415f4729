"""The paper's method in floating point (Bobyr et al. 2021), with the core's border rule."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from softdepth.golden.costs.candidates import band
from softdepth.golden.costs.criteria import Values, compensate
from softdepth.golden.costs.fuzzy.inference import conclusions
from softdepth.golden.costs.fuzzy.operators import operator
from softdepth.golden.front.borders import validity_codes
from softdepth.golden.front.overlap import first_column, from_zero, overlap
from softdepth.golden.front.pair import Image, check_pair, check_pixel
from softdepth.golden.front.views import column_in_core_view, to_core_view
from softdepth.golden.maps import DisparityMap
from softdepth.golden.post.maps import stage_maps
from softdepth.golden.winners.cost import Comparison, less
from softdepth.golden.winners.frame import winners
from softdepth.spec.config import LITERAL_INPUT, QUOTIENT_BITS, Config, Sad
from softdepth.spec.errors import ConfigError
from softdepth.spec.rules import CONCLUSIONS, weight
from softdepth.spec.validity import Validity

Array = NDArray[np.float64]


def disparity(
    left: Image,
    right: Image,
    config: Config,
    *,
    label: float = 5000.0,
    delta: float | None = None,
    k: float | None = None,
) -> DisparityMap:
    """Disparity of every pixel: ``argmin over d of cost(d)`` (eq. 11), the smallest d on a tie.

    Parameters
    ----------
    left, right : rectified pair of one shape, `front.pair.Image`.
    config : the method. Its number formats (`label_bits`, `membership_bits`) do not apply here.
    label : T, the middle label of the memberships (eq. 9) of colour SADs; other criteria, which the paper
        does not have, have theirs at ``2**label_bits``.
    delta, k : softness of `soft_min_1` (eq. 5) and `soft_min_2` (eq. 6); by default the configuration's.

    Post-processing is the fixed model's, of these winners.

    Costs that are equal in exact arithmetic may differ in the last bit here, so a tie can go unnoticed. The
    fixed model is exact.

    Raises `InputError` for unusable images and `ConfigError` for parameters outside their range.
    """
    check_pair(left, right, config.pixel)
    inner = from_zero(config)
    cost = _cost_function(inner, label, delta, k)
    reference, other = overlap(*to_core_view(left, right, config), config)
    found = winners(
        reference,
        other,
        inner,
        lambda d, criteria: (cost(d, criteria),),
        # In the fixed model's units, for the margins.
        Comparison(less, lambda c: c[0] if config.cost == "sum" else c[0] * 2.0**QUOTIENT_BITS, np.inf),
    )
    return list(stage_maps(config, found, reference, left.shape[1]).values())[-1]


def costs(
    left: Image,
    right: Image,
    config: Config,
    x: int,
    y: int,
    *,
    label: float = 5000.0,
    delta: float | None = None,
    k: float | None = None,
) -> Array:
    """The cost curve of one pixel of the reference view: `disparities` costs, inf where excluded.

    Parameters and errors as in `disparity`; `InputError` also for a pixel outside the image. In the
    border every candidate is excluded.
    """
    check_pair(left, right, config.pixel)
    check_pixel(left, x, y)
    x = column_in_core_view(x, left.shape[1], config) - first_column(config)
    reference, other = overlap(*to_core_view(left, right, config), config)
    height, width, _ = reference.shape
    config = from_zero(config)
    cost = _cost_function(config, label, delta, k)
    curve = np.full(config.disparities, np.inf)
    if 0 <= x < width and validity_codes(height, width, config)[y, x] < Validity.BORDER:
        column = x - config.reach_left
        for d, criteria in band(reference, other, config, y, y + 1).candidates():
            if d <= column:
                curve[d] = cost(d, criteria)[0, column - d]
    return curve


def memberships(s: NDArray[np.generic], label: float) -> tuple[Array, Array, Array]:
    """Eq. 9: low, middle and high membership of dissimilarity `s`, labels at 0, T and 2T.

    Beyond 2T, where the printed formulas leave 0..1, `s` saturates.
    """
    t = np.minimum(s, 2 * label) / label
    return np.maximum(1 - t, 0), 1 - np.abs(t - 1), np.maximum(t - 1, 0)


def _cost_function(
    config: Config, label: float, delta: float | None, k: float | None
) -> Callable[[int, list[Values]], Array]:
    """The function from a candidate and its criteria to its cost (eq. 10)."""
    if not 0 < label < np.inf:
        raise ConfigError(f"label is {label}", "use a positive number; the paper has 5000")
    theta = operator(
        config.operator,
        delta=config.softness if delta is None else delta,
        k=config.sharpness if k is None else k,
    )
    labels = [
        label if isinstance(c, Sad) and c.source == "colour" else 2.0**c.label_bits for c in config.criteria
    ]
    literal = config.compensation.reading == "literal"
    replacement = [LITERAL_INPUT if literal else int(2 * at) for at in labels]

    def fuzzy(d: int, criteria: list[Values]) -> Array:
        s = compensate(config, d, criteria, replacement)
        numerator, denominator = np.zeros(s[0].shape), np.zeros(s[0].shape)
        degrees = [memberships(s_i, at) for s_i, at in zip(s, labels, strict=True)]
        for index, y_k in conclusions(degrees, theta, config.rules, config.firing):
            numerator += y_k * (weight(index) - weight(CONCLUSIONS))
            denominator += y_k
        # A sum of zero or below judges nothing: the candidate loses against any other.
        return np.divide(numerator, denominator, out=np.full(s[0].shape, np.inf), where=denominator > 0)

    def total(d: int, criteria: list[Values]) -> Array:
        return sum(criteria[1:], start=criteria[0]).astype(np.float64)

    return total if config.cost == "sum" else fuzzy
