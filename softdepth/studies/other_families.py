"""Area on families that nothing here places and routes: what yosys maps a core to, beside the ECP5's rows."""

import contextlib
import hashlib
import json
from collections.abc import Iterable, Sequence
from pathlib import Path

from pydantic import BaseModel

from softdepth import screen
from softdepth.files import cache_folder, write_atomically
from softdepth.flow.other_families import OTHER_FAMILIES, synthesised
from softdepth.flow.synthesis import to_shared_rtlil
from softdepth.flow.tools import find_tool
from softdepth.hdl.core import StereoCore
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.studies.utilization import Selection, operator_of

JSON = "other-families.json"

ROWS = tuple(
    Selection.model_validate({"preset": preset, "operator": "mean", "lanes": lanes})
    for preset, lanes in (("sad", 8), ("lite", 8), ("paper", 8), ("robust", 32))
)
"""The cores of the table."""


class FamilyRow(BaseModel):
    """A core, and what it takes of a family's parts.

    Members
    -------
    family : its name in `OTHER_FAMILIES`.
    lut, ff, ram, dsp : as `Taken` has them.
    key : changes with all that yosys was given: RTLIL, command, and its own version.
    cells : the netlist's cells by type, which the counts are of.
    """

    family: str
    preset: str
    operator: str
    disparities: int
    lanes: int
    width: int
    lut: int
    ff: int
    ram: int
    dsp: int
    config_hash: str
    yosys: str
    key: str
    cells: dict[str, int]


def measure(config: Config, preset: str, family: str, *, known: Iterable[FamilyRow] = ()) -> FamilyRow:
    """Synthesise a core alone, without anything around it.

    What was synthesised before is taken from `known` or from the cache. Raises `ToolError` if yosys
    fails, or maps to a cell that the family is not known to have.
    """
    target = OTHER_FAMILIES[family]
    text = to_shared_rtlil(StereoCore(config))
    version = find_tool("yosys").version
    key = hashlib.sha256("\n".join((text, target.command, version)).encode()).hexdigest()[:20]
    kept = cache_folder() / "flow" / "families" / f"{key}.json"
    for earlier in known:
        if (earlier.key, earlier.family) == (key, family):
            return earlier
    if kept.is_file():
        cells = json.loads(kept.read_text())
    else:
        cells = dict(sorted(synthesised(text, target).items()))
        with contextlib.suppress(OSError, InputError):  # without a cache the next run takes longer, no more
            kept.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(kept, json.dumps(cells).encode())
    taken = target.taken(cells)
    return FamilyRow(
        family=family,
        preset=preset,
        operator=operator_of(preset, config.operator),
        disparities=config.disparities,
        lanes=config.lanes,
        width=config.max_width,
        lut=taken.lut,
        ff=taken.ff,
        ram=taken.ram,
        dsp=taken.dsp,
        config_hash=config.hash,
        yosys=version,
        key=key,
        cells=cells,
    )


def measure_all(
    rows: Sequence[Selection] | None = None, *, known: Sequence[FamilyRow] = (), **sizes: int
) -> list[FamilyRow]:
    """Each core (those of `ROWS` if none are given) in each family; `sizes` as in `Selection.config`."""
    found = []
    for row in ROWS if rows is None else rows:
        config = row.config(**sizes)
        for family, target in OTHER_FAMILIES.items():
            screen.note(f"{row}: {target.title}")
            found.append(measure(config, row.preset, family, known=known))
    return found


def load(folder: Path) -> list[FamilyRow]:
    """The rows of a folder; none where there are none, or ones of another form."""
    try:
        return [FamilyRow.model_validate(row) for row in json.loads((folder / JSON).read_text())["rows"]]
    except (OSError, ValueError, KeyError, TypeError):
        return []


def write(folder: Path, rows: Sequence[FamilyRow]) -> None:
    """Write the rows into `folder`, for `load`."""
    figures = {"rows": [row.model_dump() for row in rows]}
    write_atomically(folder / JSON, (json.dumps(figures, indent=1) + "\n").encode())
