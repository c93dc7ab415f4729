"""The evaluation as one self-contained page: tables, findings, and every picture inside it."""

import re
from collections.abc import Iterable, Sequence
from html import escape
from itertools import groupby

from softdepth.golden.score.pictures import ERROR_COLOURS
from softdepth.spec.config import OPERATORS
from softdepth.studies.paper import figures, pages, readings, scenes
from softdepth.studies.paper.cells import Cell, rmse
from softdepth.studies.paper.document import Document, figure5
from softdepth.studies.paper.published import SCENES, TITLES
from softdepth.studies.paper.readings import Reading
from softdepth.studies.paper.work import RULE_SCENE, Maps

_STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, sans-serif; color: #1f2328; background: #fff; margin: 0 auto;
  max-width: 1180px; padding: 24px 28px 64px; }
h1 { font-size: 26px; margin: 8px 0 2px; } h2 { font-size: 19px; margin: 40px 0 8px;
  border-bottom: 1px solid #d1d9e0; padding-bottom: 4px; } h3 { font-size: 15px; margin: 22px 0 6px; }
p.lead { color: #59636e; margin-top: 0; } li { margin: 5px 0; max-width: 92ch; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13.5px; margin: 10px 0; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; background: #f6f8fa; }
th, td { padding: 4px 11px; border-bottom: 1px solid #e4e8ec; vertical-align: top; }
td.n, th.n { text-align: right; white-space: nowrap; } tr.first td { border-top: 2px solid #c4ccd4; }
td.best { font-weight: 650; } td.off { color: #b3261e; }
.pictures { display: grid; gap: 8px; align-items: start; }
figure { margin: 0; } figure img { width: 100%; display: block; border-radius: 3px; background: #26262a; }
figcaption { font-size: 12px; color: #59636e; padding: 2px 1px 6px; line-height: 1.35; }
.legend span { display: inline-block; margin-right: 18px; font-size: 12.5px; color: #59636e; }
.legend i { display: inline-block; width: 12px; height: 12px; border: 1px solid #8c959f; margin-right: 6px;
  vertical-align: -1px; }
.curve { width: 100%; }
"""

_SOURCE = (
    "M. V. Bobyr, N. A. Milostnaya, S. V. Gorbachev, S. Bhattacharyya, J. Cao: The Method of Depth Map"
    " Calculating Based on Soft Operators in Multi-Agent Robotic Stereo Vision Systems, 2021"
)


def page(document: Document, maps: Maps, reading: Reading) -> str:
    """The whole page as HTML text; it loads nothing from anywhere."""
    parts = [
        "<h1>The paper's evaluation, regenerated</h1>",
        f'<p class="lead">{escape(_SOURCE)}. Written by <code>softdepth paper</code>.</p>',
        _section("Findings", _list(pages.findings(document))),
        _section("Table 2: the paper's RMSE, gray levels", _table2(document)),
        _section(
            "The same comparison in one view",
            "<p>Plain SAD in the view, truth, border and drawing of the FMCDM rows.</p>"
            + _one_view(document),
        ),
        _section("The readings", _readings(document)),
        _section("Table 3: the maps", _table3(maps, reading)),
        _section("Fig. 4: one pixel's cost", _figure4(document)),
        _section("Fig. 5: the compensating rule", _figure5(document, maps, reading)),
        _section("Standard metrics", _metrics(document)),
        _section("Speed", _speed(document)),
    ]
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>softdepth: the paper's evaluation</title><style>{_STYLE}</style></head>\n<body>\n"
        + "\n".join(parts)
        + "\n</body></html>\n"
    )


def _section(title: str, body: str) -> str:
    return f"<h2>{escape(title)}</h2>\n{body}"


def _list(lines: Iterable[str]) -> str:
    bold = (re.sub(r"\*\*(.+?)\*\*", r"<strong>\1</strong>", escape(line)) for line in lines)
    return "<ul>" + "".join(f"<li>{line}</li>" for line in bold) + "</ul>"


def _cell(text: str, kind: str = "") -> str:
    return f'<td class="{kind}">{escape(text)}</td>' if kind else f"<td>{escape(text)}</td>"


def _grid(head: Sequence[str], rows: Iterable[str], numbers: int) -> str:
    """A table; the columns from `numbers` on are right-aligned."""
    titles = "".join(
        f'<th class="{"n" if i >= numbers else ""}">{escape(title)}</th>' for i, title in enumerate(head)
    )
    return f'<div class="scroll"><table><tr>{titles}</tr>{"".join(rows)}</table></div>'


def _row(cells: Iterable[str], first: bool = False) -> str:
    return f'<tr class="first">{"".join(cells)}</tr>' if first else f"<tr>{''.join(cells)}</tr>"


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
        cells = [_cell(text) for text in (*names, pages.operator(row.operator))]
        cells += [_cell(value, "n") for value in values]
        cells.append(_cell(deviation, "n off" if far else "n"))
        rows.append(_row(cells, first=row.scene != before[0]))
        before = here
    return _grid(["scene", "method", "operator", *pages.COLUMNS], rows, numbers=3)


def _one_view(document: Document) -> str:
    rows = []
    for row in document.one_view:
        names = (_cell(row.scene.capitalize()), _cell(row.method))
        values = (_cell(pages.figure(v), "n") for v in (row.float, row.fixed))
        rows.append(_row((*names, *values)))
    return _grid(["scene", "method", "float", "fixed"], rows, numbers=2)


def _readings(document: Document) -> str:
    keys = dict.fromkeys(key for each in document.readings.values() for key in each.facts)
    rows = [
        _row([_cell(key), *(_cell(r.facts.get(key, "-")) for r in document.readings.values())])
        for key in keys
    ]
    rows.append(_row([_cell("why"), *(_cell(r.why) for r in document.readings.values())]))
    head = ["", *(f"{key}: {each.name}" for key, each in document.readings.items())]
    return _grid(head, rows, numbers=len(head))


def _figure(source: str, caption: str) -> str:
    text = escape(caption)
    return f'<figure><img src="{source}" alt="{text}"><figcaption>{text}</figcaption></figure>'


def _pictures(found: Sequence[str], columns: int) -> str:
    style = f"grid-template-columns: repeat({columns}, 1fr)"
    return f'<div class="pictures" style="{style}">{"".join(found)}</div>'


def _table3(maps: Maps, reading: Reading) -> str:
    maximum = reading.candidates - 1
    text = [
        f"<p>Float model. Above the disparity, 0 (blue) to {maximum} (red) px, with the paper's RMSE; below,"
        f" the error in its own view ({reading.view}).</p>",
        _legend(),
    ]
    for title, plan in (("FMCDM", reading), ('"[11]", the reading tried', readings.PROTOTYPE)):
        for name in SCENES:
            scene = scenes.load(name, plan.size)
            text.append(f"<h3>{title}: {name.capitalize()}</h3>")
            found = [(o, maps[Cell(name, plan, o, "float")]) for o in OPERATORS]
            row = [
                _figure(figures.depth(m, maximum), f"{TITLES[o]}, {rmse(m, plan, scene):.2f}")
                for o, m in found
            ]
            row += [
                _figure(figures.errors(m, scene.truths[plan.view]), f"{TITLES[o]}, error") for o, m in found
            ]
            text.append(_pictures(row, len(OPERATORS)))
    return "\n".join(text)


def _legend() -> str:
    keys = (
        f'<span><i style="background: rgb{rgb}"></i>{escape(name)}</span>'
        for name, rgb in ERROR_COLOURS.items()
    )
    return f'<p class="legend">{"".join(keys)}</p>'


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
        row.append(_figure(figures.gray(maps[cell], cell.reading.first), f"{name}: {numbers}"))
    truth = scenes.load(RULE_SCENE, reading.size).truths[reading.truth]
    row.append(_figure(figures.truth_gray(truth), f"truth of the {reading.truth} view"))
    return (
        "<p>Drawn in gray levels, as the paper does. The white dots are false near objects.</p>"
        + _pictures(row, len(row))
    )


def _metrics(document: Document) -> str:
    head = ["scene", "method", "operator", "engine", "view", "paper's RMSE"]
    head += ["bad-1.0 %", "bad-2.0 %", "MAE px", "RMS px"]
    rows, before = [], ""
    for score in document.metrics:
        scene, method, operator, *numbers = pages.score_row(score)
        names = (scene if score.scene != before else "", method, operator, score.engine, score.view)
        cells = [*map(_cell, names), *(_cell(n, "n") for n in numbers)]
        rows.append(_row(cells, first=score.scene != before))
        before = score.scene
    parameters = "; ".join(f"{name}: {text}" for name, text in document.opencv.items())
    return (
        f"<p>{escape(pages.METRICS_TEXT)}</p>"
        + _grid(head, rows, numbers=5)
        + f"<p>{escape(parameters)}.</p>"
    )


def _speed(document: Document) -> str:
    head = ["operator", "float, ns", "fixed, ns", "lanes", "clocks per pixel", "multipliers", "LUTs a lane"]
    rows = (
        _row([_cell(name), *(_cell(n, "n") for n in rest)])
        for name, *rest in pages.speed_rows(document.speed)
    )
    return f"<p>{escape(pages.speed_text(document.speed))}</p>" + _grid(head, rows, numbers=1)
