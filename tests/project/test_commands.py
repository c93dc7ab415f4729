"""Every command that a document shows can be given: all are parsed, and those that are cheap are run."""

import re
import shlex
import shutil
from pathlib import Path

import pytest
import typer.main
from typer.exceptions import TyperException

from softdepth.cli.app import app, main
from softdepth.golden.data.synthetic import generate
from softdepth.golden.data.writers import write_pfm, write_picture

PROJECT = Path(__file__).resolve().parent.parent.parent
PROGRAM = re.compile(r"^(?:\.venv/bin/)?softdepth (.+)$")
CHEAP = ("info", "presets", "datasets", "inspect", "--version")
"""Commands that take a moment, however they are called; `run` does so with a model and small images."""
MODELS = ({"--engine", "fixed"}, {"--engine", "float"})


def examples(text: str) -> list[str]:
    """The program's commands in a document's ``sh`` blocks and in its tables and sentences."""
    found = []
    for block in re.findall(r"^ *```sh\n(.*?)^ *```", text, re.DOTALL | re.MULTILINE):
        lines = block.replace("\\\n", " ").splitlines()
        found += [match[1] for line in lines if (match := PROGRAM.match(line.split("  #")[0].strip()))]
    inline = [
        match[1]
        for code in re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.DOTALL))
        if (match := PROGRAM.match(code))
    ]
    return [command for command in (*found, *inline) if not re.search(r"\bCOMMAND\b|\.\.\.", command)]


def documented() -> list[tuple[str, str]]:
    """Every command with the document that it stands in."""
    paths = [PROJECT / "README.md", PROJECT / "CONTRIBUTING.md", *sorted((PROJECT / "docs").rglob("*.md"))]
    return [(path.name, command) for path in paths for command in examples(path.read_text())]


def words(command: str) -> list[str]:
    """A command's words, up to a pipe."""
    return shlex.split(command.partition(" | ")[0].replace("/dev/ttyUSB0", "/dev/null"))


def parse(command: str) -> None:
    """Read a command as the program would, without doing it; raises typer's error for what is not known.

    A sentence may name a command or an option without what must follow it.
    """
    name, *arguments = words(command)
    group = typer.main.get_command(app)
    if name.startswith("-"):
        assert any(name in parameter.opts for parameter in group.params), name
        return
    try:
        group.commands[name].make_context(name, arguments)
    except TyperException as error:
        if not re.search(r"^Missing option|requires an argument", error.format_message()):
            raise


def runs(command: str) -> bool:
    name, *arguments = words(command)
    placeholder = any(re.fullmatch(r"[A-Z][A-Z_]+", word) for word in arguments)
    model = name == "run" and any(kind <= set(arguments) for kind in MODELS)
    named = name != "inspect" or any(word.endswith(".png") for word in arguments)
    return not placeholder and (model or (name in CHEAP and named))


@pytest.mark.parametrize(("document", "command"), documented())
def test_every_command_in_a_document_is_known(document, command):
    parse(command)


def test_a_command_that_is_not_known_is_found():
    with pytest.raises(TyperException, match="No such option"):
        parse("run left.png right.png --lains 4")
    with pytest.raises(KeyError, match="rum"):
        parse("rum left.png right.png")
    assert examples("```sh\n.venv/bin/softdepth run a b  # so\n```\nand `softdepth info`, `softdepth`") == [
        "run a b",
        "info",
    ]


def test_the_documents_show_every_command():
    shown = {words(command)[0] for _, command in documented()}
    assert {command.name for command in app.registered_commands} <= shown


@pytest.fixture
def workplace(tmp_path, monkeypatch) -> Path:
    """A folder with the files that the examples name."""
    pair = generate("random", width=64, height=40, disparities=8, seed=1)
    assert pair.truth is not None
    for name in ("left", "right"):
        write_picture(tmp_path / f"{name}.png", getattr(pair, name))
    write_pfm(tmp_path / "truth.pfm", pair.truth.disparity)
    shutil.copy(tmp_path / "left.png", tmp_path / "both.png")
    (tmp_path / "core.toml").write_text("lanes = 8\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("workplace")
@pytest.mark.parametrize("command", sorted({each for _, each in documented() if runs(each)}))
def test_every_cheap_command_works(command):
    assert main(words(command)) == 0
