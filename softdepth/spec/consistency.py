"""What the fields of a configuration must agree on."""

from typing import TYPE_CHECKING

from softdepth.spec.ranges import MULTIPLIER_BITS

if TYPE_CHECKING:
    from softdepth.spec.config import Config


def check(config: "Config") -> None:
    """Raise `ValueError` with a remedy for fields that contradict each other."""
    if config.disparities % config.lanes:
        fits = [n for n in range(1, config.disparities + 1) if config.disparities % n == 0]
        raise ValueError(
            f"lanes is {config.lanes}, which does not divide disparities = {config.disparities}:"
            f" use one of {', '.join(map(str, fits))}"
        )
    count = len(config.criteria)
    if count != 3 and (config.cost == "fuzzy" or not 0 < count < 3):
        takes = "3" if config.cost == "fuzzy" else "1 to 3"
        raise ValueError(f"criteria has {count} entries, but cost = '{config.cost}' takes {takes}")
    if config.multipliers > config.max_multipliers:
        raise ValueError(
            f"operator '{config.operator}' in {config.lanes} lanes takes {config.multipliers} multipliers of"
            f" {MULTIPLIER_BITS} x {MULTIPLIER_BITS} bits, more than max_multipliers ="
            f" {config.max_multipliers}: use fewer lanes, or raise max_multipliers to what the part has"
        )
    for criterion in config.criteria:
        if config.cost == "fuzzy" and criterion.label_bits < config.membership_bits:
            raise ValueError(
                f"membership_bits is {config.membership_bits}, more than label_bits ="
                f" {criterion.label_bits}: memberships are the sum shifted right"
            )
    if config.max_width < config.min_width or config.max_height < config.min_height:
        raise ValueError(
            f"max_width x max_height is {config.max_width} x {config.max_height}, smaller than the"
            f" smallest frame, {config.min_width} x {config.min_height}: raise them, or use smaller windows"
        )
    if config.compensation.reading != "off":
        if config.cost != "fuzzy":
            raise ValueError("compensation acts on fuzzy inputs: use reading = 'off' with cost = 'sum'")
        if config.compensation_criterion is None:
            raise ValueError(
                "compensation looks at the centred 3x3 SAD, which is not among the criteria:"
                " add {kind = 'sad', window = 3, dx = 0}, name another with compensation.criterion, or"
                " use reading = 'off'"
            )
