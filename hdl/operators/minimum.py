"""MIN (Bobyr et al. 2021, eq. 2)."""

from softdepth.config import Config
from softdepth.hdl.pipeline import Pipeline, Word


class Minimum:
    """Theta as the smallest of the three memberships."""

    pair_latency = 1
    fire_latency = 1

    def __init__(self, config: Config) -> None:
        """Nothing to configure."""

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """``min(b, c)``."""
        return pipeline.min(b, c)

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """``min(a, pair)``."""
        return pipeline.min(a, pair)
