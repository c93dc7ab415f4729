"""Which configurations there is gateware for."""

from softdepth.hdl.costs.lane import CRITERIA
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError


def missing(config: Config) -> tuple[str, ...]:
    """What of a configuration has a model but no gateware, as its keys."""
    gaps = [
        f"criteria.{i} of kind '{criterion.kind}'"
        for i, criterion in enumerate(config.criteria)
        if criterion.kind not in CRITERIA
    ]
    gaps += [
        f"criteria.{i}.source = 'gradient'"
        for i, criterion in enumerate(config.sads)
        if criterion.source == "gradient"
    ]
    if config.cost == "sum" and len(config.criteria) > 1:
        gaps.append(f"a sum of {len(config.criteria)} criteria")
    if config.min_disparity and config.whole_frame:
        gaps.append("min_disparity of criteria without a border band")
    if config.post.any:
        gaps.append("post")
    return tuple(gaps)


def check_built(config: Config) -> None:
    """Raise `ConfigError` for a configuration without gateware."""
    if gaps := missing(config):
        raise ConfigError(
            f"'{config.name}' has no gateware: {', '.join(gaps)}",
            "use --engine fixed, or another preset",
        )
