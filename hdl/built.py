"""Which configurations there is gateware for."""

from softdepth.hdl.costs.comparison import COMPARISONS, by_windows
from softdepth.hdl.costs.lane import CRITERIA
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError


def missing(config: Config) -> tuple[str, ...]:
    """What of a configuration has a model but no gateware, as its keys."""
    known = CRITERIA if by_windows(config) else COMPARISONS
    return tuple(_of_kind(i, c.kind, config) for i, c in enumerate(config.criteria) if c.kind not in known)


def _of_kind(i: int, kind: str, config: Config) -> str:
    found = f"criteria.{i} of kind '{kind}'"
    if kind not in CRITERIA or by_windows(config):
        return found
    return f"{found} where others, or what is behind the winners, need sums down columns"


def check_built(config: Config) -> None:
    """Raise `ConfigError` for a configuration without gateware."""
    if gaps := missing(config):
        raise ConfigError(
            f"'{config.name}' has no gateware: {', '.join(gaps)}",
            "use --engine fixed, or another preset",
        )
