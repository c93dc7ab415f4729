"""``python -m softdepth.studies.registers_page``: registers of the core with AXI streams, in docs/axi.md."""

import sys
from pathlib import Path

from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.spec.axi_options import AxiOptions
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.spec.registers import Register, RegisterField, registers
from softdepth.studies import markers
from softdepth.templates import render

DOCUMENT = Path("docs/axi.md")
PART = "registers"
CONFIGS = (
    Config.preset("robust"),
    Config.preset("paper").override(["compensation.reading=top"]),
)
OPTIONS = AxiOptions(inputs="two", left=True)
"""The ports of cores that have every register."""


def page() -> str:
    """The table: a row a field."""
    rows = [
        {
            "address": f"0x{register.address:02X}",
            "register": register.name,
            "field": field.name.removeprefix(f"{register.name.lower()}_").upper(),
            "bits": _bits(field),
            "access": _access(field),
            "reset": field.reset if field.writable and not field.pulses else "",
            "meaning": _meaning(register, field),
        }
        for register in _registers()
        for field in register.fields
    ]
    return render("softdepth.studies", "registers.md", rows=rows)


def _registers() -> list[Register]:
    """Of all `CONFIGS`, each once, in the order of their addresses."""
    found = {each.name: each for config in reversed(CONFIGS) for each in registers(config, OPTIONS)}
    return sorted(found.values(), key=lambda each: each.address)


def _bits(field: RegisterField) -> str:
    highest = field.low + field.width - 1
    return f"{highest}:{field.low}" if field.width > 1 else str(field.low)


def _access(field: RegisterField) -> str:
    if field.sticky:
        return "read, clear"
    if field.pulses:
        return "write"
    return "read, write" if field.writable else "read"


def _meaning(register: Register, field: RegisterField) -> str:
    """The register's, with the first of its fields, and the field's."""
    first = field is register.fields[0]
    return f"{register.meaning} {field.meaning}" if first else field.meaning


def main(project: Path) -> None:
    """Renew the table in `project`."""
    path = project / DOCUMENT
    if not path.is_file():
        raise InputError(f"'{path}' is not there", "run this in the project's folder")
    write_atomically(path, markers.renew(path.read_text(), str(DOCUMENT), PART, page()).encode())


if __name__ == "__main__":
    sys.exit(ended(lambda: main(Path.cwd())))
