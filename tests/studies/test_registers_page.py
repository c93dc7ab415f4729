"""The table of the registers in the documents is that of today's description."""

import re
from pathlib import Path

import pytest

from softdepth.spec import registers as description
from softdepth.spec.errors import InputError
from softdepth.studies import registers_page
from softdepth.studies.markers import markers


def test_the_document_has_todays_table(project: Path) -> None:
    first, last = markers(registers_page.PART)
    text = (project / registers_page.DOCUMENT).read_text()
    assert text.partition(first)[2].partition(last)[0].strip() == registers_page.page().strip(), (
        "run make registers"
    )


def test_every_register_of_the_description_is_there() -> None:
    """Those that only some configurations have, too."""
    wanted = re.findall(r"^    } (\w+) @ 0x(\w\w);", description.SOURCE.read_text(), re.MULTILINE)
    found = re.findall(r"^\| `0x(\w\w)` \| `(\w+)` \|", registers_page.page(), re.MULTILINE)
    assert wanted
    assert list(dict.fromkeys((name, at) for at, name in found)) == wanted


def test_another_table_is_replaced(project: Path, tmp_path: Path) -> None:
    text = (project / registers_page.DOCUMENT).read_text()
    path = tmp_path / registers_page.DOCUMENT
    path.parent.mkdir()
    path.write_text(text.replace("`GEOMETRY` | `WIDTH`", "`GEOMETRY` | `BREADTH`"))
    assert path.read_text() != text
    registers_page.main(tmp_path)
    assert path.read_text() == text


def test_without_the_document(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=re.escape("axi.md' is not there")):
        registers_page.main(tmp_path)
