"""A configuration as the text of an exported file."""

import re
from dataclasses import dataclass

from softdepth.export.constants import as_json, declarations
from softdepth.export.head import head
from softdepth.export.interface import interface_of
from softdepth.hdl.built import check_built
from softdepth.hdl.core import StereoCore
from softdepth.hdl.text.words import PLAIN, RESERVED
from softdepth.hdl.verilog import TOP, to_verilog
from softdepth.spec.config import Config
from softdepth.spec.errors import ConfigError, InputError


@dataclass(frozen=True)
class Exported:
    """An exported core: the Verilog file, and its description as JSON."""

    verilog: str
    json: str


def check_export(config: Config, name: str = TOP) -> None:
    """Raise `InputError` or `ConfigError` for what cannot be exported, before the core is elaborated."""
    if not PLAIN.fullmatch(name) or name.lower() in RESERVED:
        raise InputError(
            f"--name '{name}' cannot name a module",
            "use letters, digits and single underscores, beginning with a letter, and no word of Verilog",
        )
    if config.reference == "right":
        raise ConfigError(
            "reference is 'right', but the core judges its left input's pixels: it cannot mirror lines",
            "export with reference = 'left', and feed the right image's lines as left and the left image's as"
            " right, each line with its last pixel first; so come the right view's results",
        )
    check_built(config)


def export_core(config: Config, name: str = TOP) -> Exported:
    """The core of `config` as a module called `name`, all of whose modules' names begin with it.

    Raises as `check_export` does.
    """
    check_export(config, name)
    core = StereoCore(config)
    interface = interface_of(core, config, name)
    text = re.sub(
        rf"^module {name}\(.*\);\n",
        lambda line: line[0] + declarations(interface),
        to_verilog(core, name),
        count=1,
        flags=re.MULTILINE,
    )
    return Exported(head(interface) + text, as_json(interface))
