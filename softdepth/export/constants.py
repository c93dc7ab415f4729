"""Where an exported core's fields lie and what its codes are, for other programs: Verilog and JSON."""

import json
from collections.abc import Iterator
from importlib.metadata import version
from typing import Any

from softdepth.export.interface import Field, Interface


def localparams(interface: Interface) -> dict[str, int]:
    """Constants by name: ``I_PAYLOAD_LEFT_LSB``, ``I_PAYLOAD_LEFT_BITS``, ..., ``CODE_FULL``, ..."""
    found: dict[str, int] = {}
    for port in interface.ports:
        for field in port.fields:
            stem = f"{port.name}_{field.name}".upper()
            found[f"{stem}_LSB"] = field.low
            found[f"{stem}_BITS"] = field.width
    found["O_PAYLOAD_DISPARITY_FRACTION_BITS"] = interface.config.post.fraction_bits
    return found | {f"CODE_{code.name}": code.value for code in interface.codes}


def declarations(interface: Interface) -> str:
    """The constants as declarations of the module, right after its head."""
    return "".join(f"  localparam {name} = {value};\n" for name, value in localparams(interface).items())


def as_json(interface: Interface) -> str:
    """Everything that the file's head says, and the configuration, for programs."""
    config = interface.config
    frame = {
        "min_width": config.min_width,
        "min_height": config.min_height,
        "max_width": config.max_width,
        "max_height": config.max_height,
    }
    described: dict[str, Any] = {
        "module": interface.name,
        "softdepth": version("softdepth"),
        "hash": config.hash,
        "ports": [
            {
                "name": port.name,
                "direction": port.direction,
                "width": port.width,
                "meaning": port.meaning,
                "fields": [_field(field) for field in port.fields],
            }
            for port in interface.ports
        ],
        "codes": {code.name: code.value for code in interface.codes},
        "constants": localparams(interface),
        "clocks_per_pixel": config.steps,
        "latency": interface.latency,
        "latency_at_full_rate": interface.full_rate_latency,
        **_needs(interface),
        "frame": frame,
        "configuration": config.model_dump(mode="json"),
    }
    return json.dumps(described, indent=2) + "\n"


def _needs(interface: Interface) -> dict[str, Any]:
    """The pixel from which the latency counts."""
    config, whole = interface.config, interface.whole
    if whole is None:
        return {"reach": {"right": config.reach_right, "rows": config.reach_rows}}
    return {
        "needs": {"column": whole.column, "rows": whole.rows},
        "slots_beyond": {"right": whole.right, "below": whole.below, "behind": whole.drain},
    }


def _field(field: Field) -> dict[str, str | int]:
    return {"name": field.name, "lsb": field.low, "width": field.width, "meaning": field.meaning}


def template(interface: Interface) -> Iterator[str]:
    """Lines that instantiate the core, with a wire for each port and each field of a payload."""
    name, ports = interface.name, interface.ports
    for port in ports:
        bits = f"[{port.width - 1}:0] " if port.width > 1 else ""
        yield f"wire {bits}{port.name};"
    yield f"{name} core ("
    for k, port in enumerate(ports):
        yield f"  .{port.name}({port.name}){',' if k < len(ports) - 1 else ''}"
    yield ");"
    for port in ports:
        for field in port.fields:
            bits = f"[{field.width - 1}:0] " if field.width > 1 else ""
            wire, place = f"{port.name.removesuffix('_payload')}_{field.name}", span(port.name, field)
            if port.direction == "output":
                yield f"wire {bits}{wire} = {place};"
            elif not _holds_others(field, port.fields):
                yield f"wire {bits}{wire}; assign {place} = {wire};"


def span(port: str, field: Field) -> str:
    """A field as the bits of its port: ``o_payload[5:0]``."""
    high = field.low + field.width - 1
    return f"{port}[{high}:{field.low}]" if field.width > 1 else f"{port}[{field.low}]"


def _holds_others(field: Field, fields: tuple[Field, ...]) -> bool:
    return any(other.name.startswith(f"{field.name}_") for other in fields)
