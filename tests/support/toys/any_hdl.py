"""The operator `any` in gateware."""

from softdepth.hdl.arithmetic.pipeline import Pipeline, Word
from softdepth.hdl.costs.fuzzy.operators import OPERATORS
from softdepth.spec.config import Config


class Any:
    """Theta as the largest of the three memberships."""

    pair_latency = 1
    fire_latency = 1

    def __init__(self, config: Config) -> None:
        """Nothing to configure."""

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """``max(b, c)``."""
        return pipeline.max(b, c)

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """``max(a, pair)``."""
        return pipeline.max(a, pair)


OPERATORS.register("any", Any)
