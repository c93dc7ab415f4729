"""``docs/utilization.md`` and ``.json``: the measured configurations as a table, and what they can do."""

import json
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TypeVar

from softdepth.files import write_atomically
from softdepth.flow.families import FAMILIES
from softdepth.flow.other_families import OTHER_FAMILIES
from softdepth.flow.tools import find_tool
from softdepth.studies import other_families
from softdepth.studies.other_families import FamilyRow
from softdepth.studies.utilization import (
    AIM_MHZ,
    PART,
    SUM,
    Measurement,
    Row,
    Selection,
    row_name,
)
from softdepth.templates import render

T = TypeVar("T", Measurement, Row)

JSON = "utilization.json"

VIDEO_MODES = {
    "VGA 60": 18.4,
    "720p30": 27.6,
    "720p60": 55.3,
    "1080p30": 62.2,
    "1080p60": 124.4,
}
"""Million visible pixels a second of usual video modes, which is what a core must sustain."""

BLOCK_RAMS = {"LFE5U-12F": 56, "LFE5U-25F": 56, "LFE5U-45F": 108, "LFE5U-85F": 208}
"""Block RAMs of each part; the smallest has the die of the next."""

_PAPERS = [
    Selection(preset=preset, operator="mean", lanes=lanes)
    for preset in ("paper", "compact", "lite", "sad")
    for lanes in (8, 32)
]
_OPERATORS = [
    Selection(preset="compact", operator=operator, lanes=8)
    for operator in ("min", "prod", "soft_min_1", "soft_min_2")
]
_ROBUST = [
    Selection(preset="robust", operator=SUM, lanes=32),
    Selection(preset="robust-small", operator=SUM, lanes=32, device="LFE5U-45F"),
    Selection(preset="robust-small", operator=SUM, lanes=16, device="LFE5U-25F"),
]

RECOMMENDED = (*_PAPERS, *_OPERATORS, *_ROBUST)
"""The rows of the table."""

SEEDS = 3
"""The seeds whose median the rows of `robust` show, because their speed is promised."""

QUICK = tuple(row for row in RECOMMENDED if row.lanes == 8 and row.operator == "mean")
"""The rows that take minutes, not hours."""

DETAILED = "paper/mean/32"
"""The row whose blocks are listed, where it is among the rows."""


def seeds_of(selection: Selection, first: int) -> tuple[int, ...]:
    """The seeds that a recommended row is measured with, from the `first` on."""
    return tuple(range(first, first + (SEEDS if selection in _ROBUST else 1)))


def load(folder: Path) -> list[Measurement]:
    """What a folder's ``utilization.json`` holds; nothing where there is none, or one of another form."""
    try:
        figures = json.loads((folder / JSON).read_text())
        pairs = zip(figures["rows"], figures["runs"], strict=True)
        return [Measurement.model_validate({"row": row, **run}) for row, run in pairs]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def merged(known: Sequence[Measurement], new: Sequence[Measurement]) -> list[Measurement]:
    """The known measurements, new ones of the same row and seed in their place, and the others behind.

    When a row is measured again, other seeds stay only if nextpnr was given the same except for the seed.
    """
    found = {(*_identity(each.row), each.seed): each for each in known}
    for each in new:
        stale = [k for k, old in found.items() if k[:-1] == _identity(each.row) and not _alike(old, each)]
        for key in stale:
            if key[-1] != each.seed:
                del found[key]
        found[(*_identity(each.row), each.seed)] = each
    return list(found.values())


def medians(measurements: Sequence[Measurement]) -> list[tuple[Measurement, list[Measurement]]]:
    """For each row, the measurement with the median clock (the lower of two) and those of all its seeds."""
    rows = _alike_but_for_seeds(measurements, lambda each: each.row)
    return [(seeds[_middle(seeds)], sorted(seeds, key=lambda each: each.seed)) for seeds in rows]


def median_rows(rows: Sequence[Row]) -> list[Row]:
    """Of rows that differ only in the seed, the one with the median clock, the lower of two."""
    return [seeds[_middle(seeds)] for seeds in _alike_but_for_seeds(rows, lambda row: row)]


def block_rams_left(row: Row) -> int:
    """How many of the part's block RAMs a row leaves."""
    return BLOCK_RAMS[row.device.rpartition("-")[0]] - row.ebr


def write(folder: Path, measurements: Sequence[Measurement]) -> None:
    """Write both files into `folder`, whose earlier rows may have been measured by other programs."""
    tools = _tools(folder)
    figures = {
        "tools": tools,
        "part": f"{PART.device}-{PART.speed}{PART.package}",
        "video_modes_mpixel_s": VIDEO_MODES,
        "rows": [found.row.model_dump() for found in measurements],
        "runs": [found.model_dump(exclude={"row"}) for found in measurements],
    }
    write_atomically(folder / JSON, (json.dumps(figures, indent=1) + "\n").encode())
    text = page(measurements, tools, other_families.load(folder))
    write_atomically(folder / "utilization.md", text.encode())


def _tools(folder: Path) -> dict[str, str]:
    """Versions of the programs; those that measured the folder's earlier rows stand before today's."""
    try:
        earlier = json.loads((folder / JSON).read_text())["tools"]
    except (OSError, ValueError, KeyError):
        earlier = {}
    family = FAMILIES[PART.family]
    tools = {}
    for name in ("yosys", family.placer, family.packer):
        known = earlier[name].split(" or ") if name in earlier else []
        tools[name] = " or ".join(dict.fromkeys([*known, find_tool(name).version]))
    return tools


def modes(row: Row) -> list[str]:
    """The video modes whose pixels a row keeps up with."""
    return [name for name, rate in VIDEO_MODES.items() if row.mpixel_s >= rate]


def page(
    measurements: Sequence[Measurement], tools: dict[str, str], families: Sequence[FamilyRow] = ()
) -> str:
    """The figures as a Markdown page, those of other families at its end."""
    shown = medians(measurements)
    detailed = next((m for m, _ in shown if _name(m.row) == DETAILED), shown[0][0])
    text = render(
        "softdepth.studies",
        "utilization.md",
        part=PART,
        aim_mhz=AIM_MHZ,
        tools=tools,
        wrappers=sorted({(m.wrapper_lut4, m.wrapper_ff) for m in measurements}),
        shown=shown,
        left=block_rams_left,
        video_modes=VIDEO_MODES,
        modes=modes,
        name=_name,
        detailed=detailed,
        families=families,
        targets=OTHER_FAMILIES,
    )
    return text + "\n"


def _identity(row: Row) -> tuple[str, int, int]:
    return _name(row), row.disparities, row.width


def _name(row: Row) -> str:
    return row_name(row.preset, row.operator, row.lanes, row.device.rpartition("-")[0])


def _alike_but_for_seeds(found: Iterable[T], row_of: Callable[[T], Row]) -> list[list[T]]:
    """Measurements that differ only in the seed, together, the slowest clock first."""
    groups: dict[tuple[str, int, int], list[T]] = {}
    for each in found:
        groups.setdefault(_identity(row_of(each)), []).append(each)
    return [sorted(seeds, key=lambda each: row_of(each).fmax_mhz) for seeds in groups.values()]


def _middle(seeds: Sequence[object]) -> int:
    """Place of the median, the lower one of two."""
    return (len(seeds) - 1) // 2


def _alike(a: Measurement, b: Measurement) -> bool:
    """Whether nextpnr was given the same but for the seed; of earlier measurements, as far as blocks tell."""
    if a.but_for_seed and b.but_for_seed:
        return a.but_for_seed == b.but_for_seed
    return a.blocks == b.blocks
