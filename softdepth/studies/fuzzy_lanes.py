"""``python -m softdepth.studies.fuzzy_lanes``: what a lane takes with each of the costs that are compared.

Writes docs/fuzzy_lanes.json, from which ``softdepth evaluate --fuzzy`` shows it beside their accuracy. A lane
is everything that exists once per candidate evaluated in a clock, without its part of the winners and of the
right view's columns; the memory of its sums is not counted in LUTs.
"""

import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from softdepth import screen
from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.flow.limits import taken
from softdepth.flow.synthesis import synthesise
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.studies.evaluate.lanes import FIGURES, LaneFigures, core_of, to_json
from softdepth.studies.evaluate.variants import compared


def measure(config: Config) -> LaneFigures:
    """Synthesise a lane of `config` for ECP5."""
    from softdepth.studies.summed_lane import SummedLane  # elaboration is slow to import

    with tempfile.TemporaryDirectory(prefix="softdepth-") as folder:
        netlist = synthesise(SummedLane(config), "ecp5", Path(folder), options=("-noiopad",))
    found = taken(netlist)
    return LaneFigures(
        config=config.hash,
        lut4=found["lut4"],
        ff=found["ff"],
        multipliers=round(config.multipliers / config.lanes, 2),
    )


def measure_all(configs: Mapping[str, Config]) -> dict[str, LaneFigures]:
    """The same for a core of each."""
    found = {}
    for number, (name, config) in enumerate(configs.items(), start=1):
        screen.note(f"lane {number} of {len(configs)}: {name}")
        found[name] = measure(core_of(config))
    return found


def main() -> None:
    """Measure all and write the file."""
    if not FIGURES.parent.is_dir():
        raise InputError(f"'{FIGURES.parent}' is not here", "run this in the project's folder")
    write_atomically(FIGURES, to_json(measure_all(compared())))


if __name__ == "__main__":
    sys.exit(ended(main))
