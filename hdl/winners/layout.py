"""What travels between the stages behind the winners."""

from amaranth.hdl import Value, unsigned
from amaranth.lib import data

from softdepth.hdl.memory.window import MARKERS
from softdepth.spec.config import CONFIDENCE_BITS

CODE_BITS = 3
"""Bits that hold any `Validity` code."""


def post_layout(value_bits: int, colour_bits: int) -> data.StructLayout:
    """A result on its way: value, `Validity` code, confidence, its pixel's colour, and the markers.

    ``colour`` is what the masked medians compare of the left pixel.
    """
    return data.StructLayout(
        {
            "value": unsigned(value_bits),
            "code": unsigned(CODE_BITS),
            "confidence": unsigned(CONFIDENCE_BITS),
            "colour": unsigned(colour_bits),
            **dict.fromkeys(MARKERS, 1),
        }
    )


def without_markers(layout: data.StructLayout, *left_out: str) -> data.StructLayout:
    """A result's members without the markers and without those ``left_out``."""
    kept = {name: shape for name, shape in layout.members.items() if name not in (*MARKERS, *left_out)}
    return data.StructLayout(kept)


def is_measured(code: Value) -> Value:
    """Whether a code belongs to a measurement: it is below `Validity.BORDER`."""
    return ~code[1:].any()
