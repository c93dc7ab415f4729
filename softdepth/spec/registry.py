"""Operators and criteria by name: those of the project, and those of others' modules.

Each of the two is described in three places that do not know each other: what it is (`softdepth.spec`), its
model (`softdepth.golden`), its gateware (`softdepth.hdl`). Each place has a `Registry`. One of your own takes
two modules: one registers statement and model, one the gateware. They are found by the environment variable
``SOFTDEPTH_EXTENSIONS`` (module names, separated by commas) or as entry points of the group
``softdepth.extensions``.
"""

import os
from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import TypeVar

from softdepth.spec.errors import ConfigError

VARIABLE = "SOFTDEPTH_EXTENSIONS"

T = TypeVar("T")


class Registry(Mapping[str, T]):
    """Things by name, in the order in which they were registered.

    Whoever asks for all names, or for one that is missing, has the extensions loaded first.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._items: dict[str, T] = {}

    def register(self, name: str, item: T) -> T:
        """Add `item`; raises `ConfigError` where another has its name."""
        if self._items.get(name, item) != item:
            raise ConfigError(f"there is a second {self._what} '{name}'", "give one of them another name")
        self._items[name] = item
        return item

    def __getitem__(self, name: str) -> T:
        if name not in self._items:
            load_extensions()
        if name not in self._items:
            raise KeyError(name)
        return self._items[name]

    def __iter__(self) -> Iterator[str]:
        load_extensions()
        return iter(tuple(self._items))

    def __len__(self) -> int:
        load_extensions()
        return len(self._items)

    def __contains__(self, name: object) -> bool:
        return name in self._items or name in tuple(self)

    def choices(self) -> str:
        """All names, for messages."""
        return ", ".join(self)


def load_extensions() -> None:
    """Import the modules named by ``SOFTDEPTH_EXTENSIONS`` and by entry points, each once.

    Raises `ConfigError` for one that cannot be imported.
    """
    for name in extension_modules():
        try:
            import_module(name)
        except ImportError as error:
            raise ConfigError(
                f"the extension '{name}' cannot be imported: {error}",
                f"mend it, or take it out of {VARIABLE}",
            ) from error


def extension_modules() -> tuple[str, ...]:
    """The names of the extensions' modules."""
    named = [name.strip() for name in os.environ.get(VARIABLE, "").split(",")]
    return tuple(dict.fromkeys(filter(None, [*named, *_installed()])))


def extension_files() -> tuple[Path, ...]:
    """The extensions' source files: what they give depends on them."""
    found = (import_module(name).__file__ for name in extension_modules())
    return tuple(Path(file) for file in found if file)


@lru_cache
def _installed() -> tuple[str, ...]:
    return tuple(entry.value for entry in entry_points(group="softdepth.extensions"))
