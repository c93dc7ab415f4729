"""Maps that were computed before, by everything that they depend on."""

import hashlib
import io
import json
import zipfile
import zlib
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from softdepth.files import cache_folder, write_atomically
from softdepth.sources import sources_hash
from softdepth.spec.errors import InputError
from softdepth.studies.paper.cells import Cell, Found


def folder() -> Path:
    """Where maps are kept: below ``$SOFTDEPTH_CACHE``, or the user's cache folder."""
    return cache_folder() / "paper"


def source_version(gateware: bool = False) -> str:
    """A hash of the sources that decide a map, and of the libraries beneath them."""
    rooms = ("studies.paper", "sim") if gateware else ("studies.paper",)
    libraries = f"{version('numpy')} {version('opencv-python-headless')}"
    return hashlib.sha256(f"{sources_hash(*rooms)} {libraries}".encode()).hexdigest()


class MapCache:
    """Maps on disk; with no folder, it holds nothing and keeps nothing."""

    def __init__(self, place: Path | None) -> None:
        self.place = place

    def get(self, cell: Cell, images: str) -> Found | None:
        """The map of `cell` on images with this digest, or None. A damaged file counts as none."""
        if self.place is None:
            return None
        try:
            with np.load(self._path(cell, images)) as data:
                return Found(data["disparity"], data["valid"], float(data["seconds"]))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error):
            return None

    def put(self, cell: Cell, images: str, found: Found) -> None:
        """Keep a map. Raises `InputError` if the folder cannot be written."""
        if self.place is None:
            return
        file = io.BytesIO()
        np.savez_compressed(file, disparity=found.disparity, valid=found.valid, seconds=found.seconds)
        path = self._path(cell, images)
        make_folder(path.parent)
        write_atomically(path, file.getvalue())

    def _path(self, cell: Cell, images: str) -> Path:
        assert self.place is not None
        return self.place / f"{key(cell, images)}.npz"


def key(cell: Cell, images: str) -> str:
    """A name for all that decides a map: reading, configuration, engine, pixels and sources."""
    reading = {k: v for k, v in cell.reading.plain().items() if k not in ("name", "why", "truth", "first")}
    return digest(
        {
            "reading": reading,
            "operator": cell.operator,
            "engine": cell.engine,
            "config": cell.config.hash if cell.reading.windows else None,
            "images": images,
            "source": source_version(cell.engine == "rtl"),
        }
    )


def digest(facts: dict[str, Any]) -> str:
    """Twenty hex digits of plain data."""
    return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:20]


def make_folder(path: Path) -> None:
    """Make a cache folder; raises `InputError` if that is not possible."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"cannot make the cache '{path}' ({error.strerror})",
            "set SOFTDEPTH_CACHE to a folder you may write to, or use --no-cache",
        ) from error
