"""What a lane takes with each of the costs that are compared, as it was measured."""

from collections.abc import Mapping
from pathlib import Path

from pydantic import BaseModel, TypeAdapter

from softdepth.spec.config import Config

FIGURES = Path("docs/fuzzy_lanes.json")
"""What ``python -m softdepth.studies.fuzzy_lanes`` writes."""


class LaneFigures(BaseModel):
    """LUT4s and flip-flops of one lane on ECP5, and multipliers of the core divided by its lanes.

    Members
    -------
    config : the hash of the configuration, its lanes and sizes included.
    """

    config: str
    lut4: int
    ff: int
    multipliers: float


CORE = ("disparities=64", "lanes=32", "max_width=1280")
"""Of the cores whose lane is measured."""

_FILE = TypeAdapter(dict[str, LaneFigures])


def core_of(config: Config) -> Config:
    """The core whose lane is measured, whatever a part has of multipliers."""
    return config.override([*CORE, "max_multipliers=9999"])


def known(configs: Mapping[str, Config], file: Path = FIGURES) -> dict[str, LaneFigures]:
    """The figures of those that were measured as they are; none away from the project's folder."""
    if not file.is_file():
        return {}
    measured = _FILE.validate_json(file.read_bytes())
    return {
        name: measured[name]
        for name, config in configs.items()
        if name in measured and measured[name].config == core_of(config).hash
    }


def to_json(found: dict[str, LaneFigures]) -> bytes:
    """As the file has them."""
    return _FILE.dump_json(found, indent=1) + b"\n"
