"""The evaluation as Markdown, and its table for the terminal."""

from collections.abc import Sequence
from itertools import groupby
from typing import Any

from rich.table import Table

from softdepth.studies.paper import figure4, published
from softdepth.studies.paper.document import Document, Score
from softdepth.studies.paper.speed import LANES, TIE, Speeds
from softdepth.studies.paper.table2 import Row
from softdepth.templates import render

METRICS_TEXT = (
    "Every map is scored in its own view: all known pixels / non-occluded ones. No result counts as wrong, so"
    " the columns that OpenCV's matchers leave out, as many as there are candidates, count against them."
)
COLUMNS = ("published", "float", "fixed", "gateware", "deviation")


def figure(value: float | None, digits: int = 2, sign: bool = False) -> str:
    """A number as the tables show it; a dash where there is none."""
    return "-" if value is None else f"{value:{'+' if sign else ''}.{digits}f}"


def operator(name: str | None) -> str:
    """An operator as the paper names it."""
    return "" if name is None else published.TITLES[name]


def below(gain: float) -> str:
    """How far a figure lies below another, in per cent of that; a negative gain is above it."""
    return f"{abs(gain):.0f} % {'below' if gain >= 0 else 'above'}"


def figures(row: Row) -> list[str]:
    """The columns of `COLUMNS` of a row."""
    return [figure(v) for v in (row.published, row.float, row.fixed, row.rtl)] + [
        figure(row.deviation, sign=True)
    ]


def screen_table(rows: Sequence[Row]) -> Table:
    """Table 2 for the terminal."""
    table = Table("scene", "method", "operator", *COLUMNS, box=None, title="Table 2: the paper's RMSE")
    table.title_justify = "left"
    for column in table.columns[3:]:
        column.justify = "right"
    before: tuple[str, str] | None = None
    for row in rows:
        first = (row.scene, row.method) != before
        names = (row.scene.capitalize(), row.method) if first else ("", "")
        table.add_row(*names, operator(row.operator), *figures(row))
        before = (row.scene, row.method)
    return table


def findings(document: Document) -> list[str]:
    """The results in words, each one sentence or two, with their measured figures."""
    s, speed = document.summary, document.speed
    name = document.readings["FMCDM"].name
    others = ", ".join(f"{n} {v:.2f}" for n, v in s.readings.items() if n != name)
    wide = document.one_view[-1].method
    lines = [
        f"SAD is reproduced to {s.sad_max_deviation:.2f} gray levels at most, over the three scenes.",
        f"FMCDM is reproduced to {s.fmcdm_mean_deviation_14:.2f} on average over 14 cells, Venus PROD left"
        f" out ({s.fmcdm_mean_deviation_15:.2f} with it), by reading {name}; other readings: {others}."
        f" In fixed point it is {s.fixed_mean_deviation_14:.2f}; fixed and float differ by"
        f" {s.fixed_float_max_difference:.2f} at most.",
        "**The published gain compares two views.** The SAD row is met by the left view's map scored against"
        " the right view's truth (against its own it would be off by"
        f" {s.sad_own_truth_max_deviation:.2f}); the FMCDM rows by the right view's map against that truth."
        f" Published so, FMCDM lies {s.gain_published:.0f} % below SAD (here {s.gain_two_views:.0f} %)."
        f" In FMCDM's own view, truth, border and drawing, it lies {below(s.gain_one_view)} SAD 3x3, and"
        f" {below(s.gain_over_wide_sad)} plain {wide}: what is left comes from the larger windows, not from"
        " the inference.",
        f'The method "[11]" is not described. The nearest of the readings tried is off by'
        f" {s.prototype_mean_deviation:.2f} on average: it is **not reproduced**.",
        *_rule_lines(document),
        conclusion_4(speed),
    ]
    if s.rtl_cells:
        lines.append(
            f"Through the simulated gateware went {s.rtl_cells} of the table's cells:"
            f" {s.rtl_mismatches} pixels differ from the fixed-point model."
        )
    return lines


def tables(document: Document) -> dict[str, Any]:
    """What the evaluation's pages, in Markdown and HTML, both show."""
    return {
        "findings": findings(document),
        "columns": list(COLUMNS),
        "table2": [
            [r.scene.capitalize(), r.method, operator(r.operator), *figures(r)] for r in document.table2
        ],
        "one_view": [
            [r.scene.capitalize(), r.method, figure(r.float), figure(r.fixed)] for r in document.one_view
        ],
        "readings": reading_rows(document),
        "metrics_text": METRICS_TEXT,
        "opencv": document.opencv,
        "speed_text": speed_text(document.speed),
        "speed": speed_rows(document.speed),
    }


def markdown(document: Document, level: int = 2) -> str:
    """The whole evaluation; its headings start at `level`."""
    metrics = [score_row(s) for s in document.metrics if s.engine == "float"]
    values = tables(document)
    return render("softdepth.studies", "paper.md", mark="#" * level, metrics=metrics, **values)


def score_row(score: Score) -> list[str]:
    """A map's standard metrics as text: all / non-occluded."""
    m = score.metrics
    pairs = [f"{figure(m[k])} / {figure(m[f'nonocc_{k}'])}" for k in ("bad1", "bad2", "mae", "rmse")]
    return [
        score.scene.capitalize(),
        score.method,
        operator(score.operator),
        figure(score.paper_rmse),
        *pairs,
    ]


def speed_text(speeds: Speeds) -> str:
    """What the speed table shows."""
    return (
        f"Nanoseconds of processor time a pixel, on one core of {speeds.processor}, all in one run; times"
        f" within {100 * (TIE - 1):.0f} % count as equal. Clocks a pixel of the gateware, with as many lanes"
        f" (up to {LANES}) as {speeds.multipliers} multipliers allow."
    )


def speed_rows(speeds: Speeds) -> list[list[str]]:
    """The speed table's rows as text."""
    return [
        [
            operator(s.operator),
            *(f"{ns:,.0f}" for ns in (s.float_ns, s.fixed_ns)),
            *map(str, (s.lanes, s.clocks, s.multipliers)),
            "not measured" if s.luts_per_lane is None else f"{s.luts_per_lane:,.0f}",
        ]
        for s in speeds.operators
    ]


def reading_rows(document: Document) -> list[list[str]]:
    """The readings side by side, the head first."""
    head = ["", *(f"{key}: {each.name}" for key, each in document.readings.items())]
    keys = dict.fromkeys(key for each in document.readings.values() for key in each.facts)
    rows = [[key, *(r.facts.get(key, "-") for r in document.readings.values())] for key in keys]
    return [head, *rows, ["why", *(r.why for r in document.readings.values())]]


def _rule_lines(document: Document) -> list[str]:
    said = []
    for windows, group in groupby(document.figure4, key=lambda p: p.windows):
        found = list(group)
        after = ", ".join(f"{p.after} judged by {p.judged_by}x{p.judged_by}" for p in found)
        said.append(f"with windows {'/'.join(map(str, windows))}, {found[0].before} becomes {after}")
    _, without, *judged = document.figure5
    on_map = " and ".join(
        f"{s.paper_rmse:.2f} and {figure(s.metrics['bad1'])} % ({s.method})" for s in judged
    )
    return [
        f"**The compensating rule.** At Fig. 4's pixel the paper has {figure4.BEFORE} become {figure4.AFTER}."
        f" Here, counting pixels and candidates from one, with soft-min I and inputs replaced by 2T:"
        f" {'; '.join(said)}. The paper says SAD and not which.",
        f"On the whole map (Teddy, soft-min I) the paper's RMSE and bad-1.0 go from {without.paper_rmse:.2f}"
        f" and {figure(without.metrics['bad1'])} % to {on_map}.",
    ]


def conclusion_4(speeds: Speeds) -> str:
    """Whether the paper's conclusion 4 holds."""
    verdicts = []
    for engine in ("float", "fixed"):
        first = speeds.fastest(engine)
        times = {s.operator: getattr(s, f"{engine}_ns") for s in speeds.operators}
        ratio = times["mean"] / times[first]
        tied = [operator(o) for o, t in times.items() if o != "mean" and t < TIE * times["mean"]]
        if ratio >= TIE:
            verdicts.append(f"not in {engine}, where {operator(first)} is ({ratio:.2f} times as fast)")
        elif tied:
            verdicts.append(f"in {engine} it is no slower than any, and no faster than {', '.join(tied)}")
        else:
            verdicts.append(f"it holds in {engine}")
    least = speeds.fewest_clocks
    every = "all operators take" if len(least) == len(speeds.operators) else ", ".join(map(operator, least))
    tail = "the same clocks" if len(least) == len(speeds.operators) else "take the fewest clocks"
    return f"Conclusion 4, MEAN is the fastest operator: {'; '.join(verdicts)}. In gateware {every} {tail}."
