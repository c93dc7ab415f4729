"""``docs/utilization.md`` and ``.json``: the measured configurations as a table, and what they can do."""

import json
from collections.abc import Sequence
from pathlib import Path

from softdepth.files import write_atomically
from softdepth.flow.families import FAMILIES
from softdepth.flow.tools import find_tool
from softdepth.studies.utilization import AIM_MHZ, PART, Measurement, Row, Selection

JSON = "utilization.json"

VIDEO_MODES = {
    "VGA 60": 18.4,
    "720p30": 27.6,
    "720p60": 55.3,
    "1080p30": 62.2,
    "1080p60": 124.4,
}
"""Million visible pixels a second of usual video modes, which is what a core must sustain."""

RECOMMENDED = tuple(
    Selection.model_validate({"preset": preset, "operator": operator, "lanes": lanes})
    for preset, operator, lanes in (
        *((preset, "mean", lanes) for preset in ("paper", "compact", "lite", "sad") for lanes in (8, 32)),
        *(("compact", operator, 8) for operator in ("min", "prod", "soft_min_1", "soft_min_2")),
    )
)
"""The rows of the table."""

QUICK = tuple(row for row in RECOMMENDED if row.lanes == 8 and row.operator == "mean")
"""The rows that take minutes, not hours."""

DETAILED = "paper/mean/32"
"""The row whose blocks are listed, where it is among the rows."""


def load(folder: Path) -> list[Measurement]:
    """What a folder's ``utilization.json`` holds; nothing where there is none, or one of another form."""
    try:
        figures = json.loads((folder / JSON).read_text())
        pairs = zip(figures["rows"], figures["runs"], strict=True)
        return [Measurement.model_validate({"row": row, **run}) for row, run in pairs]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def merged(known: Sequence[Measurement], new: Sequence[Measurement]) -> list[Measurement]:
    """The known measurements, new ones of the same configuration in their place, and the others behind."""
    found = {_identity(each.row): each for each in known}
    return list((found | {_identity(each.row): each for each in new}).values())


def write(folder: Path, measurements: Sequence[Measurement]) -> None:
    """Write both files into `folder`."""
    family = FAMILIES[PART.family]
    tools = {name: find_tool(name).version for name in ("yosys", family.placer, family.packer)}
    figures = {
        "tools": tools,
        "part": f"{PART.device}-{PART.speed}{PART.package}",
        "video_modes_mpixel_s": VIDEO_MODES,
        "rows": [found.row.model_dump() for found in measurements],
        "runs": [found.model_dump(exclude={"row"}) for found in measurements],
    }
    write_atomically(folder / JSON, (json.dumps(figures, indent=1) + "\n").encode())
    write_atomically(folder / "utilization.md", page(measurements, tools).encode())


def modes(row: Row) -> list[str]:
    """The video modes whose pixels a row keeps up with."""
    return [name for name, rate in VIDEO_MODES.items() if row.mpixel_s >= rate]


def page(measurements: Sequence[Measurement], tools: dict[str, str]) -> str:
    """The figures as a Markdown page."""
    detailed = next((m for m in measurements if _name(m.row) == DETAILED), measurements[0])
    wrappers = sorted({(m.wrapper_lut4, m.wrapper_ff) for m in measurements})
    lines = [
        "# Area and speed",
        "",
        "Written by `make utilization`; the same figures for programs are in"
        " [utilization.json](utilization.json). One row again:"
        " `.venv/bin/softdepth utilization --row paper/mean/8`.",
        "",
        f"{PART.device}, {PART.package}, speed grade {PART.speed}: synthesised, placed and routed;"
        f" {', '.join(f'{name}: {text}' for name, text in tools.items())}; aiming at"
        f" {AIM_MHZ:g} MHz. Figures are nextpnr's own. LUT4 counts a carry cell as two and"
        " distributed RAM as what it takes; DSP are multipliers of 18x18 bits, EBR block RAMs of 18 kbit."
        " The core stands between shift registers, which are in the figures:"
        + ", or".join(f" {lut4} LUT4 and {ff} flip-flops" for lut4, ff in wrappers)
        + ".",
        "",
        "| preset | operator | disparities | lanes | width | LUT4 | FF | EBR | DSP | fmax, MHz | clocks/pixel"
        " | Mpixel/s | MDE/s | MDE/s per kLUT | LUT4 per lane | seed |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
        *(f"{_table_row(found.row)} {found.seed} |" for found in measurements),
        "",
        "MDE/s: million disparity evaluations a second. LUT4 per lane: all of the core, divided by the lanes."
        " The preset sad has no fuzzy stage, so that its operator changes nothing.",
        "",
        "## Video",
        "",
        "A core keeps up with a video mode when it takes as many pixels a second as are visible in it: "
        + ", ".join(f"{name} {rate}" for name, rate in VIDEO_MODES.items())
        + " Mpixel/s. 1080p needs `max_width = 1920`, with more block RAM.",
        "",
        "| configuration | Mpixel/s | keeps up with |",
        "|---|---:|---|",
        *(
            f"| {_name(m.row)} | {m.row.mpixel_s:.1f} | {', '.join(modes(m.row)) or '-'} |"
            for m in measurements
        ),
        "",
        "## What limits the clock",
        "",
        "| configuration | slowest path |",
        "|---|---|",
        *(f"| {_name(m.row)} | {_code(m.critical_path)} |" for m in measurements),
        "",
        f"## Blocks of {_name(detailed.row)}",
        "",
        "Cells by the block whose net they drive. `lane` and other repeated blocks stand for all of their"
        " kind together, a block for what is in none of those below it, `top` for the shift registers.",
        "",
        "| block | LUT4 | FF | EBR | DSP |",
        "|---|---:|---:|---:|---:|",
        *(f"| `{b.name}` | {b.lut4} | {b.ff} | {b.ebr} | {b.dsp} |" for b in detailed.blocks),
    ]
    return "\n".join(lines) + "\n"


def _identity(row: Row) -> tuple[str, int, int]:
    return _name(row), row.disparities, row.width


def _name(row: Row) -> str:
    return f"{row.preset}/{row.operator}/{row.lanes}"


def _code(path: str) -> str:
    return path.replace("|", "\\|")


def _table_row(row: Row) -> str:
    return (
        f"| {row.preset} | {row.operator} | {row.disparities} | {row.lanes} | {row.width} | {row.lut4:,}"
        f" | {row.ff:,} | {row.ebr} | {row.dsp} | {row.fmax_mhz:.1f} | {row.cycles_per_pixel}"
        f" | {row.mpixel_s:.1f} | {row.mde_s:,.0f} | {row.mde_s_per_klut:.0f} | {row.lut4_per_lane:.0f} |"
    )
