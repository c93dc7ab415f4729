"""``python -m softdepth.studies.compare.document RESULTS``: renew docs/compare.md and docs/operators.md.

RESULTS is a folder of folders that ``softdepth compare`` wrote, one per pair and operator.
"""

import sys
from itertools import groupby
from pathlib import Path

from softdepth.ending import ended
from softdepth.spec.config import Config
from softdepth.spec.errors import InputError
from softdepth.spec.operators import REGISTRY
from softdepth.studies import markers
from softdepth.studies.compare import tables
from softdepth.studies.compare.comparison import Comparison
from softdepth.studies.compare.output import LAST
from softdepth.studies.compare.sweep import MEMBERSHIP_BITS, TOLERANCE
from softdepth.studies.readme import shrink
from softdepth.templates import render

PARTS = {"measured": "docs/compare.md", "formats": "docs/compare.md", "exhaustive": "docs/operators.md"}
"""The generated parts, by marker, and the document each stands in."""

PICTURE = Path("docs/images/compare.png")
EXHAUSTIVE_BITS = (4, 6, 8)


def measured(many: list[Comparison]) -> str:
    """The compared configuration on each pair, then the formats, averaged over the pairs of an operator."""
    grids = []
    for (preset, operator), group in groupby(many, key=_method):
        same = list(group)
        for heading, figure in tables.figures(same[0]).items():
            title = f"{preset}, {operator.upper()}, mean of {len(same)} pairs: {heading}"
            grids.append((title, *tables.table(same, figure)))
    return render(
        "softdepth.studies",
        "measured.md",
        names=["pair", "preset", "operator"],
        differences=[_row(c, _difference(c)) for c in many],
        scores=[_row(c, _scores(c)) for c in many],
        tolerance=TOLERANCE,
        labels=[f"T = 2^{bits}" for bits in many[0].sweep.label_bits],
        enough=[_row(c, [str(label.enough or "-") for label in c.sweep.labels]) for c in many],
        grids=grids,
    )


def formats() -> str:
    """What a width costs: bits of the fraction N / S, and multipliers of the preset's lanes."""
    operators = ("mean", "min")
    columns = [column for o in operators for column in (f"{o.upper()}: bits of N, S", "multipliers")]
    rows = []
    for bits in MEMBERSHIP_BITS:
        cells = [str(bits)]
        for operator in operators:
            config = Config.preset("paper").override(
                [f"operator={operator}", f"membership_bits={bits}", "max_multipliers=1000"]
            )
            cells += [
                ", ".join(str((high - low).bit_length()) for low, high in config.cost_range),
                str(config.multipliers),
            ]
        rows.append(cells)
    return render("softdepth.studies", "formats.md", columns=columns, rows=rows)


def exhaustive() -> str:
    """The worst difference of every fixed-point operator, over all its inputs."""
    from softdepth.studies.operator_error import OperatorError, Reference, operator_error

    def row(name: str, changes: list[str], reference: Reference) -> tuple[str, list[OperatorError]]:
        errors = [
            operator_error(
                Config.preset("paper").override([*changes, "lanes=1", f"membership_bits={bits}"]), reference
            )
            for bits in EXHAUSTIVE_BITS
        ]
        return name, errors

    rows = []
    for operator in REGISTRY:
        if operator != "soft_min_2":
            rows.append(row(f"`{operator}`", [f"operator={operator}"], "at once"))
            continue
        for k in (-100, 100):
            changes = [f"operator={operator}", f"sharpness={k}.0"]
            rows.append(row(f"`{operator}`, k = {k}, against three at once", changes, "at once"))
            rows.append(row(f"`{operator}`, k = {k}, against nested", changes, "nested"))
    return render("softdepth.studies", "exhaustive.md", widths=EXHAUSTIVE_BITS, rows=rows)


def main(results: Path, project: Path) -> None:
    """Renew the documents in `project`; raises `InputError` if results or markers are missing."""
    from softdepth.files import write_atomically

    try:
        found = {path: Comparison.model_validate_json(path.read_text()) for path in results.glob(f"*/{LAST}")}
        if not found or any(c.metrics["float"].bad1 is None for c in found.values()):
            raise InputError(f"'{results}' holds no comparisons with known truth", "run make compare")
        many = sorted(found.values(), key=lambda c: (c.config["name"] != "paper", _method(c), c.pair))
        texts = {"measured": measured(many), "formats": formats(), "exhaustive": exhaustive()}
        for part, document in PARTS.items():
            path = project / document
            renewed = markers.renew(path.read_text(), document, part, texts[part])
            write_atomically(path, renewed.encode())
        first = next(path for path, comparison in found.items() if comparison is many[0])
        (project / PICTURE).parent.mkdir(parents=True, exist_ok=True)
        shrink(first.parent / "sweep.png", project / PICTURE)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot use the comparisons in '{results}': {error}", "run make compare") from error


def _method(found: Comparison) -> tuple[str, str]:
    """Preset and operator."""
    return found.config["name"], found.config["operator"]


def _row(found: Comparison, cells: list[str]) -> list[str]:
    """A row of a table with one for each comparison."""
    return [found.pair, *_method(found), *cells]


def _difference(found: Comparison) -> list[str]:
    """The compared configuration against the float model with T = 5000, and the two effects apart."""
    a, label = found.agreement, tables.common_label(found)
    point = found.sweep.point(found.config["membership_bits"], label) if label is not None else None
    alone = next((entry for entry in found.sweep.labels if entry.label_bits == label), None)
    if point is None or alone is None:
        raise InputError(f"the format of {tables.title(found)} is not in its sweep", "compare a preset")
    shares = [f"{share:.2f} %" for share in (a.differ, a.differ1, a.differ2)]
    distances = [f"{rmse:.2f} px" for rmse in (a.rmse, alone.to_float.rmse, point.to_same_label.rmse)]
    nearer = ["-" if share is None else f"{share:.1f} %" for share in (a.closer, a.farther)]
    return [*shares, *distances, *nearer]


def _scores(found: Comparison) -> list[str]:
    """Float model and hardware against the truth."""
    both = found.metrics["float"], found.metrics["rtl" if found.engine == "rtl" else "fixed"]
    return [
        *(f"{scores.bad1:.2f} %" for scores in both),
        *(f"{scores.bad2:.2f} %" for scores in both),
        *(f"{scores.paper_rmse:.2f}" for scores in both),
    ]


if __name__ == "__main__":
    sys.exit(ended(lambda: main(Path(sys.argv[1]), Path.cwd())))
