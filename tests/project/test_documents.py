"""The documents name what is there, and what they name is there."""

import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import BaseModel

from softdepth.cli.app import app
from softdepth.hdl.built import missing
from softdepth.run.report import FILES, Accuracy, Report, Scored
from softdepth.sim.frames import FramesResult
from softdepth.spec.config import PRESETS, Census, Compensation, Config, Gradient, Post, Sad
from tests.support.imports import modules

SOURCE = re.compile(r"`((?:[\w.-]+/)*[\w-]+\.py|(?:golden|hdl|sim|softdepth|tests)/[\w./-]*)`")
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


def test_every_preset_has_its_row_where_presets_are_measured(project):
    built = [name for name in PRESETS if not missing(Config.preset(name))]
    assert set(json.loads((project / "docs" / "benchmarks.json").read_text())["presets"]) == set(built)
    reading = (project / "docs" / "flow.md").read_text().split("<!-- reading:end -->")[0]
    for name in built:
        assert f"\n| {name} | " in (project / "docs" / "benchmarks.md").read_text(), name
        assert f"\n| `{name}`, " in reading, name


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


def test_sources_that_are_named_exist(project):
    """Paths as from the project's folder, and modules as they are imported."""
    known = modules()
    for document in documents(project):
        text = document.read_text()
        for path in re.findall(
            r"`((?:[\w.-]+/)*[\w-]+\.py|(?:golden|hdl|sim|softdepth|tests)/[\w./-]*)`", text
        ):
            if document.name != "CHANGELOG.md" and not path.startswith("NAME"):  # for a user's own
                assert (project / path).exists(), f"{document.name}: {path}"
        for name, parts in re.findall(r"^from (softdepth[\w.]*) import ([\w, ]+)$", text, re.MULTILINE):
            for part in parts.split(", "):
                source = known[name].read_text()
                assert f"{name}.{part}" in known or re.search(rf"\b{part}\b", source), (
                    f"{document.name}: {part}"
                )


def test_every_file_of_the_gateware_has_its_place_on_the_page(project):
    """By its name, or by its folder's."""
    named = set(re.findall(r"`(hdl/[\w./]+)`", (project / "docs" / "gateware.md").read_text()))
    files = {path.relative_to(project).as_posix() for path in (project / "hdl").rglob("[!_]*.py")}
    folders = tuple(name for name in named if name.endswith("/"))
    assert {file for file in files - named if not file.startswith(folders)} == set()
    assert "hdl/costs/" not in folders  # rooms are told file by file


def test_the_clocks_per_pixel_are_defined_in_one_way(project):
    """From the first pixel taken to the last, in the code as in the document."""
    text = (project / "docs" / "report.md").read_text()
    (row,) = (line for line in text.splitlines() if line.startswith("| `cycles_per_pixel`"))
    taken, cycles = np.array([10, 14, 18, 30]), np.array([50, 60, 70, 1000])
    stream = SimpleNamespace(taken=taken, cycles=cycles)
    assert FramesResult([], stream).cycles_per_pixel == pytest.approx((30 - 10) / 3)
    assert "from the first pixel taken to the last" in row


def test_tasks_that_are_named_exist(project):
    goals = set(re.findall(r"^([a-z-]+):", (project / "Makefile").read_text(), re.MULTILINE))
    for document in documents(project):
        for tasks in re.findall(r"(?:`|^)make ([a-z -]+)", document.read_text(), re.MULTILINE):
            named = re.split(r" {2,}", tasks)[0].split()
            assert set(named) <= goals, f"{document.name}: make {tasks}"


def test_the_index_and_the_site_lead_to_every_page(project):
    index = (project / "docs" / "index.md").read_text()
    linked = set(re.findall(r"\]\(([^)#]+)\)", index))
    pages = {path.name for path in (project / "docs").glob("*.md")} - {"index.md"}
    assert linked == {*pages, *(f"../{name}" for name in (*DOCUMENTS, "LICENSE"))}
    site = (project / "scripts" / "mkdocs.yml").read_text().split("\nnav:\n", 1)[1]
    listed = re.findall(r"([a-z-]+\.md)$", site, re.MULTILINE)
    assert len(listed) == len(set(listed))
    assert {*pages, "index.md"} <= set(listed)
    assert re.findall(r"^  - (\w+):", site, re.MULTILINE) == re.findall(r"^## (\w+)", index, re.MULTILINE)


def test_the_site_is_built_with_warnings_as_errors(project):
    assert "make docs" in (project / ".ci" / "run").read_text().splitlines()
    # --quiet would keep warnings from being counted.
    assert re.search(r"mkdocs build --strict --config", (project / "Makefile").read_text())


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["[gone](gone.md)", "[gone](cli.md#gone)", ""])
def test_the_site_fails_for_what_is_wrong(project, tmp_path, fault):
    for name in ("docs", "scripts"):
        shutil.copytree(project / name, tmp_path / name)
    for name in (*DOCUMENTS, "LICENSE"):
        shutil.copy(project / name, tmp_path)
    with (tmp_path / "docs" / "golden.md").open("a") as page:
        page.write(f"\n{fault}\n")
    command = [
        sys.executable,
        "-m",
        "mkdocs",
        "build",
        "-s",
        "-f",
        str(tmp_path / "scripts/mkdocs.yml"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode != 0) == bool(fault), done.stderr
    assert (tmp_path / "build" / "site" / "golden.html").exists() or fault


def test_the_version_has_its_section_in_the_changelog(project):
    version = tomllib.loads((project / "pyproject.toml").read_text())["project"]["version"]
    text = (project / "CHANGELOG.md").read_text()
    assert re.search(rf"(?m)^## \[{re.escape(version)}\] - \d{{4}}-\d\d-\d\d$", text)
    assert text.index("## [Unreleased]") < text.index(f"## [{version}]")
