"""An evaluation as Markdown and as a page with every scene's pictures."""

import base64
from collections.abc import Mapping

from softdepth.golden.score.pictures import ERROR_COLOURS
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
    confidence = None
    if any(scene.sparsification for scene in evaluation.scenes):
        confidence = _picture(plots.confidence(evaluation), "png", "Confidence, all scenes")
    scenes = [
        {
            "name": scene.name,
            "group": scene.group,
            "pictures": [
                _picture(data, "jpeg", _caption(evaluation, scene.name, name))
                for name, data in pictures[scene.name].items()
            ],
        }
        for scene in evaluation.scenes
    ]
    text = render(
        "softdepth.studies",
        "accuracy.html",
        hashes=evaluation.hashes,
        engine=evaluation.engine,
        tables=[_plain(table) for table in tables(evaluation)],
        confidence=confidence,
        colours=ERROR_COLOURS,
        scenes=scenes,
    )
    return text + "\n"


def _plain(table: Table) -> Table:
    """A table without Markdown's marks of code and emphasis."""
    rows = [[text.replace("`", "") for text in row] for row in table.rows]
    return table._replace(text=table.text.replace("`", "").replace("*", ""), rows=rows)


def _caption(evaluation: Evaluation, scene: str, picture: str) -> str:
    found = next(s for s in evaluation.scenes if s.name == scene).scores[CLEAN]
    if picture in found:
        return f"{evaluation.methods[picture].strip('`')}: error {found[picture].error:.2f}"
    return picture if picture in ("left", "truth") else "its errors"


def _picture(data: bytes, kind: str, caption: str) -> dict[str, str]:
    """A picture as the templates take it."""
    return {"source": f"data:image/{kind};base64,{base64.b64encode(data).decode()}", "caption": caption}
