"""``python -m softdepth.flow.savings``: what each saving of area buys a lane; renews docs/area.md.

A lane is all that is there once per candidate evaluated in a clock, but for its node of the argmin tree.
Each saving is left out by itself, and all of them together.
"""

import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from softdepth import markers, screen
from softdepth.config import Config
from softdepth.errors import InputError, SoftdepthError
from softdepth.flow.fuse import fuse_carries
from softdepth.flow.limits import taken
from softdepth.flow.ram_registers import absorb_ram_registers
from softdepth.flow.synthesis import NetlistPass, synthesise, to_rtlil

DOCUMENT = Path("docs/area.md")
PART = "savings"
PASSES: tuple[NetlistPass, ...] = (fuse_carries, absorb_ram_registers)
CORE = ("disparities=64", "lanes=32", "max_width=1280")


@dataclass(frozen=True)
class Variant:
    """A lane without some of the savings."""

    without: str
    changes: tuple[str, ...] = ()
    passes: tuple[NetlistPass, ...] = PASSES
    collisions: bool = False
    presets: tuple[str, ...] = ("paper", "lite", "sad")


ROW_MEMORY = "rows remembered in block RAM"
VARIANTS = (
    Variant("nothing: as it is"),
    Variant("choices and complements within carry cells", passes=(absorb_ram_registers,)),
    Variant(ROW_MEMORY, changes=("stored_rows=0",)),
    Variant("collisions in block RAM that do not matter", collisions=True),
    Variant("block RAM's own output registers", passes=(fuse_carries,)),
    # The rule array computes the corrected table; the printed one takes as much of it.
    Variant("MEAN in closed form", changes=("rules=corrected",), presets=("paper", "lite")),
    Variant("any of these", changes=("stored_rows=0", "rules=corrected"), passes=()),
)


def measure(config: Config, variant: Variant) -> dict[str, int]:
    """LUT4s, flip-flops and block RAMs of one lane."""
    from softdepth.hdl.lane import Lane  # elaboration is slow to import

    text = to_rtlil(Lane(config.override(variant.changes)))
    if variant.collisions:
        text = text.replace("\\COLLISION_X_MASK 1'1", "\\COLLISION_X_MASK 1'0")
    with tempfile.TemporaryDirectory(prefix="softdepth-") as folder:
        return taken(synthesise(text, "ecp5", Path(folder), options=("-noiopad",), passes=variant.passes))


def page(presets: Sequence[str] = ("paper", "lite", "sad")) -> str:
    """The table: a row for each saving, with what a lane takes without it."""
    lines = [
        "| without | " + " | ".join(f"{p}: LUT4 | FF | block RAM" for p in presets) + " |",
        "|---|" + "---:|---:|---:|" * len(presets),
    ]
    for number, variant in enumerate(VARIANTS, start=1):
        screen.note(f"row {number} of {len(VARIANTS)}: without {variant.without}")
        cells: list[str] = []
        for preset in presets:
            if preset not in variant.presets:
                cells += ["", "", ""]
                continue
            config = Config.preset(preset).override(CORE)
            found = measure(config, variant)
            cells += [str(found[name]) for name in ("lut4", "ff", "ebr")]
        lines.append(f"| {variant.without} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main() -> None:
    """Measure and write the table into the document."""
    try:
        if not DOCUMENT.is_file():
            raise InputError(f"'{DOCUMENT}' is not here", "run this in the project's folder")
        text = markers.renew(DOCUMENT.read_text(), str(DOCUMENT), PART, page())
    except SoftdepthError as error:
        print(f"error: {error}", file=sys.stderr)
        raise SystemExit(2) from None
    DOCUMENT.write_text(text)


if __name__ == "__main__":
    main()
