"""The operator `any`: the largest membership. Its statement, and both models."""

import numpy as np

from softdepth.golden.costs.fuzzy.fixed_operators import FIXED
from softdepth.golden.costs.fuzzy.operators import FLOAT
from softdepth.spec.operators import REGISTRY, Operator


def _larger(a: int, b: int) -> int:
    return max(a, b)


REGISTRY.register("any", Operator("ANY", lambda _: _larger, linear=True))
FIXED.register("any", lambda _: np.maximum)
FLOAT.register("any", lambda *_: lambda a, b, c: np.maximum(a, np.maximum(b, c)))
