"""Operators and criteria by name: those of the project, and those of others' modules.

Each operator or criterion is described in three places that do not know each other: what it is
(`softdepth.spec`), its model (`softdepth.golden`) and its gateware (`softdepth.hdl`). Each place has a
`Registry`. Your own needs two modules: one registers what it is and its model, the other its gateware. They
are found through the environment variable ``SOFTDEPTH_EXTENSIONS`` (module names, separated by commas), or as
entry points of the group ``softdepth.extensions``.
"""

import os
from collections.abc import Container, Iterator, Mapping
from contextlib import contextmanager
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

    Asking for all names, or for one that is missing, loads the extensions first.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._items: dict[str, T] = {}

    def register(self, name: str, item: T) -> T:
        """Add `item`; raises `ConfigError` if another one has its name."""
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

    @contextmanager
    def scope(self, without: Container[str] = ()) -> Iterator[None]:
        """What is registered within the block is forgotten after it; names in `without` are unknown in it."""
        before = self._items
        self._items = {name: item for name, item in before.items() if name not in without}
        try:
            yield
        finally:
            self._items = before


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
                f"fix it, or take it out of {VARIABLE}",
            ) from error


def extension_modules() -> tuple[str, ...]:
    """The names of the extensions' modules."""
    named = [name.strip() for name in os.environ.get(VARIABLE, "").split(",")]
    return tuple(dict.fromkeys(filter(None, [*named, *_installed()])))


def extension_files() -> tuple[Path, ...]:
    """The extensions' source files, which their results depend on."""
    found = (import_module(name).__file__ for name in extension_modules())
    return tuple(Path(file) for file in found if file)


@lru_cache
def _installed() -> tuple[str, ...]:
    return tuple(entry.value for entry in entry_points(group="softdepth.extensions"))
