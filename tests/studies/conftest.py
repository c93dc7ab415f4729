"""The fixtures of the flow's tests serve the studies of area and speed as well."""

from tests.flow.conftest import cache, path, refused

__all__ = ["cache", "path", "refused"]
