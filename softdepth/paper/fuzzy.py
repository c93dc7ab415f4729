"""The float model's inference on criteria that no configuration has: the prototype's, and Fig. 4's."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from softdepth.config import Config, Operator
from softdepth.golden.float_model import memberships
from softdepth.golden.inference import conclusions
from softdepth.golden.operators import operator
from softdepth.rules import weight

Array = NDArray[np.float64]


def cost(criteria: Sequence[NDArray[np.generic]], name: Operator, label: float) -> Array:
    """Eqs. 9, table 1 and 10: the cost of three criteria, arrays of one shape.

    The softness of the operators is the default configuration's, the rule base the printed one.
    """
    fields = Config.model_fields
    theta = operator(name, delta=fields["softness"].default, k=fields["sharpness"].default)
    numerator, denominator = np.zeros(criteria[0].shape), np.zeros(criteria[0].shape)
    for k, y_k in conclusions([memberships(s, label) for s in criteria], theta, "printed"):
        numerator += y_k * weight(k)
        denominator += y_k
    return np.divide(numerator, denominator, out=np.full_like(numerator, np.inf), where=denominator > 0)
