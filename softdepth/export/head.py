"""The head of an exported Verilog file: all that is needed to use the core, for people."""

import textwrap
from collections.abc import Iterator
from importlib.metadata import version

from softdepth.export.constants import span, template
from softdepth.export.interface import Interface

WIDTH = 107
"""Columns of the comment's text."""


def head(interface: Interface) -> str:
    """The comment, with the configuration at its end as ``softdepth --config`` reads it."""
    config = interface.config
    lines = [
        f"{interface.name}: stereo depth, made by softdepth {version('softdepth')}",
        f"configuration {config.name}, hash {config.hash}",
        "",
        *_ports(interface),
        "",
        "Validity codes, o_payload's field code:",
        *_table([(str(code.value), code.name, code.meaning) for code in interface.codes]),
        "  The disparity is 0 where the code says that there is no result.",
        "",
        *_use(interface),
        "",
        "To copy:",
        *(f"  {line}" for line in template(interface)),
        "",
        "Configuration, as softdepth --config reads it:",
        *(f"  {line}" for line in config.to_toml().splitlines()),
    ]
    return "".join(f"// {line}".rstrip() + "\n" for line in lines) + "\n"


def _ports(interface: Interface) -> Iterator[str]:
    yield "Ports (direction, bits, name, meaning):"
    yield from _table(
        [(port.direction, str(port.width), port.name, port.meaning) for port in interface.ports]
    )
    for port in interface.ports:
        if port.fields:
            yield ""
            yield f"Fields of {port.name}:"
            yield from _table([(span(port.name, f), f.name, f.meaning) for f in port.fields])


def _use(interface: Interface) -> Iterator[str]:
    c = interface.config
    table = any(len(criterion.reciprocals) > 1 for criterion in c.criteria)
    yield "How to use it:"
    for text in (
        "Pixels come row by row, from the top left; there is one result for each pixel, in the same order."
        " A transfer is a rising edge of clk with valid and ready both 1. An offer stands until it is taken.",
        _time(interface),
        f"Frames: {c.min_width} x {c.min_height} to {c.max_width} x {c.max_height} pixels."
        + (" Lower ones have no result that is a measurement." if c.min_height > 1 else "")
        + " Narrower ones are filled and marked as damaged. A frame's first line gives its width.",
        "Memories have no initial words in synthesis, and need none; simulators find them cleared."
        + (" The table of reciprocals is the exception." if table else ""),
    ):
        yield from textwrap.wrap(
            text, WIDTH, initial_indent="  - ", subsequent_indent="    ", break_on_hyphens=False
        )


def _time(interface: Interface) -> str:
    c, whole = interface.config, interface.whole
    clocks = f"{c.steps} clock{'s' * (c.steps > 1)}"
    if whole is None:
        return (
            f"Time: a pixel takes {clocks}, without a pause between lines or frames."
            f" The result of (x, y) needs the pixel at (x + {c.reach_right}, y + {c.reach_rows}). With"
            f" o_ready at 1 it can be taken {interface.latency} clocks after that pixel is, where pixels come"
            f" slowly, and {interface.full_rate_latency} clocks after it where they are always on offer: some"
            " wait in a queue then. The results of a frame's last rows and columns follow by themselves."
        )
    text = (
        f"Time: a pixel takes {clocks}, a line as much as {whole.right} pixels more, a frame as much as"
        f" {whole.below} lines more" + (f" and {whole.drain} pixels" if whole.drain else "") + "; i_ready is"
        " low meanwhile. The results of line y need the pixels up to column"
        f" {whole.column} of line y + {whole.rows}. With o_ready at 1 the line's last can be taken"
        f" {interface.latency} clocks after that pixel is, where pixels come slowly and lines have at least"
        f" {whole.narrowest}; where they are always on offer, some wait in queues."
    )
    if c.post.fill:
        text += (
            " Results that are filled wait for the next measurement of their line, or its end, and follow"
            " it a clock each."
        )
    return text + " The results of a frame's last rows follow by themselves."


def _table(rows: list[tuple[str, ...]]) -> Iterator[str]:
    """Rows in columns; long last cells go on in the next line, under themselves."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]) - 1)]
    for row in rows:
        cells = [
            cell.rjust(width) if cell.isdigit() else cell.ljust(width)
            for cell, width in zip(row, widths, strict=False)
        ]
        start = "  " + "  ".join(cells) + "  "
        yield from textwrap.wrap(
            row[-1], WIDTH, initial_indent=start, subsequent_indent=" " * len(start), break_on_hyphens=False
        )
