"""Tops of the boards: the core behind a serial port."""

from softdepth.hdl.boards.top import BoardTop

__all__ = ["BoardTop"]
