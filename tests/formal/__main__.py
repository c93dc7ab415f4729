"""``python -m tests.formal``: every proof at its full depth; what passed is told in docs/verification.md.

With ``--table`` the table of what is proven is renewed, and nothing is run. Other arguments are pytest's.
"""

import sys
import time
from datetime import UTC, datetime
from pathlib import Path

import pytest

from softdepth.ending import ended
from softdepth.files import write_atomically
from softdepth.flow.tools import find_tool
from softdepth.sources import sources_hash
from softdepth.studies import markers
from tests.formal.declared import DOCUMENT, PART, declared, table

RUN = "proofs-run"
SLOWEST = 3
SELECTING = {"-k", "--deselect", "--lf"}
"""Options with which a run is not one of all proofs, and is not recorded."""


class Counted:
    """What pytest says of each test: how many pass, fail, and take how long."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.failed: list[str] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call":
            self.seconds[report.nodeid] = report.duration
        if report.failed:
            self.failed.append(report.nodeid)


def main() -> int:
    """Run the proofs, and renew both parts."""
    arguments = sys.argv[1:]
    if "--table" in arguments:
        _renew(PART, table(declared(Path())))
        return 0
    counted, began = Counted(), time.monotonic()
    status = int(pytest.main(["-m", "formal", "tests/hdl", "tests/axi", *arguments], plugins=[counted]))
    _renew(PART, table(declared(Path())))
    if counted.seconds and not SELECTING & set(arguments):
        _renew(RUN, said(counted, time.monotonic() - began))
    return status


def _renew(part: str, content: str) -> None:
    text = markers.renew(DOCUMENT.read_text(), str(DOCUMENT), part, content)
    write_atomically(DOCUMENT, text.encode())


def said(counted: Counted, seconds: float) -> str:
    """The last run in a sentence."""
    passed = len(counted.seconds) - len(counted.failed)
    slow = sorted(counted.seconds.items(), key=lambda pair: -pair[1])[:SLOWEST]
    longest = ", ".join(f"`{name.partition('::')[2]}` {taken:.0f} s" for name, taken in slow)
    failed = "".join(f" Failed: `{name}`." for name in counted.failed)
    day = datetime.now(tz=UTC).date()
    return (
        f"{day}, gateware {sources_hash('hdl')[:12]}, {find_tool('yosys').version.partition(' (')[0]}:"
        f" {passed} of {len(counted.seconds)} tests passed in {seconds / 60:.1f} min.{failed}"
        f" The longest: {longest}."
    )


if __name__ == "__main__":
    sys.exit(ended(main))
