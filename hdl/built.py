"""Which configurations there is gateware for."""

from collections import Counter

from softdepth.hdl.costs.comparison import COMPARISONS
from softdepth.hdl.costs.lane import CRITERIA
from softdepth.spec.config import Config, Sad
from softdepth.spec.errors import ConfigError


def missing(config: Config) -> tuple[str, ...]:
    """What of a configuration has a model but no gateware, as its keys."""
    return _missing_of_whole(config) if config.whole_frame else _missing_with_band(config)


def _missing_of_whole(config: Config) -> tuple[str, ...]:
    gaps = [
        _of_kind(i, criterion.kind)
        for i, criterion in enumerate(config.criteria)
        if criterion.kind not in COMPARISONS
    ]
    if config.cost == "fuzzy":
        gaps.append("cost = 'fuzzy' of criteria without a border band")
    fields = Counter(
        (c.kind, COMPARISONS[c.kind](c, number).field)
        for number, c in enumerate(config.criteria)
        if c.kind in COMPARISONS
    )
    gaps += [f"more than one criterion of kind '{kind}'" for (kind, _), n in fields.items() if n > 1]
    if config.min_disparity:
        gaps.append("min_disparity of criteria without a border band")
    return tuple(gaps)


def _missing_with_band(config: Config) -> tuple[str, ...]:
    gaps = []
    for i, criterion in enumerate(config.criteria):
        if criterion.whole_frame:
            gaps.append(f"{_of_kind(i, criterion.kind)} beside one with a border band")
        elif criterion.kind not in CRITERIA:
            gaps.append(_of_kind(i, criterion.kind))
        elif isinstance(criterion, Sad) and criterion.source == "gradient":
            gaps.append(f"criteria.{i}.source = 'gradient'")
    if config.cost == "sum" and len(config.criteria) > 1:
        gaps.append(f"a sum of {len(config.criteria)} criteria")
    if config.post.any:
        gaps.append("post behind criteria with a border band")
    return tuple(gaps)


def _of_kind(i: int, kind: str) -> str:
    return f"criteria.{i} of kind '{kind}'"


def check_built(config: Config) -> None:
    """Raise `ConfigError` for a configuration without gateware."""
    if gaps := missing(config):
        raise ConfigError(
            f"'{config.name}' has no gateware: {', '.join(gaps)}",
            "use --engine fixed, or another preset",
        )
