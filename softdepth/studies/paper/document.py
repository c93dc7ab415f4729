"""``paper.json``: everything that the evaluation found, in one document."""

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

from pydantic import BaseModel

from softdepth.spec.config import OPERATORS, Operator
from softdepth.studies.paper import figure4, matchers, readings, scenes, table2
from softdepth.studies.paper.cells import Cell, metrics, rmse
from softdepth.studies.paper.figure4 import Point
from softdepth.studies.paper.published import SCENES
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.speed import Speeds
from softdepth.studies.paper.table2 import Row, Summary
from softdepth.studies.paper.work import RULE_OPERATOR, RULE_SCENE, Maps, rule_cells

SCHEMA = 1


class Score(BaseModel):
    """A map's standard metrics, in its own view, beside the paper's RMSE as its row draws it."""

    scene: str
    method: str
    operator: Operator | None
    engine: str
    view: str
    paper_rmse: float
    metrics: dict[str, float | None]


class ReadingText(BaseModel):
    """A reading, for people (`facts`, `why`) and for programs (`fields`)."""

    name: str
    why: str
    facts: dict[str, str]
    fields: dict[str, Any]


class Document(BaseModel):
    """The JSON that ``softdepth paper`` writes; ``docs/paper.md`` says what it holds.

    Keys are only ever added; a change of meaning raises `SCHEMA`.
    """

    schema_version: int = SCHEMA
    readings: dict[str, ReadingText]
    table2: list[Row]
    one_view: list[Row]
    summary: Summary
    metrics: list[Score]
    figure4: list[Point]
    figure5: list[Score]
    speed: Speeds
    opencv: dict[str, str]
    tools: dict[str, str]


def assemble(maps: Maps, reading: Reading, speeds: Speeds) -> Document:
    """Score all maps and sum up; `reading` is that of the FMCDM rows."""
    rows = table2.table(maps, reading)
    plain = table2.one_view(maps, reading)
    tried = {
        each.name: [r for r in table2.table(maps, each) if r.method == "FMCDM"]
        for each in readings.FMCDM.values()
    }
    used = {"SAD": readings.SAD, "FMCDM": reading, "[11]": readings.PROTOTYPE}
    used |= {f"other {each.name}": each for each in readings.FMCDM.values() if each != reading}
    return Document(
        readings={key: text(each) for key, each in used.items()},
        table2=rows,
        one_view=plain,
        summary=table2.summarise(rows, plain, tried, table2.sad_against_its_own_truth(maps)),
        metrics=scores(maps, reading),
        figure4=figure4.points(scenes.load(RULE_SCENE), tuple(readings.FMCDM.values())),
        figure5=_rule(maps, reading),
        speed=speeds,
        opencv={m: matchers.parameters_text(m) for m in readings.MATCHERS},
        tools={name: version(name) for name in ("softdepth", "numpy", "opencv-python-headless")},
    )


def text(reading: Reading) -> ReadingText:
    """A reading as reports hold it."""
    return ReadingText(name=reading.name, why=reading.why, facts=reading.describe(), fields=reading.plain())


def scores(maps: Maps, reading: Reading) -> list[Score]:
    """The standard metrics of every map but the other readings', scene by scene."""
    plans: list[tuple[str, Reading, Sequence[Operator | None]]] = [
        ("SAD", readings.SAD, [None]),
        ("[11]", readings.PROTOTYPE, list(OPERATORS)),
        ("FMCDM", reading, list(OPERATORS)),
    ]
    for window in (3, max(reading.windows)):
        plans.append((f"SAD {window}x{window}", readings.one_view(reading, window), [None]))
    plans += [(matchers.TITLES[m], readings.matcher(reading, m), [None]) for m in readings.MATCHERS]
    return [
        score(maps, method, Cell(scene, plan, operator, engine))
        for scene in SCENES
        for method, plan, operators in plans
        for operator in operators
        for engine in ("float", "fixed", "rtl")
        if Cell(scene, plan, operator, engine) in maps
    ]


def score(maps: Maps, method: str, cell: Cell) -> Score:
    """One map's scores."""
    scene = scenes.load(cell.scene, cell.reading.size)
    found = maps[cell]
    flat = metrics(found, cell.reading, scene).as_dict()
    flat.pop("paper_rmse")  # drawn without the reading's index; `rmse` draws it as the row does
    return Score(
        scene=cell.scene,
        method=method,
        operator=cell.operator,
        engine=cell.engine,
        view=cell.reading.view,
        paper_rmse=rmse(found, cell.reading, scene),
        metrics=flat,
    )


def _rule(maps: Maps, reading: Reading) -> list[Score]:
    return [score(maps, name, cell) for name, cell in figure5(reading).items()]


def figure5(reading: Reading) -> dict[str, Cell]:
    """Fig. 5's maps: SAD, and soft-min I without and with the compensating rule."""
    cells = {
        "SAD": Cell(RULE_SCENE, readings.SAD, None, "float"),
        "no rule": Cell(RULE_SCENE, reading, RULE_OPERATOR, "float"),
    }
    for cell in rule_cells(reading):
        window = reading.windows[cell.judge - 1]
        cells[f"rule judged by {window}x{window}"] = cell
    return cells
