"""``softdepth utilization``: area and speed of the recommended configurations, measured."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from softdepth import screen
from softdepth.spec.errors import InputError

if TYPE_CHECKING:
    from softdepth.studies.utilization import Selection


def utilization(
    row: Annotated[
        list[str] | None,
        typer.Option(
            "--row",
            metavar="PRESET/OPERATOR/LANES[/DEVICE][@SEED]",
            help="Measure this row, from a seed of its own if one is given; repeatable [default: all].",
        ),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="The rows of eight lanes with MEAN only.")] = False,
    families: Annotated[
        bool, typer.Option("--families", help="Other families only, by synthesis alone: minutes.")
    ] = False,
    disparities: Annotated[
        int, typer.Option("--disparities", metavar="N", help="Candidates per pixel.")
    ] = 64,
    width: Annotated[int, typer.Option("--width", metavar="N", help="The longest line.")] = 1280,
    seed: Annotated[
        int,
        typer.Option(
            "--seed", metavar="N", min=0, help="Where nextpnr starts from; the first, where there are three."
        ),
    ] = 1,
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="DIR", help="Folder of utilization.md and utilization.json."),
    ] = Path("docs"),
) -> None:
    """Synthesise, place and route cores for an LFE5U-85F and write down area and speed.

    With --row, --quick or --families, the page's other rows stay as they are. A netlist that was placed and
    routed before is not again: its figures are taken from the page that is renewed, or from the cache.
    Several seeds of a row, at once or one after the other, are one line of it: that of the median clock.
    """
    from softdepth.studies import other_families, utilization, utilization_page

    if families and (row or quick):
        raise InputError(
            "--families measures other rows than --row and --quick", "ask for one of them at a time"
        )
    usual = utilization_page.QUICK if quick else utilization_page.RECOMMENDED
    rows = [_selection(text, seed) for text in row or ()] or [
        (each, its_seed) for each in usual for its_seed in utilization_page.seeds_of(each, seed)
    ]
    configs = [each.config(disparities, width) for each, _ in rows]  # all are sound before the first is built
    if not output.is_dir():
        raise InputError(f"folder '{output}' does not exist", "create it first, or choose another with -o")
    known = utilization_page.load(output)
    if families and not known:
        raise InputError(
            f"'{output}' has no utilization.json to renew the page from", "leave out --families first"
        )
    if not (row or quick):
        of_families = other_families.load(output)
        found_there = other_families.measure_all(known=of_families, disparities=disparities, width=width)
        other_families.write(output, found_there)
    if families:
        utilization_page.write(output, known)
        print(f"results: {output / 'utilization.md'}, {output / other_families.JSON}")
        return
    found = []
    for number, ((each, its_seed), config) in enumerate(zip(rows, configs, strict=True), start=1):
        screen.note(f"row {number} of {len(rows)}: {each}")
        found.append(utilization.measure(config, each.preset, part=each.part, seed=its_seed, known=known))
    utilization_page.write(output, utilization_page.merged(known, found) if row or quick else found)
    print(f"results: {output / 'utilization.md'}, {output / 'utilization.json'}")


def _selection(text: str, seed: int) -> tuple["Selection", int]:
    """What a row names, and its seed: that of all unless it has its own."""
    from pydantic import ValidationError

    from softdepth.spec.config import OPERATORS
    from softdepth.spec.presets import PRESETS
    from softdepth.studies.utilization import SUM, Selection, operator_of
    from softdepth.studies.utilization_page import BLOCK_RAMS

    names = ("preset", "operator", "lanes", "device")
    what, at, own = text.partition("@")
    try:
        parts = what.split("/")
        if not len(names) - 1 <= len(parts) <= len(names):
            raise ValueError(f"'{what}' has {len(parts)} parts")
        selection = Selection.model_validate(dict(zip(names, parts, strict=False)))
        if selection.device not in BLOCK_RAMS:
            raise ValueError(f"'{selection.device}' is not one of {', '.join(BLOCK_RAMS)}")
        has_none = operator_of(selection.preset, "") == SUM if selection.preset in PRESETS else False
        if selection.operator not in (*OPERATORS, *((SUM,) if has_none else ())):
            raise ValueError(f"'{selection.operator}' is not an operator")
        if at and not own.isdecimal():
            raise ValueError(f"'{own}' is not a seed")
    except (ValueError, ValidationError) as error:
        raise InputError(
            f"--row '{text}' is not PRESET/OPERATOR/LANES[/DEVICE][@SEED]",
            "write for example --row paper/mean/16 or --row robust-small/sum/16/LFE5U-45F",
        ) from error
    return selection, int(own) if at else seed
