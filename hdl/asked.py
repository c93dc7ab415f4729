"""Gateware that is asked for its latency or its memory, and not built."""

import gc
import warnings
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def asked() -> Iterator[None]:
    """Amaranth would say, when Python comes to free its cycles, that components were not used."""
    from amaranth.hdl import UnusedElaboratable

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusedElaboratable)
        yield
        gc.collect()
