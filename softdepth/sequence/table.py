"""A sequence's figures: a row a frame as CSV and Markdown, and their sum."""

import csv
import io
import json
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean
from typing import Any

from softdepth.files import write_atomically
from softdepth.sequence.frame import Recipe, Record
from softdepth.templates import render

CSV, MARKDOWN, SUMMARY = "frames.csv", "frames.md", "sequence.json"

SCORES = {
    "bad1": "bad > 1 px, %",
    "bad2": "bad > 2 px, %",
    "mae": "mean error, px",
    "rmse": "RMS error, px",
}
"""What is shown of a frame's accuracy where truth is known, with its title."""


@dataclass(frozen=True)
class Column:
    """A column: its name in CSV, its title, its value for a frame, and how many decimals are shown."""

    key: str
    title: str
    value: Any
    decimals: int | None = 2


def columns(records: list[Record]) -> list[Column]:
    """What there is to show of these frames."""
    found = [
        Column("name", "frame", lambda r: r.name, None),
        Column("density", "measured, %", lambda r: r.accuracy.density),
    ]
    if any(record.accuracy.mae is not None for record in records):
        found += [
            Column(key, title, lambda r, key=key: getattr(r.accuracy, key)) for key, title in SCORES.items()
        ]
    if any(record.mismatches is not None for record in records):
        found.append(Column("mismatches", "mismatches", lambda r: r.mismatches, 0))
    found += [
        Column("pixels_per_second", "px/s", lambda r: r.pixels_per_second, 0),
        *(
            Column(f"{code}_percent", f"{code}, %", lambda r, code=code: r.shares[code])
            for code in records[0].shares
            if any(record.shares[code] for record in records)
        ),
    ]
    return found


def as_csv(records: list[Record]) -> str:
    """A head and a row a frame; what is not known is empty."""
    shown = columns(records)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(column.key for column in shown)
    for record in records:
        writer.writerow(_plain(column, record) for column in shown)
    return file.getvalue()


def as_markdown(records: list[Record], missing: str = "") -> str:
    """The same as a Markdown table, with the mean in its last row; `missing` is said below it."""
    shown = columns(records)
    rows = [
        *([_text(column, column.value(record)) for column in shown] for record in records),
        [_text(column, _mean(column, records)) for column in shown],
    ]
    return render("softdepth.sequence", "frames.md", columns=shown, rows=rows, missing=missing) + "\n"


def summary(
    name: str, recipe: Recipe, records: list[Record], seconds: float, missing: str = ""
) -> dict[str, Any]:
    """``sequence.json``: means over the frames, and what was computed in this run, in how long.

    `missing` says what the sequence lacks of what it should hold, if it does.
    """
    computed = [record for record in records if not record.kept]
    return {
        "schema_version": 1,
        "sequence": name,
        "engine": recipe.engine,
        "frames": len(records),
        "missing": missing or None,
        "computed": len(computed),
        "seconds": seconds,
        "frames_per_second": len(computed) / seconds if computed else None,
        "engine_frames_per_second": _rate(computed),
        "mean": {
            column.key: _mean(column, records) for column in columns(records) if column.decimals is not None
        },
        "mismatches": _sum([record.mismatches for record in records]),
        "config": recipe.config.model_dump(mode="json"),
        "config_hash": recipe.config.hash,
    }


def write(folder: Path, found: dict[str, Any], records: list[Record]) -> None:
    """Write the tables and the summary into a sequence's folder, the summary last."""
    write_atomically(folder / CSV, as_csv(records).encode())
    write_atomically(folder / MARKDOWN, as_markdown(records, found["missing"] or "").encode())
    write_atomically(folder / SUMMARY, (json.dumps(found, indent=2) + "\n").encode())


def _rate(records: list[Record]) -> float | None:
    seconds = sum(record.seconds for record in records)
    return len(records) / seconds if seconds > 0 else None


def _mean(column: Column, records: list[Record]) -> Any:
    if column.decimals is None:
        return "mean"
    known = [value for record in records if (value := column.value(record)) is not None]
    return fmean(known) if known else None


def _sum(values: list[int | None]) -> int | None:
    known = [value for value in values if value is not None]
    return sum(known) if known else None


def _plain(column: Column, record: Record) -> Any:
    value = column.value(record)
    if value is None or column.decimals is None:
        return value
    return round(value, column.decimals + 2) if column.decimals else round(value)


def _text(column: Column, value: Any) -> str:
    if value is None:
        return "-"
    if column.decimals is None:
        return str(value).replace("|", "\\|")
    return f"{value:,.{column.decimals}f}"
