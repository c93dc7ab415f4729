"""Memories in RTLIL and in Verilog text: their initial words, and what a read gets in a collision."""

import re
from collections.abc import Iterator

_CLEARED = re.compile(
    r"  cell \$meminit_v2 [^\n]*\n(?:    [^\n]*\n)*?    connect \\DATA \d+'0+\n(?:    [^\n]*\n)*?  end\n"
)
_MODULE = re.compile(r"^module .*?^endmodule$", re.MULTILINE | re.DOTALL)
_MEMORY = re.compile(r"^  reg (?:\[(\d+):0\] )?(\w+) \[(\d+):0\];$", re.MULTILINE)
_READ = re.compile(r"^  reg (?:\[(\d+):0\] )?(\w+);$", re.MULTILINE)
_NEVER_MET = re.compile(r"^  (reg (?:\[\d+:0\] )?(?:slice_\d+(?:_\d+)?|ring) \[\d+:0\];)$", re.MULTILINE)


def without_zeros(rtlil: str) -> str:
    """RTLIL of the same design, without initial words for memories that start as all 0.

    Other memories keep theirs. Nothing that the core gives depends on what its memories hold at first, and
    readers of Verilog take minutes and gigabytes for a million words that are set one by one.
    """
    return _CLEARED.sub("", rtlil)


def ready_to_simulate(verilog: str) -> str:
    """Verilog text in which memories, and registers that read them, start at 0, but only in simulators.

    A simulator would start from X, which some wires show though no result does.
    """
    return _MODULE.sub(lambda module: _cleared(module[0]), verilog)


def collisions_waived(verilog: str) -> str:
    """Verilog text that declares slices of `SlicedMemory` and `PackedMemory`, and rings of `Delay`, never to
    be read where they are written.

    Only yosys knows the attribute. Without it, yosys builds logic that gives the word from before the write.
    """
    return _NEVER_MET.sub(r"  (* no_rw_check *) \1", verilog)


def _cleared(module: str) -> str:
    lines = list(_lines(module))
    if not lines:
        return module
    body = module.removesuffix("endmodule")
    return "\n".join(
        [
            body + "`ifndef SYNTHESIS",
            "  // synthesis translate_off",
            "  initial begin : simulation_starts_clear",
            "    integer word;",
            *lines,
            "  end",
            "  // synthesis translate_on",
            "`endif",
            "endmodule",
        ]
    )


def _lines(module: str) -> Iterator[str]:
    for high, name, last in _MEMORY.findall(module):
        if not re.search(rf"^    {name}\[\d+\] = ", module, re.MULTILINE):  # it has words of its own
            yield f"    for (word = 0; word <= {last}; word = word + 1)"
            yield f"      {name}[word] = {int(high or 0) + 1}'h0;"
    for high, name in _READ.findall(module):
        yield f"    {name} = {int(high or 0) + 1}'h0;"
