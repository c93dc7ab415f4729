"""``python -m tests.cover``: what the quick regression reaches of small cores, line by line and bit by bit.

Writes a part of docs/verification.md, and all that is not reached into out/coverage. Fails where some of
that is not explained in explained.toml.
"""

import sys
from datetime import UTC, datetime
from pathlib import Path

from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.sources import sources_hash
from softdepth.spec.config import Config
from softdepth.studies import markers
from tests.cover.counts import reached
from tests.cover.functional import plan
from tests.cover.functional import reached as bins
from tests.cover.page import PART, explanations, missed, page
from tests.mutation.netlist import yosys_of_faults
from tests.mutation.study import CORES

DOCUMENT = Path("docs/verification.md")
LIST = Path("out/coverage/unreached.txt")


def main() -> int:
    """Simulate all cores, and renew the list and the table."""
    found = {name: reached(Config.from_dict({"name": name, **core})) for name, core in CORES.items()}
    said = explanations()
    day = datetime.now(tz=UTC).date()
    measured = f"{day}, gateware {sources_hash('hdl')[:12]}, {yosys_of_faults().version}"
    content = page(found, said, plan(), bins(), measured)
    text = markers.renew(DOCUMENT.read_text(), str(DOCUMENT), PART, content)
    write_atomically(DOCUMENT, text.encode())
    by_reason = missed(found, said)
    LIST.parent.mkdir(parents=True, exist_ok=True)
    listed = [
        f"{reason or 'not explained'}\t{core}\t{point.kind}\t{point.block}\t{point.what}"
        for reason, points in by_reason.items()
        for core, point in points
    ]
    write_atomically(LIST, "\n".join(listed).encode())
    for core, point in by_reason.get("", []):
        print(f"{core}: not reached, not explained: {point}")
    print(f"all that is not reached: {LIST}")
    return int("" in by_reason)


if __name__ == "__main__":
    sys.exit(ended(main))
