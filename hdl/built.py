"""Which configurations there is gateware for."""

from softdepth.hdl.costs.lane import CRITERIA
from softdepth.spec.config import Census, Config, Gradient, Sad
from softdepth.spec.errors import ConfigError


def missing(config: Config) -> tuple[str, ...]:
    """What of a configuration has a model but no gateware, as its keys."""
    return _missing_of_whole(config) if config.whole_frame else _missing_with_band(config)


def _missing_of_whole(config: Config) -> tuple[str, ...]:
    gaps = [
        _of_kind(i, criterion.kind)
        for i, criterion in enumerate(config.criteria)
        if not isinstance(criterion, Census | Gradient)
    ]
    if config.cost == "fuzzy":
        gaps.append("cost = 'fuzzy' of criteria without a border band")
    if sum(isinstance(criterion, Census) for criterion in config.criteria) > 1:
        gaps.append("more than one criterion of kind 'census'")
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
