"""Amaranth gateware: a stereo pair streams in, one disparity per pixel streams out."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from softdepth.hdl.core import StereoCore

__all__ = ["StereoCore"]


def __getattr__(name: str) -> Any:
    """The core, once it is asked for: elaboration is slow to import."""
    if name in __all__:
        return import_module("softdepth.hdl.core").StereoCore
    raise AttributeError(f"module 'softdepth.hdl' has no attribute '{name}'")
