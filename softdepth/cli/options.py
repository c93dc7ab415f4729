"""The options by which every command chooses its configuration."""

import shlex
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from softdepth.spec.config import OPERATORS, PRESETS, Config
from softdepth.spec.errors import ConfigError

arguments: ContextVar[tuple[str, ...]] = ContextVar("arguments", default=())
"""What the user has written behind ``softdepth``."""


def command(*more: str) -> str:
    """What the user has written, with more options, to be written again."""
    return f"softdepth {shlex.join((*arguments.get(), *more))}"


@dataclass(frozen=True)
class Choice:
    """How a configuration is chosen: a preset or a file, and changes to it."""

    preset: Annotated[
        str | None,
        typer.Option("--preset", metavar="NAME", help=f"One of {', '.join(PRESETS)} (the default: paper)."),
    ] = None
    config: Annotated[
        Path | None, typer.Option("--config", metavar="FILE", help="A TOML file in place of a preset.")
    ] = None
    assignments: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="Change one key, e.g. criteria.0.window=5; repeatable."
        ),
    ] = None
    lanes: Annotated[
        int | None,
        typer.Option("--lanes", metavar="N", help="Candidates per clock: --set lanes=N."),
    ] = None
    disparities: Annotated[
        int | None,
        typer.Option("--disparities", metavar="N", help="Candidates per pixel: --set disparities=N."),
    ] = None
    operator: Annotated[
        str | None,
        typer.Option("--operator", metavar="NAME", help=f"One of {', '.join(OPERATORS)}. Short for --set."),
    ] = None

    @property
    def given(self) -> bool:
        """Whether the user chose anything."""
        return bool(self.preset or self.config or self.changes)

    @property
    def changes(self) -> list[str]:
        """All changes as ``key=value``, the short forms last."""
        short = {"lanes": self.lanes, "disparities": self.disparities, "operator": self.operator}
        return [
            *(self.assignments or []),
            *(f"{key}={value}" for key, value in short.items() if value is not None),
        ]

    def configuration(self, default: Config | None = None) -> Config:
        """The chosen configuration; without a preset or a file, `default` (or `paper`) with the changes.

        Raises `ConfigError` if the options contradict each other, or for what cannot be built.
        """
        if self.preset and self.config:
            raise ConfigError(
                f"--preset {self.preset} and --config {self.config} both name a configuration",
                "give one of the two",
            )
        if self.config:
            base = Config.load(self.config)
        else:
            base = default if default and not self.preset else Config.preset(self.preset or "paper")
        return base.override(self.changes) if self.changes else base

    def sets(self, key: str) -> bool:
        """Whether the user has set `key`, on the command line or in the file."""
        written = {change.partition("=")[0].strip() for change in self.changes}
        return key in written or (self.config is not None and key in Config.keys_in(self.config))
