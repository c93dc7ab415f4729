"""Gateware that is asked for its latency or its memory, and not built."""

import gc
import warnings
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def asked() -> Iterator[None]:
    """Silences Amaranth's warning that components were never used, until Python has freed them."""
    from amaranth.hdl import UnusedElaboratable

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusedElaboratable)
        yield
        gc.collect()
