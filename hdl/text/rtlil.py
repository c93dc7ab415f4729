"""A component as RTLIL, by Amaranth."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from amaranth.back import rtlil
from amaranth.hdl import Value, ValueLike
from amaranth.hdl._ir import PortDirection  # it has no public name
from amaranth.lib.wiring import Component, Flow, In, Out

CLOCK, RESET = "clk", "rst"
"""Ports that a component has besides its own: those of the clock domain, unless it makes that itself."""


def to_rtlil(component: Component, name: str, *, sources: bool = False) -> str:
    """RTLIL of a component, whose top module is called `name`.

    Ports are ``clk``, ``rst`` (synchronous, active high) and the component's own, nested names joined by
    ``_``: ``i_payload``, ``i_valid``, ... Names with ``__`` are not legal in VHDL. With `sources`, every cell
    names the source lines that made it.
    """
    with _undisturbed():
        return rtlil.convert(component, name=name, ports=_given(ports_of(component)), emit_src=sources)


@dataclass(frozen=True)
class Port:
    """One of a component's own ports: its name in text, its direction as the component sees it, its value."""

    name: str
    flow: Flow
    value: ValueLike


def ports_of(component: Component) -> list[Port]:
    """A component's own ports, in the component's order."""
    ports: dict[str, Port] = {}
    for path, member, value in component.signature.flatten(component):
        name = "_".join(map(str, path))
        if name in ports:
            raise ValueError(f"two ports of {type(component).__name__} would be called '{name}'")
        ports[name] = Port(name, member.flow, value)
    return list(ports.values())


def _given(ports: list[Port]) -> dict[str, tuple[Value, PortDirection]]:
    """The ports in the form that Amaranth expects."""
    ways = {In: PortDirection.Input, Out: PortDirection.Output}
    return {port.name: (Value.cast(port.value), ways[port.flow]) for port in ports}


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Elaboration makes millions of objects that live until it ends: garbage collection halves its speed."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
