"""``python -m softdepth.studies.readme RESULTS``: put a run's figures and picture into README.md.

The figures in the README are measured ones: they are written by this program from ``report.json`` and
``docs/utilization.json``, between the markers, never by hand.
"""

import json
import sys
from pathlib import Path

from softdepth.ending import ended
from softdepth.run.measure import Engine
from softdepth.run.report import Report
from softdepth.spec.errors import InputError
from softdepth.studies import markers
from softdepth.templates import render

PART = "figures"
AREA = "area"
UTILIZATION = Path("docs/utilization.json")
BEGIN, END = markers.markers(PART)
PICTURE = Path("docs/images/motorcycle.png")

_TITLES: dict[Engine, str] = {
    "rtl": "gateware (simulated)",
    "fixed": "fixed-point model",
    "float": "float model",
    "paper": "preset paper, fixed-point model",
    "sad": "plain SAD 3x3",
}


def figures(report: Report) -> str:
    """The report as the README shows it; raises `InputError` for a run without gateware or truth."""
    if report.rtl_mismatches is None or report.metrics["rtl"].bad1 is None:
        raise InputError(f"the run of {report.pair} has no gateware figures", "run make demo first")
    scores = ((title, report.metrics[engine]) for engine, title in _TITLES.items())
    rows = [(title, score) for title, score in scores if score.bad1 is not None]
    return render("softdepth.studies", "figures.md", report=report, rows=rows)


def renew(text: str, report: Report) -> str:
    """`text` with the figures of `report` between the markers; raises `InputError` if they are missing."""
    return markers.renew(text, "README.md", PART, figures(report))


def area(utilization: str) -> str:
    """The fastest core of each preset and part among ``utilization.json``'s rows.

    Where it has an operator, that with MEAN; where a row has several seeds, that of the median clock.
    """
    from softdepth.studies.utilization import SUM, Row
    from softdepth.studies.utilization_page import median_rows

    rows = [Row.model_validate(row) for row in json.loads(utilization)["rows"]]
    best: dict[tuple[str, str], Row] = {}
    for row in median_rows(rows):
        known = best.get((row.preset, row.device))
        if row.operator in ("mean", SUM) and (known is None or row.mde_s > known.mde_s):
            best[row.preset, row.device] = row
    return render("softdepth.studies", "area.md", rows=list(best.values()))


def main(results: Path, project: Path) -> None:
    """Renew README.md in `project` from the folder of a run."""
    from softdepth.files import write_atomically

    try:
        report = Report.model_validate_json((results / "report.json").read_text())
        readme = project / "README.md"
        renewed = renew(readme.read_text(), report)
        table = area((project / UTILIZATION).read_text())
        renewed = markers.renew(renewed, "README.md", AREA, table)
        write_atomically(readme, renewed.encode())
        (project / PICTURE).parent.mkdir(parents=True, exist_ok=True)
        shrink(results / "overview.png", project / PICTURE)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot use the results in '{results}': {error}", "run make demo first") from error


def shrink(source: Path, target: Path) -> None:
    """Copy a picture with 256 colours: a third of the bytes in every clone, and no visible loss."""
    from PIL import Image

    with Image.open(source) as picture:
        picture.convert("RGB").quantize(256).save(target, optimize=True)


if __name__ == "__main__":
    sys.exit(ended(lambda: main(Path(sys.argv[1]), Path.cwd())))
