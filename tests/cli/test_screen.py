"""Progress: a line now and then where there is no terminal."""

import io

import pytest
from rich.console import Console

from softdepth import screen


def test_plain_lines_where_there_is_no_terminal(capsys):
    with screen.progress("gateware", 200) as advance:
        for done in range(201):
            advance(done)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "gateware ..."
    told, last = lines[1:5], lines[5]
    for n, line in zip((40, 80, 120, 160), told, strict=True):
        assert line == f"gateware: {n} of 200 pixels ({n // 2} %), about 1 s left"
    assert last == "gateware: 200 of 200 pixels (100 %)"


def test_what_is_left_follows_from_what_it_took(capsys, monkeypatch):
    now = iter([0.0, 60.0])
    monkeypatch.setattr(screen.time, "monotonic", lambda: next(now))
    with screen.progress("gateware", 200) as advance:
        advance(50)
    assert capsys.readouterr().err.endswith("(25 %), about 3 min left\n")


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.2, "1 s"), (119, "119 s"), (150, "2 min"), (7200, "2 h 0 min"), (9000, "2 h 30 min")],
)
def test_durations(seconds, text):
    assert screen.duration(seconds) == text


def test_a_bar_on_a_terminal(monkeypatch):
    text = io.StringIO()
    terminal = Console(file=text, force_terminal=True, width=80)
    monkeypatch.setattr(screen, "console", lambda *, stderr: terminal)
    with screen.progress("gateware", 200) as advance:
        advance(100)
    assert "50%" in text.getvalue()
    assert "pixels (" not in text.getvalue()
