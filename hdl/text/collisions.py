"""Tells yosys which memories are never read where they are written in the same clock."""

import re

_READ_PORT = re.compile(
    r"""(  cell \$memrd_v2 [^\n]*\n"""
    r"""    parameter \\MEMID "\\\\(?:slice_\d+(?:_\d+)?|ring)"\n"""
    r"""(?:    parameter [^\n]*\n)*?"""
    r"""    parameter \\COLLISION_X_MASK 1')0\n"""
)


def waive_collisions(rtlil: str) -> str:
    """RTLIL in which collisions do not matter in the slices of `SlicedMemory` and `PackedMemory` and in the
    rings of `Delay`, and in no other memory.

    Amaranth cannot express this, and without it yosys surrounds each block RAM with logic that gives the
    old word to a read that meets a write.
    """
    return _READ_PORT.sub(r"\g<1>1\n", rtlil)
