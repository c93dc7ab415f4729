"""Progress: a line now and then where there is no terminal."""

import io

from rich.console import Console

from softdepth import screen


def test_plain_lines_where_there_is_no_terminal(capsys):
    with screen.progress("gateware", 200) as advance:
        for done in range(201):
            advance(done)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "gateware ..."
    assert lines[1:] == [f"gateware: {n} of 200 pixels ({n // 2} %)" for n in (40, 80, 120, 160, 200)]


def test_a_bar_on_a_terminal(monkeypatch):
    text = io.StringIO()
    terminal = Console(file=text, force_terminal=True, width=80)
    monkeypatch.setattr(screen, "console", lambda *, stderr: terminal)
    with screen.progress("gateware", 200) as advance:
        advance(100)
    assert "50%" in text.getvalue()
    assert "pixels (" not in text.getvalue()
