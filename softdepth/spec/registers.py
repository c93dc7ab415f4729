"""The registers of the core with AXI streams: the model of ``registers.rdl`` for one configuration."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from systemrdl.compiler import RDLCompiler
from systemrdl.node import AddrmapNode, FieldNode, RegNode

from softdepth.spec.axi_options import DEFAULT, AxiOptions
from softdepth.spec.config import Config

SOURCE = Path(__file__).with_suffix(".rdl")
WORD_BITS = 32
THRESHOLD_BITS = 24
"""Of the compensating rule's, in its register: no SAD is larger."""
UNSURE = 7
"""The code of a measurement whose confidence is below the floor; no `Validity` has it."""

_HALF = 1 << 16


@dataclass(frozen=True)
class RegisterField:
    """Bits of a register.

    Members
    -------
    name : of register and field, such as ``geometry_width``.
    low, width : where it lies in its register.
    reset : its value after reset; of fields that the core writes, 0.
    writable : software writes it.
    given : the core gives its value.
    pulses : it is 1 for one clock after 1 was written.
    sticky : the core sets its bits, and software clears those to which it writes 1.
    meaning : in a sentence or two.
    """

    name: str
    low: int
    width: int
    reset: int
    writable: bool
    given: bool
    pulses: bool
    sticky: bool
    meaning: str


@dataclass(frozen=True)
class Register:
    """A word; `takeover` tells that what is written acts from the next frame on."""

    name: str
    address: int
    takeover: bool
    meaning: str
    fields: tuple[RegisterField, ...]


def definitions(config: Config, options: AxiOptions = DEFAULT) -> dict[str, str]:
    """What ``registers.rdl`` is told of a configuration, and of the ports."""
    post = config.post
    major, minor, patch = (int(part) for part in version("softdepth").split(".")[:3])
    number = int(config.hash, 16)
    compensated = min(config.compensation.threshold, (1 << THRESHOLD_BITS) - 1)
    values = {
        "MAJOR": major,
        "MINOR": minor,
        "PATCH": patch,
        "HASH_LOW": number % (1 << WORD_BITS),
        "HASH_HIGH": number >> WORD_BITS,
        "DISPARITIES": config.disparities,
        "MIN_DISPARITY": config.min_disparity % _HALF,
        "MAX_WIDTH": config.max_width,
        "MAX_HEIGHT": config.max_height,
        "FRACTION_BITS": post.fraction_bits,
        "STEPS": config.steps,
        "HAS_CONFIDENCE": int(post.confidence),
        "HAS_TWO_STREAMS": int(options.two),
        "HAS_LEFT": int(options.left),
    }
    optional = {
        "TWO_STREAMS": options.two,
        "CONFIDENCE": post.confidence,
        "TOLERANCE": post.tolerance if post.check else None,
        "ISLAND": post.island or None,
        "COMPENSATION": compensated if config.compensation.reading != "off" else None,
        "TRUNCATION": config.gradient.truncation if config.gradient else None,
        "LIKENESS": post.like if post.masked_median else None,
    }
    values |= {
        name: int(value) for name, value in optional.items() if value is not None and value is not False
    }
    return {f"SOFTDEPTH_{name}": str(value) for name, value in values.items()}


def address_map(defined: Mapping[str, str]) -> AddrmapNode:
    """The elaborated description, for programs that make something of it."""
    compiler = RDLCompiler()
    compiler.compile_file(str(SOURCE), defines=dict(defined))
    return compiler.elaborate().top


def registers(config: Config, options: AxiOptions = DEFAULT) -> tuple[Register, ...]:
    """The registers of a configuration's core, in the order of their addresses."""
    nodes = address_map(definitions(config, options)).registers()
    return tuple(_register(node) for node in nodes)


def _register(node: RegNode) -> Register:
    return Register(
        node.inst_name,
        node.absolute_address,
        bool(node.get_property("takeover")),
        node.get_property("desc") or "",
        tuple(_field(node, field) for field in node.fields()),
    )


def _field(node: RegNode, field: FieldNode) -> RegisterField:
    reset = field.get_property("reset")
    return RegisterField(
        f"{node.inst_name}_{field.inst_name}".lower(),
        field.low,
        field.width,
        reset if isinstance(reset, int) else 0,
        field.is_sw_writable,
        field.is_hw_writable,
        bool(field.get_property("singlepulse")),
        bool(field.get_property("stickybit")),
        field.get_property("desc") or "",
    )
