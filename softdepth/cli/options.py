"""The options by which every command chooses its configuration."""

from pathlib import Path
from typing import Annotated

import typer

from softdepth.spec.config import OPERATORS, PRESETS, Config
from softdepth.spec.errors import ConfigError

Preset = Annotated[
    str | None,
    typer.Option("--preset", metavar="NAME", help=f"One of {', '.join(PRESETS)} (the default: paper)."),
]
ConfigFile = Annotated[
    Path | None, typer.Option("--config", metavar="FILE", help="A TOML file in place of a preset.")
]
Assignments = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change one key, e.g. criteria.0.window=5; repeatable."),
]
Lanes = Annotated[
    int | None, typer.Option("--lanes", metavar="N", help="Candidates per clock. Short for --set lanes=N.")
]
Disparities = Annotated[
    int | None,
    typer.Option("--disparities", metavar="N", help="Candidates per pixel. Short for --set disparities=N."),
]
Operator = Annotated[
    str | None,
    typer.Option("--operator", metavar="NAME", help=f"One of {', '.join(OPERATORS)}. Short for --set."),
]


def configuration(
    preset: str | None = None,
    file: Path | None = None,
    assignments: list[str] | None = None,
    *,
    lanes: int | None = None,
    disparities: int | None = None,
    operator: str | None = None,
    default: Config | None = None,
) -> Config:
    """The configuration that these options choose; raises `ConfigError` where they contradict.

    Without a preset or a file they change `default`, or else the preset `paper`.
    """
    if preset and file:
        raise ConfigError(
            f"--preset {preset} and --config {file} both name a configuration", "give one of the two"
        )
    if file:
        base = Config.load(file)
    else:
        base = default if default and not preset else Config.preset(preset or "paper")
    short = {"lanes": lanes, "disparities": disparities, "operator": operator}
    changes = [*(assignments or []), *(f"{key}={value}" for key, value in short.items() if value is not None)]
    return base.override(changes) if changes else base
