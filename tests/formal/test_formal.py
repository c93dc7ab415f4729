"""The table of proofs is that of the tests, and every proof belongs to it."""

from pathlib import Path

from softdepth.studies import markers
from tests.formal.__main__ import Counted, said
from tests.formal.declared import DOCUMENT, PART, declared, table


def test_the_document_lists_what_the_tests_prove(project: Path) -> None:
    text = (project / DOCUMENT).read_text()
    renewed = markers.renew(text, str(DOCUMENT), PART, table(declared(project)))
    assert renewed == text, "run: python -m tests.formal --table"


def test_a_row_says_where_it_fails(project: Path) -> None:
    rows = declared(project)
    assert len(rows) > 10
    assert all(row.faults and row.files and row.claim.depth for row in rows)
    queue = next(row for row in rows if "argmin tree" in row.claim.what)
    assert "ties go to the upper half" in queue.faults


def test_what_failed_is_told() -> None:
    counted = Counted()
    counted.seconds = {"tests/a.py::one": 3.0, "tests/a.py::two": 70.0}
    counted.failed = ["tests/a.py::one"]
    text = said(counted, 90)
    assert "1 of 2 tests passed in 1.5 min. Failed: `tests/a.py::one`." in text
    assert "`two` 70 s" in text
