"""``python -m softdepth.studies.pixel_a_clock``: what `robust` takes where a pixel takes one clock.

Synthesises the core with as many lanes as candidates, for lines of 1920 pixels, and writes what its rooms
take into docs/pixel_a_clock.json and the table in docs/area.md, beside the row that was placed and routed.
"""

import sys
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from pydantic import BaseModel

from softdepth import screen
from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.flow.blocks import Block, blocks
from softdepth.flow.synthesis import core_netlist
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.studies import markers, utilization_page
from softdepth.studies.utilization import PART, Measurement, Row, Selection, row_name
from softdepth.templates import render

DOCUMENT = Path("docs/area.md")
FIGURES = Path("docs/pixel_a_clock.json")
NAME = "pixel-a-clock"

MODE = "1080p60"
WIDTH, LANES = 1920, 64
ROUTED = Selection(preset="robust", operator="sum", lanes=32)
"""The row of docs/utilization.md that is shown beside it."""

LANE_BLOCKS = ("differences", "right", "running", "sums")
"""Blocks of the room of costs that are there once a lane."""
RESOURCES = ("lut4", "ff", "ebr", "dsp")
HAS = {"lut4": 83_640, "ff": 83_640, "ebr": utilization_page.BLOCK_RAMS[PART.device], "dsp": 156}
"""What `PART` has of each."""


Rooms = dict[str, dict[str, int]]
"""By a room's name, what it takes of each of `RESOURCES`."""


class Study(BaseModel):
    """A core after synthesis, beside one that was placed and routed.

    Members
    -------
    config : the hash of the configuration of which ``rooms`` are.
    routed, routed_rooms : the row of docs/utilization.md, as it was then, and its rooms.
    """

    config: str
    lanes: int
    width: int
    rooms: Rooms
    routed: Row
    routed_rooms: Rooms


def config() -> Config:
    """The core of the study."""
    return Config.preset(ROUTED.preset).override([f"lanes={LANES}", f"max_width={WIDTH}"])


def rooms_of(found: Iterable[Block]) -> Rooms:
    """What each room takes: the lanes apart from what else judges candidates, all stages of post together."""
    rooms: dict[str, Counter[str]] = {
        name: Counter() for name in ("front", "lanes", "other costs", "winners", "post")
    }
    for block in found:
        path = block.name.split(".")
        path = path[path[0] == "core" :]
        room = path[0] if path else "front"
        if room == "costs":
            room = "lanes" if len(path) > 1 and path[1] in LANE_BLOCKS else "other costs"
        elif block.name == "top":
            room = "front"  # what joins the rooms; where the core was measured, the shift registers around it
        elif room not in rooms:
            room = "post"
        rooms[room].update({each: getattr(block, each) for each in RESOURCES})
    return {name: {each: taken[each] for each in RESOURCES} for name, taken in rooms.items()}


def measure(routed: Measurement) -> Study:
    """Synthesise the core for ECP5: minutes."""
    core = config()
    screen.note(f"synthesis of {core.name} with {core.lanes} lanes, {core.max_width} wide")
    return Study(
        config=core.hash,
        lanes=core.lanes,
        width=core.max_width,
        rooms=rooms_of(blocks(core_netlist(core), depth=3)),
        routed=routed.row,
        routed_rooms=rooms_of(routed.blocks),
    )


def page(study: Study) -> str:
    """The table: rooms, their sum, and how much of the part that is."""
    both = study.routed_rooms, study.rooms
    sums = [sum(room[each] for room in rooms.values()) for rooms in both for each in RESOURCES]
    rows = [
        *(
            [name, *(f"{rooms[name][each]:,}" for rooms in both for each in RESOURCES)]
            for name in study.rooms
        ),
        ["all", *(f"{each:,}" for each in sums)],
        [
            f"of an {PART.device}",
            *(f"{taken / HAS[each]:.0%}" for taken, each in zip(sums, RESOURCES * 2, strict=True)),
        ],
    ]
    return render(
        "softdepth.studies",
        "pixel_a_clock.md",
        study=study,
        row=study.routed,
        rows=rows,
        mode=MODE,
        wanted=utilization_page.VIDEO_MODES[MODE],
    )


def routed_row(folder: Path) -> Measurement:
    """The row that is shown beside, of the seed with the median clock."""
    name = str(ROUTED)
    for found, _ in utilization_page.medians(utilization_page.load(folder)):
        row = found.row
        if row_name(row.preset, row.operator, row.lanes, row.device.rpartition("-")[0]) == name:
            return found
    raise InputError(f"'{folder}' has no row {name}", f"run: softdepth utilization --row {name}")


def main() -> None:
    """Measure, and write table and figures."""
    if not DOCUMENT.is_file():
        raise InputError(f"'{DOCUMENT}' is not here", "run this in the project's folder")
    study = measure(routed_row(DOCUMENT.parent))
    write_atomically(FIGURES, (study.model_dump_json(indent=1) + "\n").encode())
    text = markers.renew(DOCUMENT.read_text(), str(DOCUMENT), NAME, page(study))
    write_atomically(DOCUMENT, text.encode())


if __name__ == "__main__":
    sys.exit(ended(main))
