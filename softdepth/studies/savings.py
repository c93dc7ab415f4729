"""``python -m softdepth.studies.savings``: what each saving of area buys a lane, and what operators cost.

Renews docs/area.md, and writes docs/area.json for programs.

A lane is everything that exists once per candidate evaluated in a clock, without its node of the argmin tree.
Each saving is left out alone, and all of them together.
"""

import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from softdepth import screen
from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.flow.families import FAMILIES, NetlistPass
from softdepth.flow.families.ecp5.fuse import fuse_carries
from softdepth.flow.families.ecp5.ram_registers import absorb_ram_registers
from softdepth.flow.limits import taken
from softdepth.flow.synthesis import cells, synthesise, to_shared_rtlil
from softdepth.spec.config import OPERATORS, Config
from softdepth.spec.errors import InputError
from softdepth.spec.rules import Firing
from softdepth.studies import markers
from softdepth.studies.evaluate.lanes import CORE
from softdepth.templates import render

DOCUMENT = Path("docs/area.md")
FIGURES = DOCUMENT.with_suffix(".json")
ALL = FAMILIES["ecp5"].passes
MOST_MULTIPLIERS = 9999
"""Only one lane is built, whatever a part could hold of them."""
LANES = ("paper", "compact", "lite", "sad")


def _all_but(left_out: NetlistPass) -> tuple[NetlistPass, ...]:
    return tuple(each for each in ALL if each is not left_out)


@dataclass(frozen=True)
class Variant:
    """A lane without some of the savings."""

    without: str
    changes: tuple[str, ...] = ()
    passes: tuple[NetlistPass, ...] = ALL
    collisions: bool = False
    presets: tuple[str, ...] = LANES


ROW_MEMORY = "rows remembered in block RAM"
VARIANTS = (
    Variant("nothing: as it is"),
    Variant("choices and complements within carry cells", passes=_all_but(fuse_carries)),
    Variant(ROW_MEMORY, changes=("stored_rows=0",)),
    Variant("collisions in block RAM that do not matter", collisions=True),
    Variant("block RAM's own output registers", passes=_all_but(absorb_ram_registers)),
    # Without its closed form, what computes the other table takes as much for this one.
    Variant("MEAN in closed form", changes=("rules=corrected",), presets=("paper",)),
    Variant("MEAN in closed form, in the cell", changes=("rules=printed",), presets=("compact", "lite")),
    Variant("rules of the cell alone", changes=("firing=all", "rules=printed"), presets=("compact", "lite")),
    Variant("any of these", changes=("stored_rows=0", "firing=all", "rules=corrected"), passes=()),
)


def measure(config: Config, variant: Variant) -> dict[str, int]:
    """LUT4s, flip-flops, block RAMs and multipliers of one lane."""
    from softdepth.hdl.costs.lane import Lane  # elaboration is slow to import

    text = to_shared_rtlil(Lane(config.override(variant.changes)))
    if variant.collisions:
        text = text.replace("\\COLLISION_X_MASK 1'1", "\\COLLISION_X_MASK 1'0")
    with tempfile.TemporaryDirectory(prefix="softdepth-") as folder:
        netlist = synthesise(text, "ecp5", Path(folder), options=("-noiopad",), passes=variant.passes)
    return {**taken(netlist), "dsp": cells(netlist)["MULT18X18D"]}


def page(presets: Sequence[str] = LANES) -> str:
    """The table: a row for each saving, with what a lane takes without it."""
    columns = [column for p in presets for column in (f"{p}: LUT4", "FF", "block RAM")]
    rows = []
    for number, variant in enumerate(VARIANTS, start=1):
        screen.note(f"row {number} of {len(VARIANTS)}: without {variant.without}")
        entries: list[str] = []
        for preset in presets:
            if preset not in variant.presets:
                entries += ["", "", ""]
                continue
            config = Config.preset(preset).override(CORE)
            found = measure(config, variant)
            entries += [str(found[name]) for name in ("lut4", "ff", "ebr")]
        rows.append([variant.without, *entries])
    return render("softdepth.studies", "savings.md", columns=columns, rows=rows)


def operators() -> dict[Firing, dict[str, dict[str, int]]]:
    """What a lane of `paper` takes with each operator: over all rules, and the cell's if that differs."""
    found: dict[Firing, dict[str, dict[str, int]]] = {"all": {}, "cell": {}}
    for operator in OPERATORS:
        for firing, lanes in found.items():
            changes = (f"operator={operator}", f"firing={firing}", f"max_multipliers={MOST_MULTIPLIERS}")
            config = Config.preset("paper").override([*CORE, *changes])
            if firing == "cell" and config.override(["firing=all"]).by_cell:
                continue  # one and the same
            screen.note(f"operator {operator}, firing {firing}")
            lanes[operator] = measure(config, VARIANTS[0])
    return found


def operator_page(found: dict[Firing, dict[str, dict[str, int]]]) -> str:
    """The same as a table."""
    return render("softdepth.studies", "operators.md", found=found)


def main() -> None:
    """Measure and write the tables into the document."""
    if not DOCUMENT.is_file():
        raise InputError(f"'{DOCUMENT}' is not here", "run this in the project's folder")
    lanes = operators()
    text = markers.renew(DOCUMENT.read_text(), str(DOCUMENT), "operators", operator_page(lanes))
    text = markers.renew(text, str(DOCUMENT), "savings", page())
    write_atomically(DOCUMENT, text.encode())
    figures = {"preset": "paper", "lanes": lanes["all"], "lanes_of_the_cell": lanes["cell"]}
    write_atomically(FIGURES, (json.dumps(figures, indent=1) + "\n").encode())


if __name__ == "__main__":
    sys.exit(ended(main))
