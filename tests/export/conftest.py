"""Exported cores that tests share."""

from functools import cache

from softdepth.export.core_file import Exported, export_core
from softdepth.hdl.built import missing
from softdepth.spec.config import PRESETS, Config

BUILT = [name for name in PRESETS if not missing(Config.preset(name))]
"""Presets that have gateware."""

SIZE = ["max_width=64", "max_height=48"]
SMALL: dict[str, Config] = {
    "sad": Config.preset("sad").override([*SIZE, "disparities=8", "lanes=4"]),
    "paper": Config.preset("paper").override([*SIZE, "disparities=8", "lanes=2"]),
    "compact": Config.preset("compact").override([*SIZE, "disparities=6", "lanes=6", "operator=min"]),
    "lite": Config.preset("lite").override([*SIZE, "disparities=19", "lanes=1", "stored_rows=0"]),
    "robust": Config.preset("robust").override([*SIZE, "disparities=4", "lanes=2"]),
    "robust-small": Config.preset("robust-small").override(
        [*SIZE, "disparities=4", "lanes=4", "pixel=gray8", "post.fill=false"]
    ),
}
"""Cores that build in a moment: other presets, lanes, operators, memories."""


@cache
def exported(name: str) -> Exported:
    """One of `SMALL` as it is exported."""
    return export_core(SMALL[name])
