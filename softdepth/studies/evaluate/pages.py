"""An evaluation as Markdown and as a page with every scene's pictures."""

import base64
from collections.abc import Mapping
from html import escape

from softdepth.studies import webpage
from softdepth.studies.evaluate import plots
from softdepth.studies.evaluate.document import CLEAN, Evaluation
from softdepth.studies.evaluate.tables import Table, tables
from softdepth.templates import render

PART = "accuracy"
"""The marker of the generated part of docs/accuracy.md."""


def markdown(evaluation: Evaluation) -> str:
    """Every table."""
    return render("softdepth.studies", "accuracy.md", tables=tables(evaluation))


def page(evaluation: Evaluation, pictures: Mapping[str, Mapping[str, bytes]]) -> str:
    """One self-contained page: tables, plots, and the pictures of each scene (`work.SceneWork.pictures`)."""
    presets = ", ".join(f"{name} ({hash_})" for name, hash_ in evaluation.hashes.items())
    parts = [
        "<h1>Accuracy</h1>",
        f'<p class="lead">{escape(presets)}. Engine: {evaluation.engine}. Written by'
        " <code>softdepth evaluate</code>.</p>",
        *(
            webpage.section(table.title, f"<p>{_text(table.text)}</p>" + _grid(table))
            for table in tables(evaluation)
        ),
    ]
    if any(scene.sparsification for scene in evaluation.scenes):
        plot = webpage.figure(_source(plots.confidence(evaluation), "png"), "Confidence, all scenes")
        parts.append(webpage.section("Confidence, as curves", plot))
    parts.append(webpage.section("Scenes", webpage.legend()))
    for scene in evaluation.scenes:
        figures = [
            webpage.figure(_source(data, "jpeg"), _caption(evaluation, scene.name, name))
            for name, data in pictures[scene.name].items()
        ]
        parts.append(f"<h3>{escape(scene.name)}, {escape(scene.group)}</h3>{webpage.pictures(figures, 6)}")
    return webpage.page("softdepth: accuracy", parts)


def _caption(evaluation: Evaluation, scene: str, picture: str) -> str:
    found = next(s for s in evaluation.scenes if s.name == scene).scores[CLEAN]
    if picture in found:
        return f"{evaluation.methods[picture].strip('`')}: error {found[picture].error:.2f}"
    return picture if picture in ("left", "truth") else "its errors"


def _grid(table: Table) -> str:
    head, *rows = table.rows
    cells = (
        webpage.row(
            webpage.cell(text.strip("`"), "n" if i >= table.names else "") for i, text in enumerate(row)
        )
        for row in rows
    )
    return webpage.grid([text.strip("`") for text in head], cells, table.names)


def _text(markdown: str) -> str:
    return escape(markdown.replace("`", "").replace("*", ""))


def _source(data: bytes, kind: str) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"
