"""A component as RTLIL, by Amaranth."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager

from amaranth.back import rtlil
from amaranth.hdl import Value
from amaranth.hdl._ir import PortDirection  # it has no public name
from amaranth.lib.wiring import Component, In

CLOCK, RESET = "clk", "rst"
"""Ports that every component has beside its own: those of its only clock domain."""


def to_rtlil(component: Component, name: str) -> str:
    """RTLIL of a component, whose top module is called `name`.

    Ports are ``clk``, ``rst`` (synchronous, active high) and the component's own, nested names joined by
    ``_``: ``i_payload``, ``i_valid``, ... Names with ``__`` are not legal in VHDL.
    """
    with _undisturbed():
        return rtlil.convert(component, name=name, ports=_ports(component), emit_src=False)


def port_names(component: Component) -> list[str]:
    """A component's own ports, in its order."""
    return list(_ports(component))


def _ports(component: Component) -> dict[str, tuple[Value, PortDirection]]:
    ports = {}
    for path, member, value in component.signature.flatten(component):
        name = "_".join(map(str, path))
        if name in (*ports, CLOCK, RESET):
            raise ValueError(f"two ports of {type(component).__name__} would be called '{name}'")
        direction = PortDirection.Input if member.flow is In else PortDirection.Output
        ports[name] = (Value.cast(value), direction)
    return ports


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Elaboration makes millions of objects that all live to its end: collecting halves its speed."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
