"""Seeded pauses of a stream: when a source offers nothing, and when a sink takes nothing."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, Self

import numpy as np

from softdepth.spec.errors import ConfigError

Mode = Literal["none", "random", "bursts"]
BLOCK = 4096


@dataclass(frozen=True)
class Pauses:
    """When one side of a stream pauses; a pure function of these fields.

    Members
    -------
    mode : ``none``; ``random``: each clock by itself; ``bursts``: runs of 1 to ``2 * burst - 1`` clocks.
    probability : share of clocks paused, 0 to below 1; unused with ``none``.
    burst : mean length of a paused run, in clocks.
    initial : clocks paused at the start, whatever the mode.
    seed : of the random generator.
    """

    mode: Mode = "none"
    probability: float = 0.5
    burst: int = 64
    initial: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        if not 0 <= self.probability < 1:
            raise ConfigError(f"stall probability is {self.probability}", "use 0 to below 1")
        if self.burst < 1 or self.initial < 0:
            raise ConfigError(
                f"stall burst is {self.burst} and initial is {self.initial}", "use at least 1 and at least 0"
            )

    def clocks(self) -> Iterator[bool]:
        """For each clock in turn, without end: is it paused?"""
        yield from (True for _ in range(self.initial))
        generator = np.random.default_rng(self.seed)
        while True:
            if self.mode == "random":
                yield from (generator.random(BLOCK) < self.probability).tolist()
            elif self.mode == "bursts" and self.probability > 0:
                free = self.burst * (1 - self.probability) / self.probability
                yield from (False for _ in range(round(generator.exponential(free))))
                yield from (True for _ in range(generator.integers(1, 2 * self.burst)))
            else:
                yield from (False for _ in range(BLOCK))


@dataclass(frozen=True)
class Stalls:
    """Pauses of the core's input, where the source has nothing to offer, and of its output."""

    input: Pauses = Pauses()
    output: Pauses = Pauses()

    @classmethod
    def random(cls, probability: float, seed: int) -> Self:
        """Both sides pause at random, independently."""
        return cls(
            Pauses("random", probability=probability, seed=2 * seed),
            Pauses("random", probability=probability, seed=2 * seed + 1),
        )

    @classmethod
    def bursts(cls, probability: float, seed: int, burst: int = 64) -> Self:
        """Both sides pause for long runs, independently."""
        return cls(
            Pauses("bursts", probability=probability, burst=burst, seed=2 * seed),
            Pauses("bursts", probability=probability, burst=burst, seed=2 * seed + 1),
        )
