"""The evaluation as one self-contained page: tables, findings, and every picture inside it."""

from itertools import groupby
from typing import NamedTuple

from softdepth.golden.score.pictures import ERROR_COLOURS
from softdepth.spec.config import OPERATORS
from softdepth.studies.paper import figures, pages, readings, scenes
from softdepth.studies.paper.cells import Cell, rmse
from softdepth.studies.paper.document import Document, figure5
from softdepth.studies.paper.published import SCENES, TITLES
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.work import RULE_SCENE, Maps
from softdepth.templates import render

FAR = 1.5
"""Gray levels of deviation from the published figure beyond which a cell is marked."""


class Picture(NamedTuple):
    """A picture as a data URL, and what it shows."""

    source: str
    caption: str


class Row(NamedTuple):
    """A scene's pictures in Table 3: the maps in a first row of so many columns, their errors below."""

    title: str
    pictures: list[Picture]
    columns: int


def page(document: Document, maps: Maps, reading: Reading) -> str:
    """The whole page as HTML text; it loads nothing from anywhere."""
    scores = [(pages.score_row(score), score) for score in document.metrics]
    text = render(
        "softdepth.studies",
        "paper.html",
        **pages.tables(document),
        far=[row.deviation is not None and abs(row.deviation) > FAR for row in document.table2],
        maximum=reading.candidates - 1,
        view=reading.view,
        colours=ERROR_COLOURS,
        table3=_table3(maps, reading),
        figure4=_figure4(document),
        figure5=_figure5(document, maps, reading),
        metrics=[[*row[:3], score.engine, score.view, *row[3:]] for row, score in scores],
    )
    return text + "\n"


def _table3(maps: Maps, reading: Reading) -> list[Row]:
    rows = []
    for title, plan in (("FMCDM", reading), ('"[11]", the reading tried', readings.PROTOTYPE)):
        for name in SCENES:
            scene = scenes.load(name, plan.size)
            found = [(o, maps[Cell(name, plan, o, "float")]) for o in OPERATORS]
            pictures = [
                Picture(figures.depth(m, reading.candidates - 1), f"{TITLES[o]}, {rmse(m, plan, scene):.2f}")
                for o, m in found
            ]
            pictures += [
                Picture(figures.errors(m, scene.truths[plan.view]), f"{TITLES[o]}, error") for o, m in found
            ]
            rows.append(Row(f"{title}: {name.capitalize()}", pictures, len(OPERATORS)))
    return rows


def _figure4(document: Document) -> list[Picture]:
    return [
        Picture(figures.curves(list(group)), f"windows {'/'.join(map(str, windows))}")
        for windows, group in groupby(document.figure4, key=lambda point: point.windows)
    ]


def _figure5(document: Document, maps: Maps, reading: Reading) -> list[Picture]:
    row = []
    for (name, cell), score in zip(figure5(reading).items(), document.figure5, strict=True):
        numbers = f"paper's RMSE {score.paper_rmse:.2f}, bad-1.0 {pages.figure(score.metrics['bad1'])} %"
        row.append(Picture(figures.gray(maps[cell], cell.reading.first), f"{name}: {numbers}"))
    truth = scenes.load(RULE_SCENE, reading.size).truths[reading.truth]
    return [*row, Picture(figures.truth_gray(truth), f"truth of the {reading.truth} view")]
