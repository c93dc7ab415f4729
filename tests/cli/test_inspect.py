"""``softdepth inspect``, and what ``run`` says of a pair."""

import json

import pytest

from softdepth.golden.data.synthetic import generate
from tests.cli.conftest import Files


@pytest.fixture
def files(tmp_path) -> Files:
    """A 200x120 scene with disparities below 16."""
    return Files.written(
        generate("random", width=200, height=120, disparities=16, seed=3), tmp_path / "input"
    )


def test_a_sound_pair_gets_its_figures_and_no_finding(softdepth, files):
    outcome = softdepth("inspect", files.left, files.right)
    assert outcome.code == 0, outcome.err
    assert outcome.out.splitlines()[-1] == "nothing is wrong with this pair"
    assert "200 x 120 pixels" in outcome.out
    assert "0 .. 31, 32 candidates" in outcome.out


def test_findings_are_lines_and_no_error(softdepth, files):
    outcome = softdepth("inspect", files.right, files.left)
    assert outcome.code == 0
    assert outcome.out.splitlines()[-1].startswith("left and right are exchanged: ")
    assert outcome.err == ""


def test_json_holds_what_is_documented(softdepth, files, project):
    outcome = softdepth("inspect", files.right, files.left, "--json")
    found = json.loads(outcome.out)
    assert [finding["code"] for finding in found["findings"]] == ["exchanged"]
    assert set(found["findings"][0]) == {"code", "figures", "problem", "remedy"}
    text = (project / "docs" / "inspect.md").read_text().split("## JSON")[1].split("\n## ")[0]
    keys = {*found, *found["findings"][0], *found["range"]}
    for part in (found["measured"], *filter(lambda p: isinstance(p, dict), found["measured"].values())):
        keys |= set(part)
    assert {key for key in keys if f"`{key}`" not in text} == set()


def test_every_code_is_documented(project):
    from typing import get_args

    from softdepth.inspect.findings import Code

    text = (project / "docs" / "inspect.md").read_text()
    assert {code for code in get_args(Code) if f"| `{code}` |" not in text} == set()


def test_a_needless_range_is_told_where_one_was_asked_for(softdepth, files):
    assert "larger than needed" not in softdepth("inspect", files.left, files.right).out
    asked = softdepth("inspect", files.left, files.right, "--disparities", 128).out
    assert "larger than needed" in asked


def test_a_range_that_is_too_small_is_told(softdepth, files):
    outcome = softdepth("inspect", files.left, files.right, "--disparities", 8, "--lanes", 1)
    assert "the range is too small" in outcome.out
    assert outcome.out.rstrip().endswith("use --disparities 24")


def test_run_notes_each_finding_once(softdepth, files, tmp_path):
    arguments = ("--disparities", 16, "--lanes", 4, "--engine", "fixed", "-o", tmp_path / "out")
    outcome = softdepth("run", files.right, files.left, *arguments)
    assert outcome.code == 0
    notes = [line for line in outcome.err.splitlines() if line.startswith("note: left and right are exch")]
    assert len(notes) == 1
    sound = softdepth("run", files.left, files.right, *arguments)
    assert not [line for line in sound.err.splitlines() if "exchanged" in line or "rows" in line]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["left.png"],
        ["--dataset", "motorcycle", "--side-by-side"],
        ["--side-by-side", "--top-bottom", "x"],
    ],
)
def test_a_wrong_call_is_one_line(softdepth, arguments):
    outcome = softdepth("inspect", *arguments)
    assert outcome.code == 2
    assert outcome.error
