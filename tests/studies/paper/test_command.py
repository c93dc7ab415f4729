"""``softdepth paper`` as a whole, on small synthetic scenes in Middlebury's place."""

import json
import re
from html.parser import HTMLParser
from types import SimpleNamespace

import pytest

from softdepth.cli.app import main
from softdepth.golden import fixed_model
from softdepth.golden.maps import DisparityMap
from softdepth.sim import frames
from softdepth.spec.config import OPERATORS
from softdepth.spec.errors import InputError
from softdepth.studies import markers
from softdepth.studies.paper import readings, work
from softdepth.studies.paper.document import Document
from softdepth.studies.paper.evaluation import FILES
from softdepth.studies.paper.published import SCENES


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """One cache for the module: the first test fills it."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def command(tiny, shared, monkeypatch, capfd):
    """Run ``softdepth paper`` in this process; gives its exit code and both streams."""
    monkeypatch.setenv("SOFTDEPTH_CACHE", str(shared))

    def run(*arguments):
        code = main(["paper", "--jobs", "1", *map(str, arguments)])
        return code, *capfd.readouterr()

    return run


@pytest.fixture
def written(command, tmp_path):
    out = tmp_path / "out"
    code, text, _ = command("-o", out)
    assert code == 0
    return out, text


def test_files_and_screen(written):
    out, text = written
    assert {file.name for file in out.iterdir()} == set(FILES)
    for words in ("published", "Soft-min II", "nest-357", "compares two views", "Conclusion 4"):
        assert words in text


def test_json_schema(written):
    data = json.loads((written[0] / "paper.json").read_text())
    document = Document.model_validate(data)
    assert document.schema_version == 1
    cells = [(r["scene"], r["method"], r["operator"]) for r in data["table2"]]
    expected = []
    for scene in SCENES:
        expected.append((scene, "SAD", None))
        expected += [(scene, method, o) for method in ("[11]", "FMCDM") for o in OPERATORS]
    assert cells == expected
    for row in data["table2"]:
        assert {"scene", "method", "operator", "published", "float", "fixed", "rtl"} <= row.keys()
        assert row["rtl"] is None
        assert (row["fixed"] is None) == (row["method"] == "[11]")
        assert row["deviation"] == pytest.approx(row["float"] - row["published"])
    summary = data["summary"]
    deviations = [abs(r["deviation"]) for r in data["table2"] if r["method"] == "SAD"]
    assert summary["sad_max_deviation"] == pytest.approx(max(deviations))
    assert summary["readings"].keys() == readings.FMCDM.keys()
    assert summary["fmcdm_mean_deviation_14"] == summary["readings"]["nest-357"]
    assert [s["operator"] for s in data["speed"]["operators"]] == list(OPERATORS)
    methods = {s["method"] for s in data["metrics"]}
    assert methods == {"SAD", "[11]", "FMCDM", "SAD 3x3", "SAD 7x7", "OpenCV StereoBM", "OpenCV SGBM"}
    for score in data["metrics"]:
        assert {"bad1", "bad2", "mae", "rmse", "nonocc_bad1", "nonocc_rmse"} <= score["metrics"].keys()
    row = next(r for r in data["table2"] if (r["scene"], r["operator"]) == ("cones", "prod"))
    scored = next(s for s in data["metrics"] if (s["scene"], s["operator"]) == ("cones", "prod"))
    assert (row["method"], row["float"]) == (scored["method"], scored["paper_rmse"])


class _Addresses(HTMLParser):
    """Every address that a page would load or lead to, and its pictures."""

    def __init__(self):
        super().__init__()
        self.found: list[str] = []
        self.tags: set[str] = set()

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        self.found += [
            str(value) for name, value in attrs if name in ("src", "href", "srcset", "data", "action")
        ]


def test_the_page_loads_nothing(written):
    text = (written[0] / "paper.html").read_text()
    page = _Addresses()
    page.feed(text)
    assert not page.tags & {"script", "link", "iframe", "object", "embed"}
    assert all(address.startswith("data:image/png;base64,") for address in page.found)
    # Table 3: two methods, three scenes, every operator's map and error; two curves; Fig. 5.
    assert len(page.found) == 2 * 3 * 5 * 2 + 2 + 5
    assert "@import" not in text
    assert "url(" not in text
    assert not re.search(r"https?://", text)


def test_markdown_tables_are_rectangular(written):
    tables = re.findall(r"(?:^\|.*\|\n?)+", (written[0] / "paper.md").read_text(), re.MULTILINE)
    assert len(tables) == 5
    for table in tables:
        assert len({line.count("|") for line in table.splitlines()}) == 1


def test_a_second_run_computes_nothing(written, command, monkeypatch, tmp_path):
    monkeypatch.setattr(work, "compute", lambda *_: pytest.fail("computed again"))
    monkeypatch.setattr("softdepth.studies.paper.speed.measure", lambda *_: pytest.fail("measured again"))
    assert command("-o", tmp_path / "again")[0] == 0
    assert (tmp_path / "again" / "paper.json").read_text() == (written[0] / "paper.json").read_text()


def test_no_cache_computes(written, command, monkeypatch, tmp_path):
    def compute(*_):
        raise InputError("computed", "never")

    monkeypatch.setattr(work, "compute", compute)
    assert command("-o", tmp_path / "again", "--no-cache")[0] == 2
    assert not (tmp_path / "again").exists()


def test_a_document_is_renewed_between_its_markers(written, command, tmp_path):
    begin, end = markers.markers("paper")
    page = tmp_path / "page.md"
    page.write_text(f"mine\n{begin}\nold figures\n{end}\nmine too\n")
    assert command("-o", tmp_path / "again", "--document", page)[0] == 0
    text = page.read_text()
    assert text.startswith(f"mine\n{begin}\n### Findings")
    assert text.endswith(f"{end}\nmine too\n")
    assert "old figures" not in text
    code, _, err = command("-o", tmp_path / "again", "--document", tmp_path / "none.md")
    assert code == 2
    assert "none.md" in err


@pytest.fixture
def simulator(monkeypatch):
    """The fixed model in the simulator's place; `flip` pixels of each frame come out wrong."""

    class Simulator:
        flip = 0

        def __call__(self, config, pairs, *, progress=None):
            ((left, right),) = pairs
            found = fixed_model.disparity(left, right, config)
            disparity = found.disparity.copy()
            height, width = disparity.shape
            disparity[height // 2, width // 2 : width // 2 + self.flip] ^= 1
            return SimpleNamespace(maps=[DisparityMap(disparity, found.code)])

    simulator = Simulator()
    monkeypatch.setattr(frames, "run_frames", simulator)
    return simulator


def test_chosen_cells_go_through_the_gateware(written, command, simulator, tmp_path):
    out = tmp_path / "rtl"
    arguments = ("--engine", "rtl", "--scene", "venus", "--operator", "sad", "--operator", "mean")
    code, text, _ = command("-o", out, *arguments)
    assert code == 0
    rows = json.loads((out / "paper.json").read_text())["table2"]
    ran = [r for r in rows if r["rtl"] is not None]
    assert [(r["scene"], r["method"], r["operator"]) for r in ran] == [
        ("venus", "SAD", None),
        ("venus", "FMCDM", "mean"),
    ]
    assert all(r["rtl"] == r["fixed"] and r["rtl_mismatches"] == 0 for r in ran)
    assert "Through the simulated gateware went 2 of the table's cells: 0 pixels differ" in text


def test_gateware_that_differs_is_an_error(written, command, simulator, tmp_path):
    simulator.flip = 3
    arguments = ("--engine", "rtl", "--scene", "cones", "--operator", "min")
    code, _, err = command("-o", tmp_path / "rtl", *arguments)
    assert code == 1
    assert "gateware and fixed-point model differ in 3 pixels" in err


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("--reading", "tea-leaves"), "unknown reading 'tea-leaves'; use one of nest-357, nest-579"),
        (("--scene", "teddy"), "--scene teddy without --engine rtl"),
        (("--engine", "rtl", "--scene", "moon"), "unknown --scene 'moon'; use one of teddy, cones, venus"),
        (("--engine", "rtl", "--operator", "max"), "unknown --operator 'max'; use one of sad, min"),
        (("--jobs", "0"), "--jobs"),
    ],
)
def test_bad_options(command, tmp_path, arguments, problem):
    code, _, err = command("-o", tmp_path / "out", *arguments)
    assert code == 2
    assert problem in err
    assert not (tmp_path / "out").exists()
