"""The evaluation as one self-contained page: tables, findings, and every picture inside it."""

from html import escape
from itertools import groupby

from softdepth.spec.config import OPERATORS
from softdepth.studies import webpage
from softdepth.studies.paper import figures, pages, readings, scenes
from softdepth.studies.paper.cells import Cell, rmse
from softdepth.studies.paper.document import Document, figure5
from softdepth.studies.paper.published import SCENES, TITLES
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.work import RULE_SCENE, Maps

_SOURCE = (
    "M. V. Bobyr, N. A. Milostnaya, S. V. Gorbachev, S. Bhattacharyya, J. Cao: The Method of Depth Map"
    " Calculating Based on Soft Operators in Multi-Agent Robotic Stereo Vision Systems, 2021"
)


def page(document: Document, maps: Maps, reading: Reading) -> str:
    """The whole page as HTML text; it loads nothing from anywhere."""
    parts = [
        "<h1>The paper's evaluation, regenerated</h1>",
        f'<p class="lead">{escape(_SOURCE)}. Written by <code>softdepth paper</code>.</p>',
        webpage.section("Findings", webpage.bullets(pages.findings(document))),
        webpage.section("Table 2: the paper's RMSE, gray levels", _table2(document)),
        webpage.section(
            "The same comparison in one view",
            "<p>Plain SAD in the view, truth, border and drawing of the FMCDM rows.</p>"
            + _one_view(document),
        ),
        webpage.section("The readings", _readings(document)),
        webpage.section("Table 3: the maps", _table3(maps, reading)),
        webpage.section("Fig. 4: one pixel's cost", _figure4(document)),
        webpage.section("Fig. 5: the compensating rule", _figure5(document, maps, reading)),
        webpage.section("Standard metrics", _metrics(document)),
        webpage.section("Speed", _speed(document)),
    ]
    return webpage.page("softdepth: the paper's evaluation", parts)


def _table2(document: Document) -> str:
    rows, before = [], ("", "")
    for row in document.table2:
        here = (row.scene, row.method)
        names = [
            row.scene.capitalize() if row.scene != before[0] else "",
            row.method if here != before else "",
        ]
        *values, deviation = pages.figures(row)
        far = row.deviation is not None and abs(row.deviation) > 1.5
        cells = [webpage.cell(text) for text in (*names, pages.operator(row.operator))]
        cells += [webpage.cell(value, "n") for value in values]
        cells.append(webpage.cell(deviation, "n off" if far else "n"))
        rows.append(webpage.row(cells, first=row.scene != before[0]))
        before = here
    return webpage.grid(["scene", "method", "operator", *pages.COLUMNS], rows, numbers=3)


def _one_view(document: Document) -> str:
    rows = []
    for row in document.one_view:
        names = (webpage.cell(row.scene.capitalize()), webpage.cell(row.method))
        values = (webpage.cell(pages.figure(v), "n") for v in (row.float, row.fixed))
        rows.append(webpage.row((*names, *values)))
    return webpage.grid(["scene", "method", "float", "fixed"], rows, numbers=2)


def _readings(document: Document) -> str:
    keys = dict.fromkeys(key for each in document.readings.values() for key in each.facts)
    rows = [
        webpage.row(
            [webpage.cell(key), *(webpage.cell(r.facts.get(key, "-")) for r in document.readings.values())]
        )
        for key in keys
    ]
    rows.append(
        webpage.row([webpage.cell("why"), *(webpage.cell(r.why) for r in document.readings.values())])
    )
    head = ["", *(f"{key}: {each.name}" for key, each in document.readings.items())]
    return webpage.grid(head, rows, numbers=len(head))


def _table3(maps: Maps, reading: Reading) -> str:
    maximum = reading.candidates - 1
    text = [
        f"<p>Float model. Above the disparity, 0 (blue) to {maximum} (red) px, with the paper's RMSE; below,"
        f" the error in its own view ({reading.view}).</p>",
        webpage.legend(),
    ]
    for title, plan in (("FMCDM", reading), ('"[11]", the reading tried', readings.PROTOTYPE)):
        for name in SCENES:
            scene = scenes.load(name, plan.size)
            text.append(f"<h3>{title}: {name.capitalize()}</h3>")
            found = [(o, maps[Cell(name, plan, o, "float")]) for o in OPERATORS]
            row = [
                webpage.figure(figures.depth(m, maximum), f"{TITLES[o]}, {rmse(m, plan, scene):.2f}")
                for o, m in found
            ]
            row += [
                webpage.figure(figures.errors(m, scene.truths[plan.view]), f"{TITLES[o]}, error")
                for o, m in found
            ]
            text.append(webpage.pictures(row, len(OPERATORS)))
    return "\n".join(text)


def _figure4(document: Document) -> str:
    parts = [
        "<p>Teddy, right view, soft-min I, T = 5000, at x = 254, y = 68; pixels and candidates are counted"
        " from one. The paper has 62 before the rule and 16 after it. Where the rule fires, all inputs become"
        " 2T.</p>"
    ]
    for windows, group in groupby(document.figure4, key=lambda p: p.windows):
        text = f"windows {'/'.join(map(str, windows))}"
        source = figures.curves(list(group))
        parts.append(f'<h3>{text}</h3><img class="curve" src="{source}" alt="{text}">')
    return "\n".join(parts)


def _figure5(document: Document, maps: Maps, reading: Reading) -> str:
    row = []
    for (name, cell), score in zip(figure5(reading).items(), document.figure5, strict=True):
        numbers = f"paper's RMSE {score.paper_rmse:.2f}, bad-1.0 {pages.figure(score.metrics['bad1'])} %"
        row.append(webpage.figure(figures.gray(maps[cell], cell.reading.first), f"{name}: {numbers}"))
    truth = scenes.load(RULE_SCENE, reading.size).truths[reading.truth]
    row.append(webpage.figure(figures.truth_gray(truth), f"truth of the {reading.truth} view"))
    return (
        "<p>Drawn in gray levels, as the paper does. The white dots are false near objects.</p>"
        + webpage.pictures(row, len(row))
    )


def _metrics(document: Document) -> str:
    head = ["scene", "method", "operator", "engine", "view", "paper's RMSE"]
    head += ["bad-1.0 %", "bad-2.0 %", "MAE px", "RMS px"]
    rows, before = [], ""
    for score in document.metrics:
        scene, method, operator, *numbers = pages.score_row(score)
        names = (scene if score.scene != before else "", method, operator, score.engine, score.view)
        cells = [*map(webpage.cell, names), *(webpage.cell(n, "n") for n in numbers)]
        rows.append(webpage.row(cells, first=score.scene != before))
        before = score.scene
    parameters = "; ".join(f"{name}: {text}" for name, text in document.opencv.items())
    return (
        f"<p>{escape(pages.METRICS_TEXT)}</p>"
        + webpage.grid(head, rows, numbers=5)
        + f"<p>{escape(parameters)}.</p>"
    )


def _speed(document: Document) -> str:
    head = ["operator", "float, ns", "fixed, ns", "lanes", "clocks per pixel", "multipliers", "LUTs a lane"]
    rows = (
        webpage.row([webpage.cell(name), *(webpage.cell(n, "n") for n in rest)])
        for name, *rest in pages.speed_rows(document.speed)
    )
    return f"<p>{escape(pages.speed_text(document.speed))}</p>" + webpage.grid(head, rows, numbers=1)
