"""The fuzzy AND of a rule, Theta: one small unit per operator, all used by the same rule array."""

from typing import Protocol

from softdepth.config import Config
from softdepth.errors import ConfigError
from softdepth.hdl.operators.mean import Mean
from softdepth.hdl.operators.minimum import Minimum
from softdepth.hdl.pipeline import Pipeline, Word


class Operator(Protocol):
    """Theta in two halves, so that rules that share criteria 2 and 3 share the first.

    Both halves are monotone in every operand; the rule array relies on it. An operator that is not
    built from two equal halves (a mean) may give them different scales.
    """

    pair_latency: int
    """Clocks of `pair`."""
    fire_latency: int
    """Clocks of `fire`."""

    def maximum(self, one: int) -> int:
        """The largest firing strength, where memberships reach ``one``."""
        ...

    def pair(self, pipeline: Pipeline, b: Word, c: Word) -> Word:
        """The half that joins the memberships of criteria 2 and 3."""
        ...

    def fire(self, pipeline: Pipeline, a: Word, pair: Word) -> Word:
        """The firing strength: criterion 1's membership joined with a pair."""
        ...


OPERATORS: dict[str, type[Operator]] = {"min": Minimum, "mean": Mean}


def operator(config: Config) -> Operator:
    """The configured operator; raises `ConfigError` for one that has no gateware."""
    if config.operator not in OPERATORS:
        raise ConfigError(
            f"operator '{config.operator}' has no gateware",
            f"use one of {', '.join(OPERATORS)}, or the float model",
        )
    return OPERATORS[config.operator]()
