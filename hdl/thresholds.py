"""Thresholds that a core may be told while it runs, wherever in it they are looked at."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

from amaranth.hdl import Signal
from amaranth.lib import data

T = TypeVar("T")
_TOLD: ContextVar[Mapping[str, Signal] | None] = ContextVar("told", default=None)


@contextmanager
def told(layout: data.StructLayout) -> Iterator[dict[str, Signal]]:
    """Components that are made inside take their thresholds from signals of these shapes, by name.

    Whoever makes the core drives these signals, and changes them only while no frame is inside.
    """
    signals = {name: Signal(shape, name=name) for name, shape in layout.members.items()}
    token = _TOLD.set(signals)
    try:
        yield signals
    finally:
        _TOLD.reset(token)


def threshold(name: str, value: T) -> Signal | T:
    """`value`; or, where a component is made within `told`, the signal of that name."""
    signals = _TOLD.get()
    return value if signals is None or name not in signals else signals[name]
