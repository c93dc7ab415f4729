"""PROD (Bobyr et al. 2021, eq. 3)."""

from softdepth.config import Config
from softdepth.hdl.pipeline import Pipeline, Word


class Product:
    """Theta as the product of the memberships; each of the two products is rounded half up.

    A Theta is one multiplier of ``membership_bits + 1`` bits a side: `Config.multipliers` counts them.
    """

    pair_latency = 2
    fire_latency = 2

    def __init__(self, config: Config) -> None:
        self._bits = config.membership_bits

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """``round(b * c / one)``."""
        return pipeline.rounded(pipeline.multiply(b, c), self._bits)

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """``round(a * pair / one)``."""
        return pipeline.rounded(pipeline.multiply(a, pair), self._bits)
