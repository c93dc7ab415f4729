"""The fixed-point model in every number format worth considering, against the float model."""

from typing import TYPE_CHECKING

from pydantic import BaseModel

from softdepth import screen
from softdepth.run.report import Accuracy, accuracy
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError
from softdepth.studies.compare.agreement import Agreement, agreement

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.golden.maps import DisparityMap

MEMBERSHIP_BITS = range(4, 13)
LABEL_BITS = range(9, 15)
TOLERANCE = 0.5
"""Percentage points of bad pixels (off by more than 1 px) that a narrow format may cost."""


class Label(BaseModel):
    """The float model with the label ``T = 2**label_bits``: what the label alone changes.

    Members
    -------
    to_float : its difference from the float model with the paper's label.
    accuracy : its scores against the truth.
    enough : the fewest membership bits with this label from which on `bad1` exceeds that of the float
        model with the paper's label by at most `TOLERANCE`; None without truth, or where none do.
    """

    label_bits: int
    to_float: Agreement
    accuracy: Accuracy
    enough: int | None = None


class Point(BaseModel):
    """The fixed-point model in one number format.

    Members
    -------
    to_float : its difference from the float model with the paper's label: label and width together.
    to_same_label : its difference from the float model with the same label: the width alone.
    accuracy : its scores against the truth.
    """

    membership_bits: int
    label_bits: int
    to_float: Agreement
    to_same_label: Agreement
    accuracy: Accuracy


class Sweep(BaseModel):
    """All formats of a sweep, by label first."""

    labels: list[Label]
    points: list[Point]

    @property
    def label_bits(self) -> list[int]:
        """The labels that were tried."""
        return [label.label_bits for label in self.labels]

    @property
    def membership_bits(self) -> list[int]:
        """The widths that were tried with any label."""
        return sorted({point.membership_bits for point in self.points})

    def point(self, membership_bits: int, label_bits: int) -> Point | None:
        """The point of a format, or None where it has none: a label has at least a membership's bits."""
        wanted = (membership_bits, label_bits)
        return next((p for p in self.points if (p.membership_bits, p.label_bits) == wanted), None)


def check_sweepable(config: Config) -> None:
    """Raise `ConfigError` for a configuration without memberships."""
    if config.cost != "fuzzy":
        raise ConfigError(
            f"cost is '{config.cost}', which has no memberships to compare the widths of",
            "use a configuration with cost = 'fuzzy', for example --preset paper",
        )


def formats(config: Config) -> list[Config]:
    """`config` with every label and every membership width that fits it; all criteria share the label.

    These are modelled, not built: they have one lane, and whatever multipliers that takes.
    """
    return [
        config.override(
            [
                *("lanes=1", "max_multipliers=1000"),
                f"membership_bits={bits}",
                *(f"criteria.{i}.label_bits={label}" for i in range(len(config.criteria))),
            ]
        )
        for label in LABEL_BITS
        for bits in MEMBERSHIP_BITS
        if bits <= label
    ]


def sweep(pair: "StereoPair", config: Config, paper: "DisparityMap") -> Sweep:
    """Run every format of `formats`, showing progress.

    Parameters
    ----------
    paper : the map of the float model with the paper's label.

    Raises `InputError` for images without a result.
    """
    from softdepth.golden import fixed_model, float_model

    choices = formats(config)
    labels: dict[int, DisparityMap] = {}
    found = Sweep(labels=[], points=[])
    pixels = pair.width * pair.height
    with screen.progress(f"{len(choices)} number formats", pixels * len(choices)) as advance:
        for done, choice in enumerate(choices, start=1):
            bits = choice.criteria[0].label_bits
            if bits not in labels:
                labels[bits] = float_model.disparity(pair.left, pair.right, config, label=2.0**bits)
                found.labels.append(
                    Label(
                        label_bits=bits,
                        to_float=agreement(labels[bits], paper, pair.truth),
                        accuracy=accuracy(labels[bits], pair.truth),
                    )
                )
            result = fixed_model.disparity(pair.left, pair.right, choice)
            found.points.append(
                Point(
                    membership_bits=choice.membership_bits,
                    label_bits=bits,
                    to_float=agreement(result, paper, pair.truth),
                    to_same_label=agreement(result, labels[bits], pair.truth),
                    accuracy=accuracy(result, pair.truth),
                )
            )
            advance(done * pixels)
    for label in found.labels:
        label.enough = enough(found, label.label_bits, accuracy(paper, pair.truth).bad1)
    return found


def enough(found: Sweep, label_bits: int, bad1: float | None) -> int | None:
    """The fewest membership bits from which on no format is `TOLERANCE` worse than `bad1`."""
    narrowest = None
    if bad1 is not None:
        for bits in reversed(found.membership_bits):
            if (point := found.point(bits, label_bits)) is None:
                continue
            if point.accuracy.bad1 is None or point.accuracy.bad1 > bad1 + TOLERANCE:
                break
            narrowest = bits
    return narrowest
