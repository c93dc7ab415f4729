"""``softdepth inspect``: what is wrong with a pair, before anything is computed from it."""

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth import screen
from softdepth.cli import options, pairs
from softdepth.cli.bundle import bundled
from softdepth.spec.config import Config

if TYPE_CHECKING:
    from softdepth.golden.data.pair import StereoPair
    from softdepth.inspect.inspection import Inspection


@bundled
def inspect(
    source: pairs.Source,
    choice: options.Choice,
    as_json: Annotated[
        bool, typer.Option("--json", help="Figures and findings as JSON on standard output.")
    ] = False,
) -> None:
    """Say what is wrong with a pair: range, order, rows, light, texture. Exits with 0 even with findings."""
    chosen = choice.configuration()
    from softdepth.inspect.inspection import inspect as look

    pair = source.read(chosen).as_format("rgb8")
    found = look(pair.left, pair.right, chosen)
    if not choice.given:  # nobody has asked for this range
        found = replace(found, findings=[one for one in found.findings if one.code != "needless"])
    if as_json:
        print(found.json())
    else:
        _show(found, pair.name)


def note(pair: "StereoPair", config: Config) -> None:
    """One line on the screen for each thing that is wrong with a pair, or with this core's range for it."""
    from softdepth.inspect.inspection import inspect as look
    from softdepth.inspect.texts import line

    plain = pair.as_format("rgb8")  # what the measurements are made for
    for finding in look(plain.left, plain.right, config).findings:
        if finding.code != "same":  # reading the pair has already said so
            screen.note(f"note: {line(finding)}")


def _show(found: "Inspection", name: str) -> None:
    lines = facts(found)
    width = max(map(len, lines))
    print(name)
    for label, text in lines.items():
        print(f"  {label:{width}}  {text}")
    for line in found.lines or ["nothing is wrong with this pair"]:
        print(line)


def facts(found: "Inspection") -> dict[str, str]:
    """The figures, as label and text; a figure from too few points says so."""
    measured, unknown = found.measured, "unknown: too few points are found in both views"
    rows, span, light = measured.rows, measured.span, measured.light
    return {
        "size": f"{measured.width} x {measured.height} pixels",
        "points in both views": f"{measured.points} of {measured.keypoints}",
        "right rows, offset": f"{rows.offset:+.2f} in the middle, changing by up to {rows.change:.2f},"
        f" residual {rows.residual:.2f}"
        if rows
        else unknown,
        "disparities": f"{span.low:.1f} .. {span.high:.1f} px, in {100 * span.density:.0f} % of the pixels"
        if span
        else unknown,
        "range that would do": f"{found.range.first} .. {found.range.first + found.range.disparities - 1},"
        f" {found.range.disparities} candidates"
        if found.range
        else unknown,
        "right to left": f"brightness {light.brightness:.3f} (+-{100 * light.uneven:.1f} % over the image),"
        f" contrast {light.contrast:.3f}, gamma {light.gamma:.2f}"
        if light
        else unknown,
        "without texture": f"{100 * measured.bare:.0f} % of the left image",
    }
