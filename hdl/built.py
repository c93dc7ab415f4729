"""Which configurations there is gateware for."""

from softdepth.spec.config import Census, Config
from softdepth.spec.errors import ConfigError


def missing(config: Config) -> tuple[str, ...]:
    """What of a configuration has a model but no gateware, as its keys."""
    return _missing_of_whole(config) if config.whole_frame else _missing_of_sads(config)


def _missing_of_whole(config: Config) -> tuple[str, ...]:
    gaps = []
    if config.cost == "fuzzy":
        gaps.append("cost = 'fuzzy' of criteria without a border band")
    if sum(isinstance(criterion, Census) for criterion in config.criteria) > 1:
        gaps.append("more than one criterion of kind 'census'")
    if config.min_disparity:
        gaps.append("min_disparity of criteria without a border band")
    return tuple(gaps)


def _missing_of_sads(config: Config) -> tuple[str, ...]:
    gaps = [
        f"criteria.{i} of kind '{criterion.kind}' beside one of kind 'sad'"
        for i, criterion in enumerate(config.criteria)
        if criterion.whole_frame
    ]
    gaps += [
        f"criteria.{i}.source = 'gradient'"
        for i, criterion in enumerate(config.sads)
        if criterion.source == "gradient"
    ]
    if config.cost == "sum" and len(config.criteria) > 1:
        gaps.append(f"a sum of {len(config.criteria)} criteria")
    if config.post.any:
        gaps.append("post behind criteria of kind 'sad'")
    return tuple(gaps)


def check_built(config: Config) -> None:
    """Raise `ConfigError` for a configuration without gateware."""
    if gaps := missing(config):
        raise ConfigError(
            f"'{config.name}' has no gateware: {', '.join(gaps)}",
            "use --engine fixed, or another preset",
        )
