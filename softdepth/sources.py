"""A hash of the project's sources that results depend on, to recognise results of older sources.

One list serves every cache: a room's hash covers the rooms that it builds on.
"""

import hashlib
from functools import lru_cache
from importlib import import_module
from pathlib import Path

from softdepth.spec.registry import extension_files

PACKAGE = Path(__file__).resolve().parent
PROJECT = PACKAGE.parent

BUILDS_ON: dict[str, tuple[str, ...]] = {
    "spec": (),
    "golden": ("spec",),
    "hdl": ("spec",),
    "sim": ("golden", "hdl"),
    "rig": ("golden",),
    "metric": ("rig",),
    "flow": ("hdl",),
    "studies.paper": ("golden",),
}
"""The rooms whose results are kept, each with those that it imports and that decide what it gives."""


def folder(room: str) -> Path:
    """Where a room's sources lie, wherever the package is installed."""
    return Path(next(iter(import_module(f"softdepth.{room}").__path__))).resolve()


def covered(*rooms: str) -> tuple[str, ...]:
    """`rooms` and all that they build on, each once, sorted."""
    found: set[str] = set()
    waiting = list(rooms)
    while waiting:
        room = waiting.pop()
        if room not in found:
            found.add(room)
            waiting += BUILDS_ON[room]
    return tuple(sorted(found))


def sources_hash(*rooms: str, further: tuple[Path, ...] = ()) -> str:
    """20 hex digits that tell the sources of `rooms`, what they build on, extensions and `further`."""
    digest = hashlib.sha256(_rooms_hash(tuple((room, folder(room)) for room in covered(*rooms))))
    for file in (*extension_files(), *further):
        digest.update(file.name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()[:20]


@lru_cache
def _rooms_hash(places: tuple[tuple[str, Path], ...]) -> bytes:
    digest = hashlib.sha256()
    for room, place in places:
        for file in sorted(place.rglob("*.py")):
            digest.update(f"{room}/{file.relative_to(place)}".encode() + b"\0" + file.read_bytes())
    return digest.digest()
