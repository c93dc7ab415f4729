"""``softdepth export``: a configured core as Verilog."""

import re
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth import screen
from softdepth.cli import options
from softdepth.spec.config import Config

if TYPE_CHECKING:
    from amaranth.lib.data import StructLayout

_PORT = re.compile(r"^  (input|output)\s+(?:\[(\d+):0\]\s+)?(\w+)\s*;", re.MULTILINE)


def export(
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FILE", help="Verilog file; - is standard output.")
    ],
    preset: options.Preset = None,
    config: options.ConfigFile = None,
    assignments: options.Assignments = None,
    lanes: options.Lanes = None,
    disparities: options.Disparities = None,
    operator: options.Operator = None,
) -> None:
    """Write the core as one self-contained Verilog file."""
    chosen = options.configuration(
        preset, config, assignments, lanes=lanes, disparities=disparities, operator=operator
    )
    on_screen = str(output) == "-"
    from softdepth.files import check_writable, write_atomically

    if not on_screen:
        check_writable(output)
    from softdepth.hdl.verilog import TOP, to_verilog

    verilog = to_verilog(chosen)
    text = header(chosen, verilog) + verilog
    if on_screen:
        print(text, end="")
        return
    write_atomically(output, text.encode())
    screen.note(f"{output}: module {TOP}, configuration {chosen.name} ({chosen.hash})")


def header(config: Config, verilog: str) -> str:
    """A comment that says what the file is: configuration, its hash, our version, ports and payloads."""
    from softdepth.hdl.signatures import PixelPair, Status, result_layout
    from softdepth.hdl.verilog import TOP

    lines = [
        f"{TOP}: stereo depth, made by softdepth {version('softdepth')}",
        f"configuration {config.name}, hash {config.hash}",
        f"one result per {config.steps} clocks; frames up to {config.max_width} x {config.max_height}",
        "",
        "Ports (direction, bits, name):",
        *ports(verilog, TOP),
        "",
        *fields("i_payload", PixelPair),
        *fields("o_payload", result_layout(config)),
        *fields("status", Status),
        "",
        "Configuration, as softdepth --config reads it:",
        *(f"  {line}" for line in config.to_toml().splitlines()),
    ]
    return "".join(f"// {line}".rstrip() + "\n" for line in lines) + "\n"


def ports(verilog: str, module: str) -> list[str]:
    """The ports of a module, one line each."""
    start = verilog.index(f"module {module}(")
    body = verilog[start : verilog.index("endmodule", start)]
    return [f"  {way:<6} {int(top or 0) + 1:>4} {name}" for way, top, name in _PORT.findall(body)]


def fields(port: str, layout: "StructLayout") -> list[str]:
    """Where each field of a packed port lies, one line each."""
    places = [(name, field.offset, field.offset + field.width - 1) for name, field in layout]
    return [f"  {port}[{f'{high}:{low}' if high > low else low}] {name}" for name, low, high in places]
