"""MEAN (Bobyr et al. 2021, eq. 4, of three operands)."""

from softdepth.hdl.arithmetic.pipeline import Pipeline
from softdepth.hdl.arithmetic.word import Word
from softdepth.spec.config import Config


class Mean:
    """Theta as the mean of the three memberships, times three: the third cancels in the ratio N/S."""

    pair_operations = 1
    fire_operations = 1

    def __init__(self, config: Config) -> None:
        """Nothing to configure."""

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """``b + c``."""
        return b + c

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """``a + pair``."""
        return a + pair
