"""``softdepth paper``: the paper's evaluation, regenerated."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from softdepth import ending, screen
from softdepth import files as results
from softdepth.spec.config import OPERATORS
from softdepth.spec.errors import ConfigError, InputError

AREA = Path("docs/area.json")


def paper(
    output: Annotated[
        Path,
        typer.Option("-o", "--output", metavar="DIR", help="Folder of paper.md, paper.html, paper.json."),
    ] = Path("out/paper"),
    engine: Annotated[
        Literal["models", "rtl"],
        typer.Option("--engine", help="rtl puts cells of Table 2 through the simulated gateware as well."),
    ] = "models",
    scene: Annotated[
        list[str] | None,
        typer.Option("--scene", metavar="NAME", help="With rtl: simulate this scene only; repeatable."),
    ] = None,
    operator: Annotated[
        list[str] | None,
        typer.Option("--operator", metavar="NAME", help="With rtl: only this operator, or sad; repeatable."),
    ] = None,
    reading: Annotated[
        str | None, typer.Option("--reading", metavar="NAME", help="Reading of the FMCDM rows.")
    ] = None,
    jobs: Annotated[
        int | None, typer.Option("--jobs", metavar="N", min=1, help="Processes; by default one a core.")
    ] = None,
    cached: Annotated[
        bool, typer.Option("--cache/--no-cache", help="Reuse maps of earlier runs, and keep these.")
    ] = True,
    document: Annotated[
        Path | None,
        typer.Option("--document", metavar="FILE", help="Also renew the tables in this Markdown file."),
    ] = None,
) -> None:
    """Regenerate the paper's tables and pictures: published, float, fixed point and gateware."""
    from softdepth.processes import cores
    from softdepth.studies.paper import cache, evaluation, pages, readings, speed, work
    from softdepth.studies.paper.document import assemble
    from softdepth.studies.paper.published import SCENES

    if reading is not None and reading not in readings.FMCDM:
        raise ConfigError(f"unknown reading '{reading}'", f"use one of {', '.join(readings.FMCDM)}")
    chosen = readings.FMCDM[reading] if reading else readings.NEST_357
    wanted_scenes = _chosen(scene, "--scene", SCENES, engine)
    wanted_operators = _chosen(operator, "--operator", ("sad", *OPERATORS), engine)
    evaluation.check_data(chosen)
    place = cache.folder() if cached else None
    simulated = work.gateware(chosen, wanted_scenes, wanted_operators) if engine == "rtl" else []
    with results.result_folder(output) as folder:
        speeds = speed.with_luts(evaluation.speeds_of(chosen, place), AREA)
        maps = evaluation.maps_of(chosen, cache.MapCache(place), jobs or cores(), simulated)
        found = assemble(maps, chosen, speeds)
        evaluation.write(folder, found, maps, chosen)
    if document is not None:
        evaluation.renew(document, found)
    screen.console().print(pages.screen_table(found.table2))
    for key, each in found.readings.items():
        print(f"\n{key}, reading {each.name}: {'; '.join(f'{k}: {v}' for k, v in each.facts.items())}")
    print()
    for line in pages.findings(found):
        print(f"- {line.replace('**', '')}")
    print(f"\nresults: {output / 'paper.html'}")
    if found.summary.rtl_mismatches:
        screen.note(f"error: gateware and fixed-point model differ in {found.summary.rtl_mismatches} pixels")
        raise typer.Exit(ending.MISMATCH)


def _chosen(names: list[str] | None, option: str, known: tuple[str, ...], engine: str) -> list[str]:
    """The names of a filter, or all; raises `InputError` for an unknown one, or without the gateware."""
    if names and engine != "rtl":
        raise InputError(f"{option} {names[0]} without --engine rtl", "it selects what is simulated: add it")
    for name in names or ():
        if name not in known:
            raise InputError(f"unknown {option} '{name}'", f"use one of {', '.join(known)}")
    return list(names or known)
