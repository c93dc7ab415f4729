"""What Verilog text says of a module."""

import re


def ports(verilog: str, top: str) -> dict[str, tuple[str, int]]:
    """Direction and width of a module's ports."""
    (body,) = re.findall(rf"^module {top}\(.*?^endmodule", verilog, re.DOTALL | re.MULTILINE)
    found = re.findall(r"^  (input|output) (?:\[(\d+):0\] )?(\w+) ?;", body, re.MULTILINE)
    return {name: (direction, int(high or 0) + 1) for direction, high, name in found}
