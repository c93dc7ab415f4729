"""The documents name what is there, and what they name is there."""

import re
from pathlib import Path

import pytest
from pydantic import BaseModel

from softdepth.cli.app import app
from softdepth.run.report import FILES, Accuracy, Report, Scored
from softdepth.spec.config import PRESETS, Census, Compensation, Config, Gradient, Post, Sad

DOCUMENTS = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")


def documents(project: Path) -> list[Path]:
    return [*(project / name for name in DOCUMENTS), *sorted((project / "docs").rglob("*.md"))]


def table_keys(text: str) -> set[str]:
    """Every `code` word in the first column of a Markdown table."""
    rows = re.findall(r"^\|([^|]*)\|", text, re.MULTILINE)
    return {key for row in rows for key in re.findall(r"`([^`]+)`", row)}


def section(text: str, heading: str) -> str:
    return text.split(f"{heading}\n", 1)[1].split("\n## ", 1)[0]


@pytest.mark.parametrize(
    ("heading", "model"),
    [
        ("## Keys", Config),
        ("### sad", Sad),
        ("### census", Census),
        ("### gradient", Gradient),
        ("### compensation", Compensation),
        ("### post", Post),
    ],
)
def test_every_configuration_key_is_documented(project, heading, model: type[BaseModel]):
    text = section((project / "docs" / "configuration.md").read_text(), heading)
    if heading.startswith("###"):
        text = text.split("\n### ", 1)[0]
    assert set(model.model_fields) <= table_keys(text)
    if heading != "## Keys":
        assert table_keys(text) == set(model.model_fields)


def test_every_preset_is_documented(project):
    text = (project / "docs" / "configuration.md").read_text()
    assert table_keys(section(text, "## Presets")) == set(PRESETS)


def test_the_example_configuration_is_valid(project, tmp_path):
    text = (project / "docs" / "configuration.md").read_text()
    example = re.search(r"```toml\n(.*?)```", text, re.DOTALL)
    assert example
    path = tmp_path / "core.toml"
    path.write_text(example[1])
    config = Config.load(path).override(["lanes=16", "criteria.1.window=7"])
    assert (config.disparities, config.lanes, config.windows) == (96, 16, (3, 7, 9))


def test_every_report_key_and_file_is_documented(project):
    keys = table_keys((project / "docs" / "report.md").read_text())
    assert keys == {*Report.model_fields, *Accuracy.model_fields, *Scored.model_fields, *FILES, "report.json"}


def test_every_command_is_documented(project):
    text = (project / "docs" / "cli.md").read_text()
    named = {match for key in table_keys(text) for match in re.findall(r"^softdepth ([a-z]+)", key)}
    assert named == {command.name for command in app.registered_commands}


def test_links_lead_somewhere(project):
    for document in documents(project):
        for target in re.findall(r"\]\(([^)#]+)\)", document.read_text()):
            if not target.startswith("https://"):
                assert (document.parent / target).exists(), f"{document.name}: {target}"


def test_tasks_that_are_named_exist(project):
    goals = set(re.findall(r"^([a-z-]+):", (project / "Makefile").read_text(), re.MULTILINE))
    for document in documents(project):
        for tasks in re.findall(r"(?:`|^)make ([a-z -]+)", document.read_text(), re.MULTILINE):
            named = re.split(r" {2,}", tasks)[0].split()
            assert set(named) <= goals, f"{document.name}: make {tasks}"
