"""Pages from templates: what is escaped, how numbers are written, and what is refused."""

from collections.abc import Iterator
from importlib.resources import files

import jinja2
import pytest

from softdepth.templates import render


@pytest.fixture(scope="module")
def package(tmp_path_factory) -> Iterator[str]:
    """A package with two templates that say the same."""
    folder = tmp_path_factory.mktemp("packages") / "paged" / "templates"
    folder.mkdir(parents=True)
    (folder.parent / "__init__.py").touch()
    text = "# {{ title }}\n{% for number in numbers %}\n- {{ number | number(',.1f') }}\n{% endfor %}\n"
    for name in ("page.md", "page.html"):
        (folder / name).write_text(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder.parents[1])
        yield "paged"


def test_a_tag_on_its_own_line_leaves_no_line(package):
    assert render(package, "page.md", title="<a>", numbers=[1234.56, 0]) == "# <a>\n- 1,234.6\n- 0.0"


def test_values_are_escaped_in_html_alone(package):
    assert render(package, "page.html", title="<a>", numbers=[]) == "# &lt;a&gt;"


def test_a_name_without_a_value_is_an_error(package):
    with pytest.raises(jinja2.UndefinedError, match="title"):
        render(package, "page.md", numbers=[])


def test_a_table_has_words_to_the_left_and_numbers_to_the_right(tmp_path_factory, monkeypatch):
    folder = tmp_path_factory.mktemp("others") / "tabled" / "templates"
    folder.mkdir(parents=True)
    (folder.parent / "__init__.py").touch()
    shared = files("softdepth.studies") / "templates" / "tables.md"
    (folder / "tables.md").write_text(shared.read_text())
    (folder / "page.md").write_text("{% from 'tables.md' import grid %}\n{{ grid(['a', 'b'], 1, rows) }}\n")
    monkeypatch.syspath_prepend(folder.parents[1])
    rows = [["x", "1"], ["", "2"]]
    assert render("tabled", "page.md", rows=rows) == "| a | b |\n|---|---:|\n| x | 1 |\n|  | 2 |"


def test_bold_words_are_marked_and_what_is_around_them_is_escaped(tmp_path_factory, monkeypatch):
    folder = tmp_path_factory.mktemp("others") / "bold" / "templates"
    folder.mkdir(parents=True)
    (folder.parent / "__init__.py").touch()
    (folder / "page.html").write_text("{{ text | bold }}")
    monkeypatch.syspath_prepend(folder.parents[1])
    assert render("bold", "page.html", text="**a <b>** & c") == "<strong>a &lt;b&gt;</strong> &amp; c"
