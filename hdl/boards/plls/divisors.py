"""What all PLLs share: exact ratios of two clocks, and the first setting that makes one."""

from collections.abc import Iterator
from typing import NamedTuple

from softdepth.spec.errors import ConfigError

MHZ = 1_000_000


class Divisors(NamedTuple):
    """``out = in / reference * feedback``, and the divisor of the oscillator at ``in / reference * vco``."""

    reference: int
    feedback: int
    output: int


def ratios(clock_hz: int, core_hz: int, references: int, feedbacks: int) -> Iterator[tuple[int, int]]:
    """Exact pairs, the fastest phase detector first."""
    for reference in range(1, references + 1):
        feedback, rest = divmod(core_hz * reference, clock_hz)
        if not rest and 1 <= feedback <= feedbacks:
            yield reference, feedback


def first(name: str, found: Iterator[Divisors], clock_hz: int, core_hz: int) -> Divisors:
    """The setting with the fastest phase detector, which has the least jitter; `ConfigError` if none."""
    for divisors in found:
        return divisors
    raise ConfigError(
        f"the PLL {name} cannot make {core_hz / MHZ:g} MHz from the oscillator's {clock_hz / MHZ:g} MHz",
        "choose another clock for the core, for example the oscillator's",
    )
