"""``softdepth evaluate``: accuracy on a folder of scenes, with OpenCV's matchers beside it."""

import os
from pathlib import Path
from typing import Annotated, Literal

import typer

from softdepth.spec.config import Config
from softdepth.spec.errors import InputError

PRESETS = ("robust", "robust-gray", "robust-small", "paper", "sad")
"""What is evaluated where no preset is named."""
PROCESSES = 2


def evaluate(
    scenes: Annotated[
        list[Path],
        typer.Option("--scenes", metavar="DIR", help="A scene, or a folder of scenes; repeatable."),
    ],
    preset: Annotated[
        list[str] | None,
        typer.Option("--preset", metavar="NAME", help=f"Repeatable (the default: {', '.join(PRESETS)})."),
    ] = None,
    assignments: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Change one key of all of them; repeatable."),
    ] = None,
    engine: Annotated[
        Literal["fixed", "rtl"],
        typer.Option("--engine", help="What gives our maps: the fixed model, or the simulated gateware."),
    ] = "fixed",
    leave_out: Annotated[
        list[str] | None, typer.Option("--leave-out", metavar="SCENE", help="Not this one; repeatable.")
    ] = None,
    degraded: Annotated[
        bool, typer.Option("--degraded", help="Also at less light, other gamma, with noise, and a row off.")
    ] = False,
    fuzzy: Annotated[
        bool, typer.Option("--fuzzy", help="Also fuzzy costs against the sum, over the same criteria.")
    ] = False,
    ablation: Annotated[
        bool, typer.Option("--ablation", help="Also robust-small with each of its savings taken back.")
    ] = False,
    processes: Annotated[
        int, typer.Option("--processes", metavar="N", min=1, help="Scenes at a time.")
    ] = min(PROCESSES, os.cpu_count() or 1),
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Folder of tables, page and data.")
    ] = Path("out/evaluate"),
    document: Annotated[
        Path | None,
        typer.Option("--document", metavar="FILE", help="Markdown file whose generated part is renewed."),
    ] = None,
) -> None:
    """Score presets on scenes with known depth, beside OpenCV's matchers."""
    configs = {name: Config.preset(name).override(assignments or []) for name in preset or PRESETS}
    if len({config.disparities for config in configs.values()}) > 1:
        raise InputError(
            "the presets have different numbers of candidates", "give one with --set disparities=N"
        )
    if engine == "rtl":
        from softdepth.hdl.built import check_built

        for config in configs.values():
            check_built(config)
    from softdepth.studies.evaluate import evaluation
    from softdepth.studies.evaluate import scenes as folders

    found = folders.find(scenes, leave_out or ())
    evaluation.check_document(document)
    result = evaluation.evaluate(
        found, configs, engine=engine, degraded=degraded, fuzzy=fuzzy, ablation=ablation, processes=processes
    )
    evaluation.write(output, result, document)
    evaluation.show(result)
    print(f"results: {output}")
    if sum(sum(scene.mismatches.values()) for scene in result.evaluation.scenes):
        raise typer.Exit(evaluation.EXIT_MISMATCH)
