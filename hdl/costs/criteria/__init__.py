"""What candidates are judged by: a component for each kind of criterion."""

from collections.abc import Iterable

from amaranth.lib import data


def criteria_layout(maxima: Iterable[int]) -> data.StructLayout:
    """The values of a candidate's criteria, ``s0`` onwards, each up to its maximum."""
    return data.StructLayout({f"s{i}": range(maximum + 1) for i, maximum in enumerate(maxima)})
