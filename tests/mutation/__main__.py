"""``python -m tests.mutation``: faults put into small cores, and which of them the quick regression finds.

Writes a part of docs/verification.md. Fails where fewer are found than should be, or one that is not found is
not explained in explained.toml.
"""

import sys
from datetime import UTC, datetime
from pathlib import Path

from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.sources import sources_hash
from softdepth.studies import markers
from tests.mutation.netlist import yosys_of_faults
from tests.mutation.page import PART, page, rate
from tests.mutation.study import study

COUNTS = {"sad": 100, "lite": 100, "robust": 140}
"""Faults in each core."""
WANTED = 0.95
"""Share of them that the regression must find."""
DOCUMENT = Path("docs/verification.md")


def main() -> int:
    """Study all cores, and renew the table."""
    found = {}
    for name, count in COUNTS.items():
        found[name] = outcomes = study(name, count)
        print(f"{name}: {rate(outcomes):.1%} of {count} faults are found")
    day = datetime.now(tz=UTC).date()
    measured = f"{day}, gateware {sources_hash('hdl')[:12]}, {yosys_of_faults().version}"
    text = markers.renew(DOCUMENT.read_text(), str(DOCUMENT), PART, page(found, measured))
    write_atomically(DOCUMENT, text.encode())
    everything = [outcome for outcomes in found.values() for outcome in outcomes]
    unexplained = [each for each in everything if not each.killed and not each.kind]
    for each in unexplained:
        print(f"not found, not explained: {each.mutant}")
    return int(rate(everything) < WANTED or bool(unexplained))


if __name__ == "__main__":
    sys.exit(ended(main))
